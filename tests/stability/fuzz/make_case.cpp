// SPDX-License-Identifier: MIT
#include "stability/fuzz/make_case.hpp"

#include "filter/filtered.hpp"
#include "stability/fuzz/random_mesh.hpp"
#include "stability/fuzz/random_state.hpp"

#include <algorithm>
#include <limits>

namespace apsl::test {
namespace {

constexpr std::uint64_t block_size = 100;
// A driver compiles kernels for seconds and keeps them: so many sets of options at most.
constexpr std::uint64_t option_sets = 20;
// Room for a component's run where x, y and z lie apart: more than the vertices of all meshes of a block.
constexpr std::uint32_t most_vertices = 2048;

Options random_options(std::uint64_t number) {
    Random random(number, 7);
    Options options = variants[number % variants.size()];
    if (number % 7 == 0 && options.matrix == Matrix::consistent && options.apply == Apply::matrix_free)
        options.execution = Execution::automatic;
    options.work_group_size = random.one_of({0u, 1u, 2u, 4u, 8u, 16u, 32u, 64u, 128u, 256u});
    options.position_stride = random.one_of({3u, 4u, 7u});
    options.velocity_stride = random.one_of({3u, 4u, 5u});
    if (number % 5 == 3) {
        options.position_stride = options.velocity_stride = 1;
        options.position_component_stride = options.velocity_component_stride = most_vertices;
    }
    options.inverse_mass_stride = random.one_of({1u, 1u, 4u});
    options.regularization_per_triangle = random.chance(0.3);
    options.warm_start_sub_steps = number % 12 == 6 ? random.one_of({1u, 3u}) : 0;
    if (number == 11) {  // the consistent matrix, matrix-free, many groups
        options.solver = Solver::chebyshev;
        options.regularization_per_triangle = false;
        options.warm_start_sub_steps = 0;
        options.bound_interval = random.one_of({1u, 3u});
    }
    if (number == 17) {  // a whole step without a ceiling
        options = with_layout({.execution = Execution::many_groups}, options);
        options.integrates = true;
        options.acceleration_per_vertex = true;
        return options;
    }
    if (number >= 15) {  // a stretch ceiling, for all triangles or one for each, in a whole step with bending, or in
                         // one with tethers
        options.matrix = Matrix::consistent;
        options.apply = Apply::matrix_free;
        options.execution = Execution::many_groups;
        options.regularization_per_triangle = false;
        options.warm_start_sub_steps = 0;
        options.limits_stretch = true;
        options.stretch_ceiling_per_triangle = number == 16;
        options.integrates = number >= 18;
        options.bends = number == 18;
        if (number == 19) options.tethers_per_vertex = MovingCloth::tethers;
    }
    return options;
}

Parameters random_parameters(Random& random, bool may_adapt, const Options& options, bool may_follow) {
    const bool limits_stretch = options.limits_stretch, keeps_contacts = options.keeps_contacts;
    Parameters p;
    if (limits_stretch) p.stretch_ceiling = random.one_of({0.0f, 1.01f, 1.1f, 1.1f, 1.1f, 2.0f, 1e6f});
    p.time_step = random.one_of({1.0f / 60.0f, 1.0f / 60.0f, 1e-3f, 0.1f, 1e-6f});
    p.regularization = random.one_of({1.0f, 1.01f, 1.2f, 1.2f, 2.0f, 10.0f, 1e6f});
    p.sub_steps = random.one_of({0, 1, 1, 1, 2, 3, 5, 10, 20});
    p.target_area_change = random.one_of({0.0f, 0.0f, 0.0f, 0.01f, 0.2f, 10.0f});
    p.tolerance = random.one_of({0.0f, 1e-4f, 1e-4f, 0.1f, 0.99f});
    p.max_iterations = random.one_of({1, 5, 20, 60});
    if (p.regularization > 1.0f && random.chance(0.2))
        p.first_regularization = random.one_of({1.0001f, 1.05f, 2.0f, 1e6f});
    p.stepping = random.one_of({Stepping::automatic, Stepping::whole_step, Stepping::small_steps});
    if (p.sub_steps < 2) p.stepping = Stepping::whole_step;
    if (limits_stretch) p.most_sub_steps = p.sub_steps;
    if (may_follow && p.stepping != Stepping::whole_step && p.first_regularization == 0.0f && random.chance(0.7))
        p.most_sub_steps = random.one_of({0, p.sub_steps + 1, p.sub_steps + 7, p.sub_steps + 40});
    if (options.integrates) {
        p.acceleration = random.one_of<std::array<float, 3>>({{}, {0.0f, -9.81f, 0.0f}, {0.0f, 1e3f, -1.0f}});
        p.damping = random.one_of({0.0f, 0.5f, 100.0f});
        if (options.bends && p.stretch_ceiling > 0.0f) p.bending = random.one_of({0.0f, 1e-6f, 1e-3f, 10.0f});
    }
    if (keeps_contacts || options.integrates) {
        p.sub_steps = std::max(p.sub_steps, 2);
        if (p.stepping == Stepping::whole_step) p.stepping = Stepping::automatic;
        p.most_sub_steps = std::max(p.most_sub_steps, p.sub_steps);
    }
    p.enabled = !random.chance(0.05);
    if (may_adapt) p.adaptive_threshold = random.one_of({1, 4, 20});
    return p;
}

BadNumber random_bad_number(Random& random, const FuzzCase& c) {
    BadNumber bad{};
    bad.array = random.one_of(
        {&MovingCloth::positions, &MovingCloth::velocities, &MovingCloth::inverse_masses, &MovingCloth::rest_areas});
    bad.cloth = random.below(c.cloths.size());
    bad.index = random.below((c.cloths[bad.cloth].*bad.array).size());
    constexpr double infinity = std::numeric_limits<double>::infinity();
    bad.value = random.one_of({std::numeric_limits<double>::quiet_NaN(), infinity, -infinity});
    return bad;
}

}  // namespace

void CaseMaker::begin_block(std::uint64_t block) {
    block_ = block;
    Random random(seed_, 2 * block);
    options_ = random_options(block % option_sets);
    // Every other time round, a ceiling for each triangle and whole steps come with contacts.
    options_.keeps_contacts = block / option_sets % 2 == 1 && block % option_sets >= 16;
    meshes_.clear();
    for (std::uint32_t n = random.from_to(1, 3); n > 0; --n) meshes_.push_back(random_mesh(random));
    // Kernels are compiled for the greatest number of vertices in a patch: always that of this one.
    meshes_.push_back(loose_triangles(100));
    topologies_.clear();
    for (const Mesh& mesh : meshes_) topologies_.push_back(Topology::build(mesh.triangles, mesh.vertex_count()));
}

FuzzCase CaseMaker::make(std::uint64_t number) {
    if (number / block_size != block_) begin_block(number / block_size);
    Random random(seed_, 2 * number + 1);
    FuzzCase c;
    c.options = options_;
    // Such limiters remember, so that each case needs its own: few of them.
    if (random.chance(0.8)) c.options.warm_start_sub_steps = 0;
    c.offset = random.one_of({0u, 0u, 1u, 5u, 1000u});
    for (std::size_t n = 0; n < meshes_.size(); ++n)
        c.cloths.push_back(random_state(random, meshes_[n], topologies_[n]));
    c.in_single_precision = random.chance(0.3);
    c.twice = random.chance(0.4);
    const bool may_adapt = random.chance(0.015) && resolved_solver(options_) == Solver::conjugate_gradient;
    const bool may_follow = options_.limits_stretch && random.chance(0.05);
    for (std::uint32_t calls = random.one_of({1u, 1u, 1u, 2u, 3u}); calls > 0; --calls) {
        FuzzCall call;
        for (std::size_t n = 0; n < c.cloths.size(); ++n)
            call.parameters.push_back(random_parameters(random, may_adapt, options_, may_follow));
        call.carries_on = random.chance(0.5);
        if (random.chance(0.1)) call.bad = random_bad_number(random, c);
        c.calls.push_back(call);
    }
    return c;
}

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
#include "host/device_parameters.hpp"
#include "kernels/launch.hpp"
#include "reference/bending.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace apsl;
using namespace apsl::test;

namespace {

constexpr Options bending_options{.limits_stretch = true, .integrates = true, .bends = true};

Build bending(std::uint32_t work_group_size) {
    return {.work_group_size = work_group_size,
            .chebyshev = true,
            .limits_stretch = true,
            .integrates = true,
            .bends = true};
}

Parameters bending_by(float rigidity, int iterations) {
    return {.sub_steps = 5,
            .acceleration = {1.0f, -9.81f, 0.5f},
            .damping = 0.7f,
            .bending = rigidity,
            .bending_iterations = iterations};
}

/// A part of small steps that has begun: positions moved on by velocities, after acceleration and damping. Leaves in
/// `start` and `motion` where each cloth was and Δt times its velocities there, in the caller's order.
struct BegunPart {
    std::vector<std::vector<double>> start, motion;

    BegunPart(Arrays& arrays, const Parameters& p) {
        std::vector<cl_float4> moved = arrays.moved.read(), steps = arrays.motion.read();
        const double time_step = static_cast<double>(p.time_step), parts = p.sub_steps - 1;
        const double kept = std::exp(-static_cast<double>(p.damping) * time_step / parts);
        std::size_t i = 0;
        for (const Cloth& cloth : arrays.sources) {
            start.push_back(cloth.positions);
            motion.emplace_back();
            for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v, ++i) {
                const std::uint32_t place = arrays.vertex_places[i];
                const double w = cloth.inverse_masses[v];
                for (std::size_t k = 0; k < 3; ++k) {
                    const double u = cloth.velocities[3 * v + k];
                    const double gain = static_cast<double>(p.acceleration[k]) * time_step / parts;
                    const double after = time_step * (w > 0.0 ? kept * (u + gain) : u);
                    motion.back().push_back(time_step * u);
                    steps[place].s[k] = static_cast<float>(after);
                    moved[place].s[k] = static_cast<float>(cloth.positions[3 * v + k] + after / parts);
                }
                moved[place].s[3] = static_cast<float>(0.5 * w);  // an effective mass, which bending does not look at
                steps[place].s[3] = static_cast<float>(w);
            }
        }
        arrays.moved.write(moved);
        arrays.motion.write(steps);
    }
};

void bend(Arrays& arrays, const Build& build, int part, int iterations) {
    launch::bend_hinges(arrays, build, part);
    for (int k = 0; k < iterations; ++k) launch::bend_vertices(arrays, build, part, k);
}

struct Bent {
    std::vector<double> changes;  // m/s
    double energy;                // J
};

Bent bent_by_reference(const Cloth& cloth, const std::vector<double>& start, const std::vector<double>& motion,
                       const Parameters& p) {
    reference::Bending<double> reference(*cloth.topology);
    reference.start({.positions = {},
                     .velocities = {},
                     .inverse_masses = cloth.inverse_masses,
                     .rest_areas = {},
                     .regularization = {},
                     .rest_hinges = cloth.rest_hinges});
    reference.find_velocity_changes(start, motion, ResolvedParameters(p, bending_options));
    return {{reference.velocity_changes().begin(), reference.velocity_changes().end()}, reference.energy()};
}

}  // namespace

TEST_CASE("bend_hinges, bend_vertices: the reference's changes of velocity, and where they move to",
          "[bend_hinges][bend_vertices]") {
    for (const std::uint32_t group : work_group_sizes())
        for (const auto& [rigidity, iterations] :
             {std::pair{1e-3f, 1}, {1e-3f, 2}, {0.02f, 3}, {0.02f, 8}, {50.0f, 1}, {50.0f, 5}}) {
            CAPTURE(group, rigidity, iterations);
            const std::vector<Cloth> cloths = every_kind_of_mesh();
            const Parameters p = bending_by(rigidity, iterations);
            Arrays arrays(cloths, Matrix::consistent, p, 2, false, {3, 5});
            arrays.parameters.write(
                std::vector(cloths.size(), host::device_parameters(ResolvedParameters(p, bending_options))));
            const BegunPart begun(arrays, p);
            const std::vector<cl_float4> moved = arrays.moved.read(), motion = arrays.motion.read();
            bend(arrays, bending(group), 0, iterations);
            const std::vector<cl_float4> got_moved = arrays.moved.read(), got_motion = arrays.motion.read();
            const double time_step = static_cast<double>(p.time_step);
            std::size_t i = 0;
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                CAPTURE(c);
                const auto [want, energy] = bent_by_reference(cloths[c], begun.start[c], begun.motion[c], p);
                const std::vector<double> energies = arrays.partials_of(c, APSLK_PARTIAL_BENDING_ENERGY);
                CHECK(energies[0] + energies[1] == Approx(energy).epsilon(2e-4).margin(1e-9));
                std::vector<double> got, got_positions, want_positions;
                for (std::size_t v = 0; v < cloths[c].topology->vertex_count(); ++v, ++i) {
                    const std::uint32_t place = arrays.vertex_places[i];
                    for (std::size_t k = 0; k < 3; ++k) {
                        got.push_back(static_cast<double>(got_motion[place].s[k]) / time_step -
                                      static_cast<double>(motion[place].s[k]) / time_step);
                        got_positions.push_back(static_cast<double>(got_moved[place].s[k]));
                        want_positions.push_back(static_cast<double>(moved[place].s[k]) +
                                                 want[3 * v + k] * time_step / 4);
                    }
                    if (cloths[c].inverse_masses[v] == 0.0)
                        for (std::size_t k = 0; k < 4; ++k) {
                            CHECK(got_moved[place].s[k] == moved[place].s[k]);
                            CHECK(got_motion[place].s[k] == motion[place].s[k]);
                        }
                    CHECK(got_moved[place].s[3] == moved[place].s[3]);
                    CHECK(got_motion[place].s[3] == motion[place].s[3]);
                }
                // Velocities of 3 m/s are rounded, and so are angles, by positions.
                CHECK(difference(got, want) <=
                      2e-4 * norm(want) + elementwise_tolerance(20.0) * norm(cloths[c].velocities));
                CHECK(difference(got_positions, want_positions) <=
                      1e-4 * norm(want) * time_step + elementwise_tolerance(20.0) * norm(want_positions));
            }
        }
}

TEST_CASE("bend_hinges, bend_vertices: nothing after the last part, of what has stopped, and without rigidity",
          "[bend_hinges][bend_vertices]") {
    const std::vector<Cloth> cloths{make_cloth(strip(131), 3), make_cloth(strip(2), 4)};
    const auto unmoved = [&](float rigidity, int part, bool stopped) {
        const Parameters p = bending_by(rigidity, 2);
        Arrays arrays(cloths, Matrix::consistent, p, 2);
        arrays.parameters.write(
            std::vector(cloths.size(), host::device_parameters(ResolvedParameters(p, bending_options))));
        const BegunPart begun(arrays, p);
        arrays.edit_states([&](apslk_solve_state& state) { state.stopped = stopped; });
        const std::vector<cl_float4> moved = arrays.moved.read();
        bend(arrays, bending(64), part, 2);
        const std::vector<cl_float4> after = arrays.moved.read();
        return std::equal(moved.begin(), moved.end(), after.begin(),
                          [](const cl_float4& a, const cl_float4& b) { return std::equal(a.s, a.s + 4, b.s); });
    };
    CHECK_FALSE(unmoved(0.1f, 0, false));
    CHECK_FALSE(unmoved(0.1f, 3, false));
    CHECK(unmoved(0.1f, 4, false));
    CHECK(unmoved(0.1f, 0, true));
    CHECK(unmoved(0.0f, 0, false));
}

TEST_CASE("rest_hinges: the reference's, zeros without area", "[rest_hinges]") {
    for (const std::uint32_t group : work_group_sizes()) {
        CAPTURE(group);
        Mesh flat;
        flat.positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0};
        flat.triangles = {{0, 1, 2}, {0, 1, 3}};
        std::vector<Cloth> cloths{make_cloth(grid(9, 7, 1.0, 1.0, Diagonals::random), 1), make_cloth(flat, 2)};
        cloths[1].positions = flat.positions;
        Arrays arrays(cloths, Matrix::consistent, paper_setting, 3, false, {4, 5});
        arrays.rest_hinges.write(poison<float>(arrays.rest_hinges.size()));
        launch::rest_hinges(arrays, bending(group));
        const std::vector<float> got = arrays.rest_hinges.read();
        std::size_t n = arrays.array_offset;
        for (const Cloth& cloth : cloths)
            for (const double want : reference::rest_hinges<double>(*cloth.topology, cloth.positions)) {
                CAPTURE(n);
                CHECK(static_cast<double>(got[n++]) == Approx(want).epsilon(1e-4).margin(1e-5));
            }
        CHECK(n == got.size());
        for (std::size_t k = n - 2; k < n; ++k) CHECK(got[k] == 0.0f);
        for (std::size_t k = 0; k < arrays.array_offset; ++k) CHECK(std::isnan(got[k]));
    }
}

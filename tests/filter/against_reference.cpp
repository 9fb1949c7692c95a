// SPDX-License-Identifier: MIT
#include "filter/filtered.hpp"
#include "host/queued_iterations.hpp"
#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>

using namespace apsl;
using namespace apsl::test;

namespace {

// Tight enough that the comparison sees the kernels, loose enough for 32 bits to reach.
constexpr Parameters tight{.regularization = 1.3f, .sub_steps = 3, .tolerance = 1e-4f, .max_iterations = 100};

std::vector<std::pair<std::string, Mesh>> meshes() {
    Mesh with_isolated_vertices = grid(5, 4, 1.0, 1.0, Diagonals::uniform);
    with_isolated_vertices.positions.insert(with_isolated_vertices.positions.end(), {5, 5, 5, -3, 2, 1});
    return {{"uniform grid", grid(17, 13, 1.0, 0.7, Diagonals::uniform)},
            {"alternating grid", grid(17, 17, 1.0, 1.0, Diagonals::alternating)},
            {"random grid", grid(21, 9, 2.0, 1.0, Diagonals::random)},
            {"tetrahedron", tetrahedron()},
            {"book", book(5)},
            {"fan", fan(9)},
            {"one triangle", right_triangle()},
            {"two components", together(grid(6, 6, 1.0, 1.0, Diagonals::alternating), tetrahedron())},
            {"isolated vertices", with_isolated_vertices}};
}

}  // namespace

TEST_CASE("the filter agrees with the reference: every variant on every kind of mesh", "[filter]") {
    // All meshes as the cloths of one limiter: kernels are compiled once a variant.
    std::vector<std::string> names;
    std::vector<MovingCloth> cloths;
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const auto& [name, mesh] : meshes()) {
        names.push_back(name);
        cloths.push_back(moving_cloth(mesh, 1));
        topologies.push_back(cloths.back().topology);
    }
    for (Options options : variants)
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            options.work_group_size = work_group_size;
            StrainLimiter limiter(device().context, device().id, topologies, options);
            const CallerBuffers buffers(cloths, options);
            const std::vector<Stats> stats = filter(limiter, buffers, {&tight, 1});
            const std::vector<float> velocities = buffers.read_velocities();
            auto begin = velocities.begin();
            for (std::size_t c = 0; c < cloths.size(); ++c) {
                CAPTURE(variant_name(options), names[c]);
                const auto end = begin + static_cast<std::ptrdiff_t>(cloths[c].velocities.size());
                check_against_reference({{begin, end}, stats[c]}, cloths[c], options, tight);
                begin = end;
            }
        }
}

TEST_CASE("the filter agrees with the reference: strides, offsets, alpha per triangle", "[filter]") {
    const MovingCloth cloth = moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 2);
    for (const Options& variant : variants) {
        Options options = variant;
        options.work_group_size = 64;
        options.position_stride = 4;
        options.velocity_stride = 5;
        options.regularization_per_triangle = true;
        CAPTURE(variant_name(options));
        check_against_reference(cloth, options, tight, 7);
    }
}

TEST_CASE("the filter agrees with the reference: work-group sizes", "[filter]") {
    const MovingCloth cloth = moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 2);
    for (Options options : {many_groups, one_group})
        for (const std::uint32_t work_group_size : {2u, 32u}) {
            options.work_group_size = work_group_size;
            CAPTURE(variant_name(options));
            check_against_reference(cloth, options, tight);
        }
}

TEST_CASE("the filter agrees with the reference at the default parameters", "[filter]") {
    // A tolerance of 0.3 leaves room for different iteration counts, and thirty sub-steps iterate what differs: the
    // comparison is of what both do to the areas.
    const MovingCloth cloth = moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 3);
    for (const Options& options : {variants[0], many_groups, one_group}) {
        CAPTURE(variant_name(options));
        const Parameters parameters;
        const Filtered got = filter_on_device(cloth, options, parameters);
        const Filtered want = filter_with_reference(cloth, options, parameters);
        CHECK(got.stats.status == Status::ok);
        CHECK(got.stats.sub_steps == 30);
        CHECK(std::abs(got.stats.iterations - want.stats.iterations) <= 30);
        CHECK(std::abs(got.stats.max_area_change - want.stats.max_area_change) <= 0.002f);
        CHECK(std::abs(got.stats.rms_area_change - want.stats.rms_area_change) <= 0.0005f);
    }
}

TEST_CASE("the filter agrees with the reference on garments", "[filter]") {
    for (const char* name : {"tshirt.obj", "skirt.obj"}) {
        const std::string path = std::string(APSL_TEST_MESHES) + "/" + name;
        if (!std::ifstream(path)) {
            WARN("../shared/meshes/" << name << " is not there: passed over");
            continue;
        }
        CAPTURE(name);
        Mesh mesh = read_obj(path);
        double low = mesh.positions[1], high = low;
        for (std::size_t n = 1; n < mesh.positions.size(); n += 3) {
            low = std::min(low, mesh.positions[n]);
            high = std::max(high, mesh.positions[n]);
        }
        for (double& coordinate : mesh.positions) coordinate /= high - low;  // 1 m tall
        const MovingCloth cloth = moving_cloth(mesh, 1);
        for (const Options& options : {variants[0], many_groups, variants[3], one_group}) {
            CAPTURE(variant_name(options));
            Parameters parameters = tight;
            parameters.sub_steps = 1;
            check_against_reference(cloth, options, parameters);
        }
    }
}

TEST_CASE("iterations past the queued ones: as many as the reference's", "[filter]") {
    // The triangles' α is near 1, the one that says how many are queued is not: most iterations are finish_solve's.
    MovingCloth cloth = moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 5);
    cloth.regularization.assign(cloth.topology->triangle_count(), 1.01);
    const Parameters slow{.regularization = 2.0f, .sub_steps = 1, .tolerance = 1e-2f, .max_iterations = 50};
    host::CallBudget budget;
    budget.add(slow);
    const int queued = host::queued_iterations(cloth.topology->triangle_count(), budget, 0);
    Options many_groups = test::many_groups, one_group = test::one_group;
    many_groups.regularization_per_triangle = one_group.regularization_per_triangle = true;
    const Filtered want = filter_with_reference(cloth, many_groups, slow);
    REQUIRE(want.stats.iterations > queued + 2);
    REQUIRE(want.stats.iterations < 50);
    for (Options options : {many_groups, one_group})
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            options.work_group_size = work_group_size;
            CAPTURE(variant_name(options));
            const Filtered got = filter_on_device(cloth, options, slow);
            CHECK(std::abs(got.stats.iterations - want.stats.iterations) <= 1);
            CHECK(got.stats.status == want.stats.status);
            CHECK(got.stats.residual <= slow.tolerance);
            std::vector<double> correction(want.velocities.size());
            for (std::size_t n = 0; n < correction.size(); ++n)
                correction[n] = want.velocities[n] - cloth.velocities[n];
            // Two solves that meet the tolerance, an iteration apart.
            CHECK(difference(got.velocities, want.velocities) <= 2.0 * 1e-2 * norm(correction));
        }
    // The fiftieth iteration is the last, wherever it is done.
    Parameters hopeless = slow;
    hopeless.tolerance = 1e-7f;
    cloth.regularization.assign(cloth.topology->triangle_count(), 1.0);
    for (const Options& options : {many_groups, one_group}) {
        const Filtered got = filter_on_device(cloth, options, hopeless);
        CHECK(got.stats.iterations == 50);
        CHECK(got.stats.residual > hopeless.tolerance);
    }
}

TEST_CASE("adaptive alpha: raised, restored and kept between calls as the reference does it", "[filter]") {
    const MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 2);
    const Parameters tight_budget{
        .regularization = 1.01f, .sub_steps = 4, .tolerance = 1e-2f, .max_iterations = 6, .adaptive_threshold = 5};
    const Parameters roomy{
        .regularization = 1.3f, .sub_steps = 2, .tolerance = 0.1f, .max_iterations = 50, .adaptive_threshold = 40};
    for (Options options : variants) {
        if (options.matrix == Matrix::printed) continue;  // amplifies what differs, see docs/formulation.md
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            options.work_group_size = work_group_size;
            CAPTURE(variant_name(options));
            StrainLimiter limiter(device().context, device().id, cloth.topology, options);
            reference::StrainLimiter expected(cloth.topology, options);
            int unconverged = 0;
            for (const Parameters& parameters : {tight_budget, tight_budget, tight_budget, roomy, roomy, roomy}) {
                const CallerBuffers buffers({&cloth, 1}, options);
                const Stats got = filter(limiter, buffers, {&parameters, 1})[0];
                std::vector<double> velocities = cloth.velocities;
                expected.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}}, parameters);
                const Stats want = expected.read_stats();
                CHECK(got.status == want.status);
                CHECK(std::abs(got.iterations - want.iterations) <= want.sub_steps);
                unconverged += want.status == Status::not_converged;
                std::vector<double> correction(velocities);
                for (std::size_t n = 0; n < correction.size(); ++n) correction[n] -= cloth.velocities[n];
                const std::vector<float> read = buffers.read_velocities();
                const std::vector<double> filtered(read.begin(), read.end());
                CHECK(difference(filtered, velocities) <= 0.02 * norm(correction));
            }
            // It begins too hard, and α rises until it is not.
            CHECK(unconverged > 0);
            CHECK(unconverged < 3);
            // Off again: a limiter that never adapted gives the same bytes.
            const Parameters plain{.sub_steps = 2};
            const CallerBuffers after({&cloth, 1}, options), fresh({&cloth, 1}, options);
            Parameters adapting = plain;
            adapting.adaptive_threshold = 1;
            filter(limiter, CallerBuffers({&cloth, 1}, options), {&adapting, 1});
            filter(limiter, CallerBuffers({&cloth, 1}, options), {&plain, 1});  // the factor is left behind here
            filter(limiter, after, {&plain, 1});
            StrainLimiter another(device().context, device().id, cloth.topology, options);
            filter(another, fresh, {&plain, 1});
            CHECK(same_bytes(after.read_velocities(), fresh.read_velocities()));
        }
    }
}

TEST_CASE("alpha that changes over the sub-steps: as the reference does it", "[filter]") {
    const MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 2);
    for (const auto& [first, last] : {std::pair{1.1f, 1.6f}, std::pair{2.0f, 1.2f}}) {
        Parameters parameters = tight;
        parameters.regularization = last;
        parameters.first_regularization = first;
        for (Options options : variants) {
            if (options.matrix == Matrix::printed) continue;  // amplifies what differs, see docs/formulation.md
            for (const bool per_triangle : {false, true}) {
                options.regularization_per_triangle = per_triangle;
                CAPTURE(variant_name(options), first, last, per_triangle);
                check_against_reference(cloth, options, parameters);
            }
        }
        const Filtered scheduled = filter_on_device(cloth, one_group, parameters);
        parameters.first_regularization = 0.0f;
        const Filtered fixed = filter_on_device(cloth, one_group, parameters);
        CHECK(difference(scheduled.velocities, fixed.velocities) > 1e-3 * norm(fixed.velocities));
    }
}

TEST_CASE("warm start: the guess a call starts from is the reference's, and a broken call leaves no harm", "[filter]") {
    MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 2);
    const double first_coordinate = cloth.positions[40];
    // More sub-steps than warm start: the last two share a place.
    const Parameters parameters{.regularization = 1.3f,
                                .sub_steps = 3,
                                .tolerance = 1e-3f,
                                .max_iterations = 100,
                                .first_regularization = 1.05f};
    for (Options options : variants) {
        if (options.matrix == Matrix::printed) continue;  // amplifies what differs, see docs/formulation.md
        options.warm_start_sub_steps = 2;
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            options.work_group_size = work_group_size;
            CAPTURE(variant_name(options));
            StrainLimiter limiter(device().context, device().id, cloth.topology, options);
            reference::StrainLimiter expected(cloth.topology, options);
            int cold = 0, warm = 0;
            for (const int call : {0, 1, 2, 3}) {
                cloth.positions[40] = call == 2 ? std::nan("") : first_coordinate;
                const CallerBuffers buffers({&cloth, 1}, options);
                const Stats got = filter(limiter, buffers, {&parameters, 1})[0];
                std::vector<double> velocities = cloth.velocities;
                expected.enqueue({cloth.positions, velocities, cloth.inverse_masses, cloth.rest_areas, {}}, parameters);
                const Stats want = expected.read_stats();
                CAPTURE(call);
                CHECK(got.status == (call == 2 ? Status::diverged : Status::ok));
                if (call == 2) continue;
                CHECK(std::abs(got.iterations - want.iterations) <= want.sub_steps);
                (call == 0 ? cold : warm) = got.iterations;
                std::vector<double> correction(velocities);
                for (std::size_t n = 0; n < correction.size(); ++n) correction[n] -= cloth.velocities[n];
                const std::vector<float> read = buffers.read_velocities();
                const std::vector<double> filtered(read.begin(), read.end());
                CHECK(difference(filtered, velocities) <= 0.02 * norm(correction));
            }
            // The same call again: the first solve has nothing left to do; the third's guess is the second's.
            CHECK(3 * warm < 2 * cold);
        }
    }
    cloth.positions[40] = first_coordinate;
}

TEST_CASE("several cloths in one limiter: as each one alone", "[filter]") {
    const std::vector<MovingCloth> cloths{moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 1),
                                          moving_cloth(right_triangle(), 2), moving_cloth(tetrahedron(), 3),
                                          moving_cloth(grid(9, 5, 1.0, 1.0, Diagonals::random), 4)};
    const std::vector<Parameters> parameters{
        {.regularization = 1.3f, .sub_steps = 4, .tolerance = 1e-4f},
        {.time_step = 0.01f, .regularization = 1.1f, .sub_steps = 1, .tolerance = 1e-4f},
        {.time_step = 0.02f, .regularization = 2.0f, .sub_steps = 0},
        {.regularization = 1.5f, .sub_steps = 6, .tolerance = 1e-4f, .max_iterations = 90}};
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const MovingCloth& cloth : cloths) topologies.push_back(cloth.topology);
    for (const Options& options : variants) {
        CAPTURE(variant_name(options));
        StrainLimiter limiter(device().context, device().id, topologies, options);
        const CallerBuffers buffers(cloths, options);
        const std::vector<Stats> stats = filter(limiter, buffers, parameters);
        const std::vector<float> velocities = buffers.read_velocities();
        std::size_t begin = 0;
        for (std::size_t c = 0; c < cloths.size(); ++c) {
            CAPTURE(c);
            const Filtered alone = filter_on_device(cloths[c], options, parameters[c]);
            double off = 0.0;
            for (std::size_t n = 0; n < alone.velocities.size(); ++n)
                off = std::max(off, std::abs(static_cast<double>(velocities[begin + n]) - alone.velocities[n]));
            // Sums are grouped otherwise, so solves may differ within their tolerance.
            CHECK(off <= 0.002 * greatest(alone.velocities));
            CHECK(stats[c].sub_steps == parameters[c].sub_steps);
            CHECK(stats[c].status == alone.stats.status);
            CHECK(std::abs(stats[c].iterations - alone.stats.iterations) <= parameters[c].sub_steps);
            begin += alone.velocities.size();
        }
    }
}

TEST_CASE("many cloths in one launch: each the very bytes it has alone", "[filter]") {
    // More than one block of parameters, everything different.
    std::vector<MovingCloth> cloths;
    std::vector<Parameters> parameters;
    const std::vector<Mesh> different{grid(9, 11, 1.0, 1.0, Diagonals::alternating), fan(9), right_triangle()};
    for (std::uint32_t n = 0; n < 5; ++n)
        for (const Mesh& mesh : different)
            for (const float alpha : {1.05f, 1.6f}) {
                const auto count = static_cast<std::int32_t>(cloths.size());
                cloths.push_back(moving_cloth(mesh, n + 1));
                parameters.push_back({.time_step = n % 2 == 0 ? 1.0f / 60.0f : 0.01f,
                                      .regularization = alpha,
                                      .sub_steps = count % 5,
                                      .target_area_change = count % 3 == 0 ? 0.05f : 0.0f,
                                      .tolerance = count % 2 == 0 ? 0.1f : 1e-3f,
                                      .max_iterations = 3 + 7 * (count % 4),
                                      .adaptive_threshold = count % 4 == 1 ? 2 : 0});
            }
    REQUIRE(cloths.size() > 24);
    std::vector<std::shared_ptr<const Topology>> topologies;
    for (const MovingCloth& cloth : cloths) topologies.push_back(cloth.topology);
    for (const std::uint32_t work_group_size : compared_group_sizes()) {
        Options options = one_group;
        options.work_group_size = work_group_size;
        StrainLimiter limiter(device().context, device().id, topologies, options);
        const CallerBuffers buffers(cloths, options);
        const std::vector<Stats> stats = filter(limiter, buffers, parameters);
        const std::vector<float> velocities = buffers.read_velocities();
        auto own = velocities.begin();
        for (std::size_t c = 0; c < cloths.size(); ++c) {
            CAPTURE(work_group_size, c);
            StrainLimiter alone(device().context, device().id, cloths[c].topology, options);
            const CallerBuffers own_buffers({&cloths[c], 1}, options);
            const std::vector<Stats> own_stats = filter(alone, own_buffers, {&parameters[c], 1});
            const std::vector<float> expected = own_buffers.read_velocities();
            const auto end = own + static_cast<std::ptrdiff_t>(expected.size());
            CHECK(same_bytes({own, end}, expected));
            CHECK(same_bytes({stats[c]}, own_stats));
            own = end;
        }
    }
}

TEST_CASE("a cloth that diverges leaves the others alone", "[filter]") {
    for (const Options& options : {many_groups, one_group}) {
        CAPTURE(variant_name(options));
        std::vector<MovingCloth> cloths{moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1),
                                        moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::uniform), 2)};
        const Filtered alone = filter_on_device(cloths[1], options, Parameters{});
        cloths[0].positions[40] = std::nan("");
        const std::vector<std::shared_ptr<const Topology>> topologies{cloths[0].topology, cloths[1].topology};
        StrainLimiter limiter(device().context, device().id, topologies, options);
        const CallerBuffers buffers(cloths, options);
        const Parameters parameters;
        const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
        CHECK(stats[0].status == Status::diverged);
        CHECK(stats[1].status == Status::ok);
        const std::vector<float> velocities = buffers.read_velocities();
        const std::vector<double> second(velocities.begin() + cloths[0].velocities.size(), velocities.end());
        // Equal cloths, equal groups: equal bytes.
        CHECK(second == alone.velocities);
    }
}

TEST_CASE("the filter agrees with the reference: small steps", "[filter]") {
    const MovingCloth cloth = moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 2);
    Parameters small_steps = tight;
    small_steps.sub_steps = 4;
    small_steps.stepping = Stepping::small_steps;
    for (Options options : {variants[0], many_groups, one_group})
        for (const std::uint32_t work_group_size : compared_group_sizes()) {
            options.work_group_size = work_group_size;
            CAPTURE(variant_name(options));
            check_against_reference(cloth, options, small_steps);
        }
}

TEST_CASE("the filter agrees with the reference: small steps from a start with other areas than at rest", "[filter]") {
    MovingCloth cloth = moving_cloth(grid(17, 17, 1.0, 1.0, Diagonals::alternating), 2);
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a)
        cloth.rest_areas[a] = static_cast<float>(cloth.rest_areas[a] * (a % 3 == 0 ? 1.3 : 0.9));
    Parameters small_steps = tight;
    small_steps.sub_steps = 6;
    small_steps.stepping = Stepping::small_steps;
    for (const Options& options : {many_groups, one_group}) {
        CAPTURE(variant_name(options));
        check_against_reference(cloth, options, small_steps);
    }
}

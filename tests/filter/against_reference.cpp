// SPDX-License-Identifier: MIT
#include "filter/filtered.hpp"

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

std::string variant_name(const Options& options) {
    return std::string(options.matrix == Matrix::consistent ? "consistent" : "printed") +
           (options.apply == Apply::assembled_csr ? ", assembled" : ", matrix-free");
}

}  // namespace

TEST_CASE("the filter agrees with the reference: every variant on every kind of mesh", "[filter]") {
    for (const Options& options : variants)
        for (const auto& [name, mesh] : meshes()) {
            CAPTURE(variant_name(options), name);
            check_against_reference(moving_cloth(mesh, 1), options, tight);
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
    for (const std::uint32_t work_group_size : {1u, 2u, 32u, 256u}) {
        CAPTURE(work_group_size);
        check_against_reference(cloth, {.work_group_size = work_group_size}, tight);
    }
}

TEST_CASE("the filter agrees with the reference at the default parameters", "[filter]") {
    // A tolerance of 0.1 leaves room for different iteration counts, and ten sub-steps iterate what differs: the
    // comparison is of what both do to the areas.
    const MovingCloth cloth = moving_cloth(grid(33, 33, 1.0, 1.0, Diagonals::alternating), 3);
    for (const Apply apply : {Apply::assembled_csr, Apply::matrix_free}) {
        const Parameters parameters;
        const Filtered got = filter_on_device(cloth, {.apply = apply}, parameters);
        const Filtered want = filter_with_reference(cloth, {.apply = apply}, parameters);
        CHECK(got.stats.status == Status::ok);
        CHECK(got.stats.sub_steps == 10);
        CHECK(std::abs(got.stats.cg_iterations - want.stats.cg_iterations) <= 10);
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
        for (const Options& options : {variants[0], variants[1], variants[3]}) {
            CAPTURE(variant_name(options));
            Parameters parameters = tight;
            parameters.sub_steps = 1;
            check_against_reference(cloth, options, parameters);
        }
    }
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
            CHECK(stats[c].status == Status::ok);
            CHECK(std::abs(stats[c].cg_iterations - alone.stats.cg_iterations) <= parameters[c].sub_steps);
            begin += alone.velocities.size();
        }
    }
}

TEST_CASE("a cloth that diverges leaves the others alone", "[filter]") {
    std::vector<MovingCloth> cloths{moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1),
                                    moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::uniform), 2)};
    const Filtered alone = filter_on_device(cloths[1], {}, Parameters{});
    cloths[0].positions[40] = std::nan("");
    const std::vector<std::shared_ptr<const Topology>> topologies{cloths[0].topology, cloths[1].topology};
    StrainLimiter limiter(device().context, device().id, topologies);
    const CallerBuffers buffers(cloths, {});
    const Parameters parameters;
    const std::vector<Stats> stats = filter(limiter, buffers, {&parameters, 1});
    CHECK(stats[0].status == Status::diverged);
    CHECK(stats[1].status == Status::ok);
    const std::vector<float> velocities = buffers.read_velocities();
    const std::vector<double> second(velocities.begin() + cloths[0].velocities.size(), velocities.end());
    // Equal cloths, equal groups: equal bytes.
    CHECK(second == alone.velocities);
}

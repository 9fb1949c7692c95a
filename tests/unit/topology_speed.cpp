// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"

#include <apsl/topology.hpp>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <string_view>

using namespace apsl;

TEST_CASE("a grid of 2.1 million triangles builds in under 2 s") {
    const test::Mesh mesh = test::grid(1025, 1025, 1, 1, test::Diagonals::alternating);
    double seconds = 0.0;
    std::shared_ptr<const Topology> topology;
    // The better of two: the machine may be busy with something else.
    for (int attempt = 0; attempt < 2; ++attempt) {
        const auto start = std::chrono::steady_clock::now();
        topology = Topology::build(mesh.triangles, mesh.vertex_count());
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        seconds = attempt == 0 ? taken.count() : std::min(seconds, taken.count());
    }
    CHECK(topology->triangle_count() == 2097152);
    CHECK(topology->edges().size() == 3 * 1024 * 1024 + 2 * 1024);
    CHECK(topology->boundary_edge_count() == 4 * 1024);
    CHECK(topology->component_count() == 1);

    CAPTURE(seconds);
    if (std::string_view(APSL_TEST_BUILD_TYPE) == "Release")
        CHECK(seconds < 2.0);
    else
        WARN("built in " << seconds << " s; the limit of 2 s is for Release builds, this one is " APSL_TEST_BUILD_TYPE);
}

// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"
#include "support/processor_time.hpp"

#include <apsl/topology.hpp>

#include <catch2/catch.hpp>

using namespace apsl;

TEST_CASE("a topology's time grows with the triangles, up to 2.1 million") {
    std::shared_ptr<const Topology> topology;
    const auto seconds = [&](std::uint32_t side) {
        const test::Mesh mesh = test::grid(side, side, 1, 1, test::Diagonals::alternating);
        return test::processor_seconds([&] { topology = Topology::build(mesh.triangles, mesh.vertex_count()); });
    };
    const double eighth = seconds(363), whole = seconds(1025);  // 262,088 and 2,097,152 triangles
    CHECK(topology->triangle_count() == 2097152);
    CHECK(topology->edges().size() == 3 * 1024 * 1024 + 2 * 1024);
    CHECK(topology->boundary_edge_count() == 4 * 1024);
    CHECK(topology->component_count() == 1);
    CAPTURE(eighth, whole);
    CHECK(whole < 24.0 * eighth);  // 64 where each triangle looks at all others
}

// SPDX-License-Identifier: MIT
#include "unit/sample_meshes.hpp"

#include <apsl/topology.hpp>

#include <algorithm>
#include <catch2/catch.hpp>

using namespace apsl;

TEST_CASE("hinges known by heart", "[hinges]") {
    // Vertices of an edge in ascending order, whatever way the triangles are turned; the first triangle's corner first.
    CHECK(Topology::build(std::vector<Triangle>{{2, 0, 3}, {1, 2, 0}}, 4)->hinges() ==
          std::vector<Hinge>{{0, 2, 3, 1}});
    CHECK(Topology::build(std::vector<Triangle>{{0, 1, 2}}, 3)->hinges().empty());
    const test::Mesh fan = test::fan(3);
    CHECK(Topology::build(fan.triangles, fan.vertex_count())->hinges() ==
          std::vector<Hinge>{{0, 2, 1, 3}, {0, 3, 2, 4}});
    // Three pages have no hinge at their back: which two of them belong together is not known.
    const test::Mesh book = test::book(3);
    CHECK(Topology::build(book.triangles, book.vertex_count())->hinges().empty());
}

TEST_CASE("every edge of two triangles is a hinge, and no other", "[hinges]") {
    for (const auto& [name, mesh] : test::small_meshes()) {
        INFO(name);
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        const std::vector<Hinge> hinges = topology->hinges();
        CHECK(hinges.size() == topology->hinge_count());
        std::size_t found = 0;
        for (std::size_t e = 0; e < topology->edges().size(); ++e) {
            if (topology->edge_corner_offsets()[e + 1] - topology->edge_corner_offsets()[e] != 2) continue;
            REQUIRE(found < hinges.size());
            const Hinge& hinge = hinges[found++];
            CHECK(VertexPair{hinge[0], hinge[1]} == topology->edges()[e]);
            for (const std::uint32_t opposite : {hinge[2], hinge[3]})
                CHECK(std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](Triangle t) {
                    Triangle wanted{hinge[0], hinge[1], opposite};
                    std::sort(t.begin(), t.end());
                    std::sort(wanted.begin(), wanted.end());
                    return t == wanted;
                }));
        }
        CHECK(found == hinges.size());
    }
}

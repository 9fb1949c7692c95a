// SPDX-License-Identifier: MIT
#include "patches.hpp"
#include "support/processor_time.hpp"
#include "unit/sample_meshes.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <set>
#include <utility>

using namespace apsl;

namespace {

bool each_once(std::vector<std::uint32_t> order, std::size_t count) {
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    return order == all;
}

// Over all patches, the vertices a patch's triangles have.
std::size_t vertices_gathered(const Topology& topology, const Patches& patches) {
    std::vector<std::size_t> last_patch(topology.vertex_count(), patches.patch_offsets.size());
    std::size_t sum = 0;
    for (std::size_t p = 0; p + 1 < patches.patch_offsets.size(); ++p)
        for (std::uint32_t place = patches.patch_offsets[p]; place < patches.patch_offsets[p + 1]; ++place)
            for (const std::uint32_t vertex : topology.triangles()[patches.triangle_order[place]])
                if (last_patch[vertex] != p) {
                    last_patch[vertex] = p;
                    ++sum;
                }
    return sum;
}

void check_patches(const Topology& topology, std::uint32_t max_triangles) {
    const Patches patches = build_patches(topology, max_triangles);
    CHECK(each_once(patches.triangle_order, topology.triangle_count()));
    CHECK(each_once(patches.vertex_order, topology.vertex_count()));
    REQUIRE(patches.patch_offsets.size() >= 2);
    CHECK(patches.patch_offsets.front() == 0);
    CHECK(patches.patch_offsets.back() == topology.triangle_count());
    for (std::size_t p = 0; p + 1 < patches.patch_offsets.size(); ++p) {
        CHECK(patches.patch_offsets[p] < patches.patch_offsets[p + 1]);
        CHECK(patches.patch_offsets[p + 1] - patches.patch_offsets[p] <= max_triangles);
    }
    // No more patches than that takes.
    CHECK(patches.patch_offsets.size() - 1 == (topology.triangle_count() + max_triangles - 1) / max_triangles);

    // Vertices by the patch of their first use, in it by valence, those of no triangle last.
    const std::size_t never = patches.patch_offsets.size();
    std::vector<std::size_t> first_patch(topology.vertex_count(), never);
    for (std::size_t p = patches.patch_offsets.size() - 1; p-- > 0;)
        for (std::uint32_t place = patches.patch_offsets[p]; place < patches.patch_offsets[p + 1]; ++place)
            for (const std::uint32_t vertex : topology.triangles()[patches.triangle_order[place]])
                first_patch[vertex] = p;
    const auto rank = [&](std::uint32_t vertex) {
        return std::pair(first_patch[vertex],
                         topology.corner_offsets()[vertex + 1] - topology.corner_offsets()[vertex]);
    };
    CHECK(std::is_sorted(patches.vertex_order.begin(), patches.vertex_order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); }));
}

}  // namespace

TEST_CASE("patches hold every triangle and vertex once, none too many, on every kind of mesh") {
    for (const test::SampleMesh& sample : test::small_meshes())
        for (const std::uint32_t max_triangles : {1u, 2u, 7u, 64u, 4096u}) {
            CAPTURE(sample.name, max_triangles);
            check_patches(*Topology::build(sample.mesh.triangles, sample.mesh.vertex_count()), max_triangles);
        }
}

TEST_CASE("patches of garments") {
    for (const test::SampleMesh& sample : test::garments()) {
        CAPTURE(sample.name);
        const auto topology = Topology::build(sample.mesh.triangles, sample.mesh.vertex_count());
        check_patches(*topology, 1024);
        check_patches(*topology, 37);
    }
}

TEST_CASE("patches are compact: few vertices belong to several") {
    for (const test::Diagonals diagonals :
         {test::Diagonals::uniform, test::Diagonals::alternating, test::Diagonals::random}) {
        const test::Mesh mesh = test::grid(129, 129, 1, 1, diagonals);
        const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
        check_patches(*topology, 1024);
        const Patches patches = build_patches(*topology, 1024);
        const auto vertices = static_cast<double>(topology->vertex_count());
        const auto gathered = static_cast<double>(vertices_gathered(*topology, patches));
        // A square of 1024 triangles has 23² vertices, 92 on its rim: 1.08 in the best case.
        CHECK(gathered > vertices);
        CHECK(gathered <= 1.25 * vertices);
    }
}

TEST_CASE("a patch of a grid is connected until the rest is too small for one") {
    const test::Mesh mesh = test::grid(65, 65, 1, 1, test::Diagonals::alternating);
    const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
    const Patches patches = build_patches(*topology, 256);
    // The first patch grows freely: every triangle after the first shares a vertex with one before it.
    std::set<std::uint32_t> reached;
    for (std::uint32_t place = 0; place < patches.patch_offsets[1]; ++place) {
        const Triangle& triangle = topology->triangles()[patches.triangle_order[place]];
        if (place > 0)
            CHECK(std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t v) { return reached.count(v) > 0; }));
        reached.insert(triangle.begin(), triangle.end());
    }
}

TEST_CASE("patches: the time grows with the triangles, up to 2.1 million") {
    std::shared_ptr<const Topology> topology;
    Patches patches;
    const auto seconds = [&](std::uint32_t side) {
        const test::Mesh mesh = test::grid(side, side, 1, 1, test::Diagonals::alternating);
        topology = Topology::build(mesh.triangles, mesh.vertex_count());
        return test::processor_seconds([&] { patches = build_patches(*topology, 1024); });
    };
    const double eighth = seconds(363), whole = seconds(1025);  // 262,088 and 2,097,152 triangles
    CHECK(patches.patch_offsets.size() == 2048 + 1);
    CHECK(static_cast<double>(vertices_gathered(*topology, patches)) <=
          1.25 * static_cast<double>(topology->vertex_count()));
    CAPTURE(eighth, whole);
    CHECK(whole < 24.0 * eighth);  // 64 where each triangle looks at all others
}

TEST_CASE("patches: the time grows with the triangles around one vertex or edge, up to 1.6 million") {
    Patches patches;
    const auto seconds = [&](std::uint32_t count, bool at_one_edge) {
        std::vector<Triangle> triangles;
        for (std::uint32_t t = 0; t < count; ++t) triangles.push_back({0, at_one_edge ? 1 : t + 1, t + 2});
        const auto topology = Topology::build(triangles, count + 2);
        const double taken = test::processor_seconds([&] { patches = build_patches(*topology, 1024); });
        CHECK(each_once(patches.triangle_order, count));
        return taken;
    };
    for (const bool at_one_edge : {false, true}) {
        const double eighth = seconds(200'000, at_one_edge), whole = seconds(1'600'000, at_one_edge);
        CAPTURE(at_one_edge, eighth, whole);
        CHECK(whole < 24.0 * eighth);  // 64 where each triangle, or each patch, looks at all around the vertex
    }
}

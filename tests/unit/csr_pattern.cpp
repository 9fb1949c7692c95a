// SPDX-License-Identifier: MIT
//
// Both patterns against every pair of triangles, compared vertex by vertex.

#include "unit/sample_meshes.hpp"

#include <apsl/topology.hpp>

#include <algorithm>
#include <catch2/catch.hpp>

using namespace apsl;

namespace {

VertexPair opposite_edge(const Triangle& t, unsigned k) {
    const std::uint32_t u = t[(k + 1) % 3];
    const std::uint32_t v = t[(k + 2) % 3];
    return {std::min(u, v), std::max(u, v)};
}

/// Corner of c that meets corner k of a, by the words of CsrPattern.
unsigned met_corner(const Triangle& a, unsigned k, const Triangle& c, Matrix matrix) {
    for (unsigned m = 0; m < 3; ++m)
        if (matrix == Matrix::consistent ? a[k] == c[m] : opposite_edge(a, k) == opposite_edge(c, m)) return m;
    return 3;
}

void check_pattern(const test::SampleMesh& sample, Matrix matrix) {
    INFO(sample.name << (matrix == Matrix::consistent ? ", consistent" : ", printed"));
    const std::vector<Triangle>& triangles = sample.mesh.triangles;
    const CsrPattern pattern = Topology::build(triangles, sample.mesh.vertex_count())->csr_pattern(matrix);
    REQUIRE(pattern.row_offsets.size() == triangles.size() + 1);
    REQUIRE(pattern.row_offsets.front() == 0);
    REQUIRE(pattern.row_offsets.back() == pattern.columns.size());
    REQUIRE(pattern.shared.size() == pattern.columns.size());

    // Every pair of triangles is too many on a garment: there, some 300 rows spread over it.
    const std::size_t stride = 1 + triangles.size() / 300;
    for (std::size_t a = 0; a < triangles.size(); a += stride) {
        std::vector<std::uint32_t> columns;
        std::vector<unsigned> shared;
        for (std::uint32_t c = 0; c < triangles.size(); ++c) {
            const unsigned met[3] = {met_corner(triangles[a], 0, triangles[c], matrix),
                                     met_corner(triangles[a], 1, triangles[c], matrix),
                                     met_corner(triangles[a], 2, triangles[c], matrix)};
            if (met[0] == 3 && met[1] == 3 && met[2] == 3) continue;
            columns.push_back(c);
            shared.push_back(met[0] + 4 * met[1] + 16 * met[2]);
        }
        const std::uint32_t begin = pattern.row_offsets[a];
        const std::uint32_t end = pattern.row_offsets[a + 1];
        INFO("row " << a);
        REQUIRE(std::vector<std::uint32_t>(&pattern.columns[begin], &pattern.columns[end - 1] + 1) == columns);
        REQUIRE(std::vector<unsigned>(&pattern.shared[begin], &pattern.shared[end - 1] + 1) == shared);
    }
}

}  // namespace

TEST_CASE("csr patterns agree with every pair of triangles") {
    for (const auto& sample : test::small_meshes()) {
        check_pattern(sample, Matrix::consistent);
        check_pattern(sample, Matrix::printed);
    }
}

TEST_CASE("csr patterns agree with pairs of triangles on the garments") {
    for (const auto& sample : test::garments()) {
        check_pattern(sample, Matrix::consistent);
        check_pattern(sample, Matrix::printed);
    }
}

TEST_CASE("csr pattern of a pair, by hand") {
    // Triangles (0, 2, 1) and (1, 2, 3) share the edge 1-2: opposite corner 0 of the first, corner 2 of the second.
    const test::Mesh mesh = test::grid(2, 2, 1, 1, test::Diagonals::uniform);
    REQUIRE(mesh.triangles == std::vector<Triangle>{{0, 2, 1}, {1, 2, 3}});
    const auto topology = Topology::build(mesh.triangles, 4);
    constexpr unsigned itself = 0 + 4 * 1 + 16 * 2;

    const CsrPattern consistent = topology->csr_pattern(Matrix::consistent);
    CHECK(consistent.row_offsets == std::vector<std::uint32_t>{0, 2, 4});
    CHECK(consistent.columns == std::vector<std::uint32_t>{0, 1, 0, 1});
    // Vertex 0 is not shared; vertices 2 and 1 of the first are corners 1 and 0 of the second.
    CHECK(consistent.shared == std::vector<std::uint8_t>{itself, 3 + 4 * 1 + 16 * 0, 2 + 4 * 1 + 16 * 3, itself});

    const CsrPattern printed = topology->csr_pattern(Matrix::printed);
    CHECK(printed.columns == std::vector<std::uint32_t>{0, 1, 0, 1});
    CHECK(printed.shared == std::vector<std::uint8_t>{itself, 2 + 4 * 3 + 16 * 3, 3 + 4 * 3 + 16 * 0, itself});
}

TEST_CASE("an inner row on a valence-6 mesh has 13 entries in the consistent pattern and 4 in the printed one") {
    const test::Mesh mesh = test::grid(9, 9, 1, 1, test::Diagonals::uniform);
    const auto topology = Topology::build(mesh.triangles, mesh.vertex_count());
    const std::size_t middle = mesh.triangles.size() / 2 + 8;
    for (const auto& [matrix, entries] : {std::pair{Matrix::consistent, 13u}, std::pair{Matrix::printed, 4u}}) {
        const CsrPattern pattern = topology->csr_pattern(matrix);
        CHECK(pattern.row_offsets[middle + 1] - pattern.row_offsets[middle] == entries);
    }
}

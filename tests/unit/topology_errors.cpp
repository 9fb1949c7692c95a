// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"

#include <apsl/error.hpp>
#include <apsl/topology.hpp>

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl;

namespace {

std::string message_of(std::span<const Triangle> triangles, std::size_t vertex_count) {
    try {
        Topology::build(triangles, vertex_count);
    } catch (const Error& error) {
        CHECK(error.code() == ErrorCode::invalid_mesh);
        CHECK(error.opencl_code() == 0);
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("a mesh without triangles is refused") {
    CHECK(message_of({}, 3) == "the mesh has no triangles, expected at least one");
}

TEST_CASE("an index out of range is refused by name") {
    const std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 4}};
    CHECK(message_of(triangles, 4) ==
          "triangle 1 (2, 1, 4) names vertex 4, expected an index below the vertex count 4");
    CHECK(message_of(triangles, 5) == "no error");
    CHECK(message_of(triangles, 0) ==
          "triangle 0 (0, 1, 2) names vertex 0, expected an index below the vertex count 0");
    constexpr std::uint32_t greatest = std::numeric_limits<std::uint32_t>::max();
    CHECK(message_of(std::vector<Triangle>{{0, 1, greatest}}, 3) ==
          "triangle 0 (0, 1, 4294967295) names vertex 4294967295, expected an index below the vertex count 3");
}

TEST_CASE("a triangle that names a vertex twice is refused, wherever it does so") {
    for (const Triangle& twice : {Triangle{1, 1, 2}, Triangle{2, 1, 1}, Triangle{1, 2, 1}}) {
        const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, twice};
        CHECK_THAT(message_of(triangles, 4), Catch::StartsWith("triangle 2 (") &&
                                                 Catch::EndsWith("names a vertex twice, expected three different "
                                                                 "vertices"));
    }
}

TEST_CASE("more triangles or vertices than 32-bit numbers reach are refused before they are read") {
    // The span only claims to be so long; the size is checked first.
    const Triangle triangle{0, 1, 2};
    const std::span<const Triangle> too_many(&triangle, (std::size_t{1} << 32) / 3 + 1);
    CHECK(message_of(too_many, 3) == "the mesh has 1431655766 triangles, expected at most 1431655765");
    CHECK(message_of({&triangle, 1}, std::size_t{1} << 32) ==
          "the mesh has 4294967296 vertices, expected at most 4294967295");
}

TEST_CASE("a matrix too large for 32-bit offsets is refused before it is made") {
    // 66,000 triangles around one vertex meet each other: 4.4 thousand million entries.
    std::vector<Triangle> umbrella;
    for (std::uint32_t n = 1; n <= 66000; ++n) umbrella.push_back({0, n, n + 1});
    const auto topology = Topology::build(umbrella, 66002);
    try {
        topology->csr_pattern(Matrix::consistent);
        FAIL("no error");
    } catch (const Error& error) {
        CHECK(error.code() == ErrorCode::invalid_mesh);
        CHECK(std::string(error.what()) ==
              "the matrix has at least 4356000000 entries, expected at most 4294967295 "
              "(too many triangles meet at one vertex or edge)");
    }
    CHECK(topology->csr_pattern(Matrix::printed).columns.size() == 3 * 66000 - 2);
}

// SPDX-License-Identifier: MIT
//
// What holds for the methods that go constraint by constraint.

#include "bench/methods/sample_cloths.hpp"

#include <catch2/catch.hpp>

using namespace apsl;
using namespace apsl::test;
using methods::Cloth;

namespace {

const char* const local_methods[] = {
    "pbd_edges",        "edge_limits_gauss_seidel", "edge_limits_jacobi", "pbd_area_gauss_seidel",
    "pbd_area_colored", "pbd_area_jacobi",          "xpbd_edges",         "xpbd_area",
    "ring_area"};

}  // namespace

TEST_CASE("Without pins, an iteration keeps the centre of mass", "[methods]") {
    Cloth cloth = cloth_of(grid(7, 5, 1.0, 0.8, Diagonals::random));
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
        cloth.inverse_masses[v] = 0.5 + 0.3 * static_cast<double>(v % 5);
    const auto start = stretched(cloth, 1.25f);
    for (const char* const method : local_methods) {
        INFO(method);
        const auto moved = projected(cloth, method, start, {{"iterations", 1}});
        CHECK((first_moment(cloth, moved) - first_moment(cloth, start)).norm() < 1e-5);
    }
}

TEST_CASE("A cloth collapsed to a point has no direction to be pushed in, and stays", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    const std::vector<Eigen::Vector3f> point(25, Eigen::Vector3f(1.0f, 2.0f, 3.0f));
    for (const char* const method : local_methods) {
        INFO(method);
        CHECK(same_bytes(projected(cloth, method, point), point));
    }
}

TEST_CASE("A compliant method keeps no multiplier from one call to the next", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    const auto start = stretched(cloth, 1.2f);
    for (const char* const name : {"xpbd_edges", "xpbd_area"}) {
        INFO(name);
        const std::vector<methods::Parameter> parameters{{"iterations", 3}, {"compliance", 0.01}};
        const auto method = methods::make_method(name, cloth, parameters);
        auto first = start;
        auto second = start;
        method->project(first);
        method->project(second);
        CHECK(same_bytes(first, second));
    }
}

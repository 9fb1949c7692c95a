// SPDX-License-Identifier: MIT
//
// What holds for every method in the table.

#include "bench/methods/sample_cloths.hpp"

#include <apsl/error.hpp>

#include <omp.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <set>

using namespace apsl;
using namespace apsl::test;
using methods::all_methods;
using methods::Cloth;
using methods::make_method;
using methods::MethodInfo;

namespace {

std::string message_of(std::string_view name, const Cloth& cloth, std::vector<methods::Parameter> parameters) {
    try {
        make_method(name, cloth, parameters);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("The table names every method once, with parameters whose values it takes", "[methods]") {
    std::set<std::string> names;
    const Cloth cloth = hanging_grid(3);
    for (const MethodInfo& info : all_methods()) {
        INFO(info.name);
        CHECK(names.insert(info.name).second);
        CHECK_FALSE(info.title.empty());
        CHECK_FALSE(info.citation.empty());
        CHECK(make_method(info.name, cloth, {}) != nullptr);
        for (const methods::ParameterInfo& parameter : info.parameters) {
            INFO(parameter.name);
            CHECK_FALSE(parameter.sweep.empty());
            CHECK(parameter.standard >= parameter.least);
            for (const double value : parameter.sweep) {
                const methods::Parameter chosen{parameter.name, value};
                CHECK(make_method(info.name, cloth, {&chosen, 1}) != nullptr);
            }
        }
    }
}

TEST_CASE("Mistakes in name, parameters and cloth are named", "[methods]") {
    using Catch::Contains;
    Cloth cloth = hanging_grid(3);
    CHECK_THAT(message_of("pdb_edges", cloth, {}), Contains("pdb_edges") && Contains("pbd_edges"));
    CHECK_THAT(message_of("pbd_edges", cloth, {{"sweeps", 3}}), Contains("sweeps") && Contains("iterations"));
    CHECK_THAT(message_of("pbd_edges", cloth, {{"iterations", 0}}), Contains("iterations is 0"));
    CHECK_THAT(message_of("pbd_edges", cloth, {{"iterations", 2.5}}), Contains("2.5") && Contains("whole"));
    CHECK_THAT(message_of("pbd_edges", cloth, {{"iterations", std::numeric_limits<double>::quiet_NaN()}}),
               Contains("nan") && Contains("finite"));
    CHECK_THAT(message_of("pbd_edges", cloth, {{"stiffness", 1.5}}), Contains("stiffness is 1.5"));
    cloth.rest_areas.pop_back();
    CHECK_THAT(message_of("pbd_edges", cloth, {}), Contains("rest_areas has 7") && Contains("expected 8"));
}

TEST_CASE("Cloth at rest stays, pinned vertices keep their bits", "[methods]") {
    const Cloth cloth = hanging_grid(9);
    for (const MethodInfo& info : all_methods()) {
        INFO(info.name);
        const auto rest = rest_of(cloth);
        const auto at_rest = projected(cloth, info.name, rest);
        for (std::size_t v = 0; v < rest.size(); ++v) CHECK((at_rest[v] - rest[v]).norm() < 1e-5f);
        auto start = stretched(cloth, 1.3f);
        start[0].y() = -0.0f;  // adding zero to it would show
        const auto moved = projected(cloth, info.name, start);
        float farthest = 0.0f;
        for (std::size_t v = 0; v < start.size(); ++v) farthest = std::max(farthest, (moved[v] - start[v]).norm());
        CHECK(farthest > 0.01f);
        for (const std::size_t pinned : {0u, 8u}) CHECK(same_bytes({moved[pinned]}, {start[pinned]}));
    }
}

TEST_CASE("The same input gives the same bytes, whatever the number of threads", "[methods]") {
    const Cloth cloth = hanging_grid(41);  // 3200 triangles, 4880 edges: enough for threads
    const auto start = stretched(cloth, 1.3f);
    const int threads_before = omp_get_max_threads();
    for (const MethodInfo& info : all_methods()) {
        INFO(info.name);
        omp_set_num_threads(1);
        const auto method = make_method(info.name, cloth, {});
        auto alone = start;
        method->project(alone);
        for (const int threads : {1, 2, 3}) {
            omp_set_num_threads(threads);
            auto again = start;
            method->project(again);
            CHECK(same_bytes(alone, again));
        }
    }
    omp_set_num_threads(threads_before);
}

TEST_CASE("Collapsed triangles and numbers that are not finite neither crash nor hang", "[methods]") {
    const Cloth cloth = hanging_grid(5);
    for (const MethodInfo& info : all_methods()) {
        INFO(info.name);
        auto line = rest_of(cloth);
        for (Eigen::Vector3f& x : line) x = {x.x(), 0.0f, 0.0f};
        projected(cloth, info.name, line);
        projected(cloth, info.name, std::vector<Eigen::Vector3f>(line.size(), Eigen::Vector3f(1.0f, 2.0f, 3.0f)));
        for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            auto broken = rest_of(cloth);
            broken[1].y() = bad;  // beside the pinned vertex 0
            const auto moved = projected(cloth, info.name, broken);
            CHECK(same_bytes({moved[0], moved[4]}, {broken[0], broken[4]}));
        }
    }
}

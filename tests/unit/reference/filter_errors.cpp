// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <catch2/catch.hpp>
#include <limits>

using namespace apsl;

namespace {

/// A legal call on a pair of triangles, to be spoilt one piece at a time.
struct Call {
    std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 1};
    std::vector<double> velocities = std::vector<double>(12, 0.5);
    std::vector<double> inverse_masses{1, 1, 1, 1};
    std::vector<double> rest_areas{0.5, 0.5};
    std::vector<double> regularization;
    Parameters parameters;

    /// What is wrong with it, "no error" for nothing. Velocities must survive a refusal.
    std::string message() {
        const auto mesh = test::grid(2, 2, 1, 1, test::Diagonals::uniform);
        reference::StrainLimiter limiter(Topology::build(mesh.triangles, 4));
        const auto before = velocities;
        try {
            limiter.enqueue({positions, velocities, inverse_masses, rest_areas, regularization}, parameters);
        } catch (const Error& error) {
            CHECK(error.code() == ErrorCode::invalid_argument);
            CHECK(velocities == before);
            return error.what();
        }
        return "no error";
    }
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("a legal call is no error") {
    CHECK(Call{}.message() == "no error");
}

TEST_CASE("arrays of the wrong size are refused by name") {
    Call call;
    SECTION("positions") {
        call.positions.pop_back();
        CHECK(call.message() == "positions holds 11 numbers, expected 12");
    }
    SECTION("velocities") {
        call.velocities.push_back(0);
        CHECK(call.message() == "velocities holds 13 numbers, expected 12");
    }
    SECTION("inverse masses") {
        call.inverse_masses.clear();
        CHECK(call.message() == "inverse_masses holds 0 numbers, expected 4");
    }
    SECTION("rest areas") {
        call.rest_areas.push_back(1);
        CHECK(call.message() == "rest_areas holds 3 numbers, expected 2");
    }
    SECTION("regularization") {
        call.regularization = {1.2};
        CHECK(call.message() == "regularization holds 1 numbers, expected 2");
    }
}

TEST_CASE("numbers out of range are refused by name and place") {
    Call call;
    SECTION("negative inverse mass") {
        call.inverse_masses[2] = -1;
        CHECK(call.message() == "inverse_masses of vertex 2 is -1, expected a finite number >= 0 (1/kg)");
    }
    SECTION("inverse mass not finite") {
        call.inverse_masses[3] = not_a_number;
        CHECK(call.message() == "inverse_masses of vertex 3 is nan, expected a finite number >= 0 (1/kg)");
    }
    SECTION("rest area negative") {
        call.rest_areas[1] = -1;
        CHECK(call.message() == "rest_areas of triangle 1 is -1, expected a finite number >= 0 (m2; 0 is not limited)");
    }
    SECTION("alpha below one on a triangle") {
        call.regularization = {1.2, 0.9};
        CHECK(call.message() == "regularization of triangle 1 is 0.9, expected a finite number >= 1");
    }
    SECTION("alpha below one for all") {
        call.parameters.regularization = 0.5f;
        CHECK(call.message() == "regularization is 0.5, expected a finite number >= 1");
    }
    SECTION("no time step") {
        call.parameters.time_step = 0;
        CHECK(call.message() == "time_step is 0, expected a finite number > 0 (s)");
    }
}

TEST_CASE("a limiter needs a topology and a known matrix") {
    CHECK_THROWS_WITH(reference::StrainLimiter(nullptr), "topology is null, expected one from Topology::build");
    const auto topology = Topology::build(test::right_triangle().triangles, 3);
    CHECK_THROWS_WITH(reference::StrainLimiter(topology, {.matrix = static_cast<Matrix>(7)}),
                      "matrix is 7, expected consistent (0) or printed (1)");
}

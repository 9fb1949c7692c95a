// SPDX-License-Identifier: MIT
//
// Algorithm 1: what it must do to a velocity, and what it must leave alone.

#include "reference/direct_solve.hpp"
#include "reference/displacements.hpp"
#include "unit/reference/run_filter.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

using namespace apsl;
using namespace apsl::reference;
using test::positions_after;
using test::run_filter;
using test::velocities_towards;

namespace {

/// 33 × 33 vertices pinned at two corners, whose velocities stretch it by a fifth both ways and let it sag.
struct Stretched {
    test::SampleCloth cloth = test::grid_cloth(33, 33, test::Diagonals::alternating);
    std::vector<double> velocities;

    Stretched() {
        cloth.inverse_masses[0] = cloth.inverse_masses[32] = 0.0;
        std::vector<double> target = cloth.positions;
        for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
            if (cloth.inverse_masses[v] == 0.0) continue;
            target[3 * v] *= 1.2;
            target[3 * v + 1] = -0.1 * (cloth.positions[3 * v + 2] + 0.5);
            target[3 * v + 2] *= 1.2;
        }
        velocities = velocities_towards(cloth, target, Parameters{}.time_step);
    }
};

struct AreaChanges {
    double max = 0.0;
    double rms = 0.0;
};

AreaChanges area_changes(const test::SampleCloth& cloth, const std::vector<double>& positions) {
    AreaChanges result;
    const auto now = areas<double>(*cloth.topology, positions);
    for (std::size_t a = 0; a < now.size(); ++a) {
        const double change = std::abs(now[a] - cloth.rest_areas[a]) / cloth.rest_areas[a];
        result.max = std::max(result.max, change);
        result.rms += change * change / static_cast<double>(now.size());
    }
    result.rms = std::sqrt(result.rms);
    return result;
}

template <class Real>
bool same_bits(const std::vector<Real>& one, const std::vector<Real>& other) {
    return one.size() == other.size() && std::memcmp(one.data(), other.data(), one.size() * sizeof(Real)) == 0;
}

}  // namespace

TEST_CASE("one sub-step on one triangle, by hand") {
    // Rest (0,0,0), (2,0,0), (0,1,0); stretched to (0,2,0). b = 2 − 1, diag G = ½ (8 + 4 + 4), α = 2: λ = 1/16.
    // g = (-2, -2, 0), (2, 0, 0), (0, 2, 0); the velocities change by −λ g / Δt.
    const test::Mesh mesh = test::right_triangle();
    test::SampleCloth cloth{"", Topology::build(mesh.triangles, 3), mesh.positions, {1, 1, 1}, {1}};
    Parameters parameters;
    parameters.time_step = 0.5f;
    parameters.regularization = 2.0f;
    parameters.sub_steps = 1;
    const std::vector<double> velocities{0, 0, 0, 0, 0, 0, 0, 2, 0};
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        const auto filtered = run_filter<double>(cloth, velocities, parameters, matrix);
        const std::vector<double> expected{0.25, 0.25, 0, -0.25, 0, 0, 0, 1.75, 0};
        for (std::size_t n = 0; n < 9; ++n) CHECK(filtered.velocities[n] == Approx(expected[n]).margin(1e-14));
        CHECK(filtered.stats.sub_steps == 1);
        CHECK(filtered.stats.iterations == 1);
        CHECK(filtered.stats.status == Status::ok);
    }
}

TEST_CASE("one sub-step is a direct solve, a displacement and a division by the time step") {
    const Stretched s;
    Parameters parameters;
    parameters.sub_steps = 1;
    parameters.tolerance = 1e-6f;
    parameters.max_iterations = 500;
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        test::SampleCloth predicted = s.cloth;
        predicted.positions = positions_after(s.cloth, s.velocities, parameters.time_step);
        const auto geometry = predicted.geometry();
        auto A = pressure_matrix<double>(matrix, *s.cloth.topology, geometry, s.cloth.inverse_masses);
        regularize(static_cast<double>(parameters.regularization), A);
        TriangleVector<double> b(static_cast<Eigen::Index>(geometry.size()));
        for (std::size_t a = 0; a < geometry.size(); ++a) b[a] = geometry[a].area - s.cloth.rest_areas[a];
        const TriangleVector<double> lambda = direct_solve(A, b);
        std::vector<double> move;
        displacements<double>(*s.cloth.topology, geometry, s.cloth.inverse_masses, {lambda.data(), geometry.size()},
                              move);

        const auto filtered = run_filter<double>(s.cloth, s.velocities, parameters, matrix);
        CHECK(filtered.stats.status == Status::ok);
        double greatest = 0.0;
        double error = 0.0;
        for (std::size_t n = 0; n < move.size(); ++n) {
            const double change = move[n] / parameters.time_step;
            greatest = std::max(greatest, std::abs(change));
            error = std::max(error, std::abs(filtered.velocities[n] - s.velocities[n] - change));
        }
        REQUIRE(greatest > 0.01);
        CHECK(error <= 1e-4 * greatest);
    }
}

TEST_CASE("a cloth at rest stays at rest, to the bit, and needs no solve") {
    for (const auto diagonals : {test::Diagonals::uniform, test::Diagonals::random}) {
        auto cloth = test::grid_cloth(9, 7, diagonals);
        cloth.positions = test::wavy(cloth.positions, 0.1);
        cloth.rest_areas = areas<double>(*cloth.topology, cloth.positions);
        const std::vector<double> still(cloth.positions.size(), 0.0);
        const auto filtered = run_filter<double>(cloth, still, Parameters{});
        CHECK(same_bits(filtered.velocities, still));
        CHECK(filtered.stats.status == Status::ok);
        CHECK(filtered.stats.sub_steps == 0);
        CHECK(filtered.stats.max_area_change == 0.0f);
    }
}

TEST_CASE("rigid motion gives no pressure") {
    auto cloth = test::grid_cloth(9, 7, test::Diagonals::random);
    cloth.positions = test::wavy(cloth.positions, 0.1);
    cloth.rest_areas = areas<double>(*cloth.topology, cloth.positions);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    std::vector<double> target(cloth.positions.size());
    for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
        const Eigen::Vector3d moved = turn * position<double>(cloth.positions, v) + Eigen::Vector3d(0.3, -1.0, 0.2);
        for (std::size_t axis = 0; axis < 3; ++axis) target[3 * v + axis] = moved[axis];
    }
    const auto velocities = velocities_towards(cloth, target, Parameters{}.time_step);
    const auto filtered = run_filter<double>(cloth, velocities, Parameters{});
    for (std::size_t n = 0; n < velocities.size(); ++n)
        CHECK(filtered.velocities[n] == Approx(velocities[n]).margin(1e-11));
    CHECK(filtered.stats.max_area_change < 1e-12f);
}

TEST_CASE("pinned vertices keep every bit of their velocity") {
    Stretched s;
    for (const std::size_t v : {0u, 32u, 500u}) {
        s.cloth.inverse_masses[v] = 0.0;
        s.velocities[3 * v] = 0.1;
        s.velocities[3 * v + 1] = -0.0;
        s.velocities[3 * v + 2] = 1e-300;
    }
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed}) {
        const auto filtered = run_filter<double>(s.cloth, s.velocities, Parameters{}, matrix);
        for (const std::size_t v : {0u, 32u, 500u})
            CHECK(std::memcmp(&filtered.velocities[3 * v], &s.velocities[3 * v], 3 * sizeof(double)) == 0);
        CHECK_FALSE(same_bits(filtered.velocities, s.velocities));
    }
}

TEST_CASE("statistics are those of the positions that the filtered velocities lead to") {
    const Stretched s;
    for (const Matrix matrix : {Matrix::consistent, Matrix::printed})
        for (const std::int32_t sub_steps : {0, 1, 10}) {
            Parameters parameters;
            parameters.sub_steps = sub_steps;
            parameters.regularization = 2.0f;
            const auto filtered = run_filter<double>(s.cloth, s.velocities, parameters, matrix);
            const auto expected =
                area_changes(s.cloth, positions_after(s.cloth, filtered.velocities, parameters.time_step));
            CHECK(filtered.stats.max_area_change == Approx(expected.max).epsilon(1e-5));
            CHECK(filtered.stats.rms_area_change == Approx(expected.rms).epsilon(1e-5));
            CHECK(filtered.stats.sub_steps == sub_steps);
            if (sub_steps == 0) CHECK(same_bits(filtered.velocities, s.velocities));
        }
}

TEST_CASE("more sub-steps leave less area change on a stretched cloth with two pinned corners") {
    const Stretched s;
    Parameters parameters;
    double last = 1e9;
    std::vector<double> rms;
    for (const std::int32_t sub_steps : {0, 1, 3, 10, 40}) {
        parameters.sub_steps = sub_steps;
        const auto filtered = run_filter<double>(s.cloth, s.velocities, parameters);
        CAPTURE(sub_steps, filtered.stats.iterations);
        CHECK(filtered.stats.status == Status::ok);
        CHECK(filtered.stats.rms_area_change < last);
        last = filtered.stats.rms_area_change;
        rms.push_back(last);
    }
    CHECK(rms[0] > 0.4);
    CHECK(rms[3] < 0.6 * rms[0]);
    CHECK(rms[4] < 0.2 * rms[0]);

    // The error is as wide as the cloth: a smaller α carries pressure further in a sub-step.
    parameters.sub_steps = 10;
    parameters.regularization = 1.01f;
    const auto tighter = run_filter<double>(s.cloth, s.velocities, parameters);
    CHECK(tighter.stats.rms_area_change < 0.2 * rms[0]);
}

TEST_CASE("the filter stops at the target area change") {
    const Stretched s;
    Parameters parameters;
    parameters.sub_steps = 100;
    parameters.regularization = 1.01f;
    parameters.max_iterations = 200;
    parameters.target_area_change = 0.05f;
    parameters.stepping = Stepping::whole_step;
    const auto filtered = run_filter<double>(s.cloth, s.velocities, parameters);
    CAPTURE(filtered.stats.sub_steps);
    CHECK(filtered.stats.max_area_change <= 0.05f);
    CHECK(filtered.stats.sub_steps > 0);
    CHECK(filtered.stats.sub_steps < 100);

    // One sub-step fewer does not do.
    parameters.sub_steps = filtered.stats.sub_steps - 1;
    CHECK(run_filter<double>(s.cloth, s.velocities, parameters).stats.max_area_change > 0.05f);
}

TEST_CASE("the same alpha for every triangle is the same as one alpha, and a greater one gives way more") {
    const Stretched s;
    const std::size_t triangle_count = s.cloth.topology->triangle_count();
    Parameters parameters;
    const auto scalar = run_filter<double>(s.cloth, s.velocities, parameters);
    const double alpha = parameters.regularization;
    parameters.regularization = 17.0f;  // ignored where a per-triangle α is given
    auto map = std::vector<double>(triangle_count, alpha);
    const auto uniform = run_filter<double>(s.cloth, s.velocities, parameters, Matrix::consistent, map);
    CHECK(same_bits(uniform.velocities, scalar.velocities));

    std::fill(map.begin() + static_cast<std::ptrdiff_t>(triangle_count / 2), map.end(), 10.0);
    const auto mixed = run_filter<double>(s.cloth, s.velocities, parameters, Matrix::consistent, map);
    const auto now = areas<double>(*s.cloth.topology, positions_after(s.cloth, mixed.velocities, parameters.time_step));
    double stiff = 0.0;
    double soft = 0.0;
    for (std::size_t a = 0; a < triangle_count; ++a)
        (a < triangle_count / 2 ? stiff : soft) += std::abs(now[a] / s.cloth.rest_areas[a] - 1.0);
    CHECK(stiff < 0.5 * soft);
}

TEST_CASE("the same input gives the same bytes, also from a limiter that was used and moved") {
    const Stretched s;
    const auto once = run_filter<double>(s.cloth, s.velocities, Parameters{});
    reference::StrainLimiter used(s.cloth.topology);
    auto velocities = s.velocities;
    used.enqueue({s.cloth.positions, velocities, s.cloth.inverse_masses, s.cloth.rest_areas, {}}, {.sub_steps = 3});
    reference::StrainLimiter moved = std::move(used);
    velocities = s.velocities;
    moved.enqueue({s.cloth.positions, velocities, s.cloth.inverse_masses, s.cloth.rest_areas, {}}, {});
    CHECK(same_bits(velocities, once.velocities));
    CHECK(moved.read_stats().iterations == once.stats.iterations);
    CHECK(moved.scratch_bytes() > BasicStrainLimiter<float>(s.cloth.topology).scratch_bytes());
}

TEST_CASE("in 32-bit floats the areas come out as in double") {
    const Stretched s;
    Parameters parameters;
    const auto in_double = run_filter<double>(s.cloth, s.velocities, parameters);
    const auto in_float = run_filter<float>(s.cloth, s.velocities, parameters);
    CHECK(in_float.stats.status == Status::ok);
    const auto expected =
        areas<double>(*s.cloth.topology, positions_after(s.cloth, in_double.velocities, parameters.time_step));
    const auto got =
        areas<double>(*s.cloth.topology, positions_after(s.cloth, in_float.velocities, parameters.time_step));
    double worst = 0.0;
    for (std::size_t a = 0; a < got.size(); ++a)
        worst = std::max(worst, std::abs(got[a] - expected[a]) / s.cloth.rest_areas[a]);
    CHECK(worst < 0.002);
}

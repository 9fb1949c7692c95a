// SPDX-License-Identifier: MIT
#include "reference/displacements.hpp"

#include "reference/conjugate_gradient.hpp"
#include "unit/reference/sample_cloths.hpp"

#include <apsl/reference.hpp>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

using namespace apsl;
using namespace apsl::reference;

namespace {

std::vector<double> displacements_of(const test::SampleCloth& cloth, const std::vector<double>& lambda) {
    std::vector<double> result;
    const auto geometry = cloth.geometry();
    displacements<double>(*cloth.topology, geometry, cloth.inverse_masses, lambda, result);
    return result;
}

/// Pressures that push some triangles and pull others, kg, small enough that no displacement exceeds a few mm.
std::vector<double> some_pressures(std::size_t count) {
    std::mt19937 random(3);
    std::vector<double> lambda(count);
    for (double& value : lambda) value = 1e-3 * (static_cast<double>(random()) / 2147483648.0 - 1.0);
    return lambda;
}

}  // namespace

TEST_CASE("displacements of one right triangle, by hand") {
    const test::Mesh mesh = test::right_triangle();
    const test::SampleCloth cloth{"", Topology::build(mesh.triangles, 3), mesh.positions, {1, 0, 4}, {1}};
    // −w λ g with λ = 0.5 and g = (-1, -2, 0), (1, 0, 0), (0, 2, 0); the second vertex is pinned.
    CHECK(displacements_of(cloth, {0.5}) == std::vector<double>{0.5, 1, 0, 0, 0, 0, 0, -4, 0});
}

TEST_CASE("G is what the update (6) does to the areas, by finite differences") {
    for (const auto& cloth : test::wavy_cloths()) {
        INFO(cloth.name);
        const auto triangle_count = cloth.topology->triangle_count();
        const auto lambda = some_pressures(triangle_count);
        const auto move = displacements_of(cloth, lambda);
        const auto areas_after = [&](double share) {
            std::vector<double> positions = cloth.positions;
            for (std::size_t n = 0; n < positions.size(); ++n) positions[n] += share * move[n];
            return areas<double>(*cloth.topology, positions);
        };
        constexpr double h = 1e-4;
        const auto more = areas_after(h);
        const auto less = areas_after(-h);

        const auto G =
            pressure_matrix<double>(Matrix::consistent, *cloth.topology, cloth.geometry(), cloth.inverse_masses);
        const TriangleVector<double> predicted =
            -(G * Eigen::Map<const TriangleVector<double>>(lambda.data(), static_cast<Eigen::Index>(triangle_count)));
        const double size = predicted.cwiseAbs().maxCoeff();
        REQUIRE(size > 0.0);
        for (std::size_t a = 0; a < triangle_count; ++a) {
            INFO("triangle " << a);
            CHECK((more[a] - less[a]) / (2 * h) == Approx(predicted[a]).margin(1e-6 * size));
        }
    }
}

TEST_CASE("pressures change neither momentum nor angular momentum of a free cloth") {
    auto cloth = test::grid_cloth(6, 7, test::Diagonals::random);
    cloth.positions = test::wavy(cloth.positions, 0.1);
    const auto move = displacements_of(cloth, some_pressures(cloth.topology->triangle_count()));
    Vector3<double> momentum = Vector3<double>::Zero();
    Vector3<double> angular = Vector3<double>::Zero();
    double sum_of_sizes = 0.0;
    for (std::size_t v = 0; v < cloth.topology->vertex_count(); ++v) {
        const Vector3<double> impulse = position<double>(move, v) / cloth.inverse_masses[v];
        momentum += impulse;
        angular += position<double>(cloth.positions, v).cross(impulse);
        sum_of_sizes += impulse.norm();
    }
    REQUIRE(sum_of_sizes > 0.0);
    CHECK(momentum.norm() <= 1e-14 * sum_of_sizes);
    CHECK(angular.norm() <= 1e-14 * sum_of_sizes);
}

// SPDX-License-Identifier: MIT
//
// Thomaszewski, Pabst, Straßer 2009, "Continuum-based Strain Limiting".
//
// The source's: strain is measured and limited per triangle from the deformation gradient instead of per edge, each
// triangle by itself, the triangles combined by iteration, and a triangle's correction keeps linear and angular
// momentum.
//
// Ours: limited are the principal stretches σ of F = U Σ Vᵀ (3 × 2, from the eigenvalues of FᵀF, closed form), each
// clamped to [1 − s, 1 + s], where the source limits the components of the co-rotated strain along warp, weft and in
// shear. The limited triangle F' = U Σ' Vᵀ is laid onto the moved one so that Σ m |Δx|² is least over its translations
// and its rotations about U's normal, which is what keeps both momenta:
//     Δx_v = c + R y_v − x_v,  y_v = F' (X_v − X_c),  R's angle = atan2(Σ m (y × r)·n, Σ m y·r),  r_v = x_v − c,
// with c the centre of mass. One pinned corner: c is that corner. Two: c is their middle, R follows them alone.
// Triangles take turns in colours (Gauss–Seidel). A stretch below 10⁻³ has lost its direction and is left to the rest.

#include "methods/all_methods.hpp"

#include "methods/color_sweeps.hpp"
#include "methods/framed_triangle.hpp"
#include "methods/parameter_values.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace apsl::methods {

namespace {

using Eigen::Matrix2f;
using Eigen::Vector2f;
using Eigen::Vector3f;

/// F V and V: columns of `directions` are σ₁ u₁ and σ₂ u₂, orthogonal, σ₁ ≥ σ₂.
struct Principal {
    Eigen::Matrix<float, 3, 2> directions;
    Matrix2f right;
};

/// One Jacobi rotation diagonalises FᵀF exactly.
Principal principal(const Eigen::Matrix<float, 3, 2>& gradient) {
    const float a = gradient.col(0).squaredNorm();
    const float b = gradient.col(0).dot(gradient.col(1));
    const float d = gradient.col(1).squaredNorm();
    const float angle = 0.5f * std::atan2(2.0f * b, a - d);
    const float cosine = std::cos(angle);
    const float sine = std::sin(angle);
    Principal result;
    result.right << cosine, -sine, sine, cosine;
    result.directions = gradient * result.right;
    return result;
}

/// How much each corner says about where the limited triangle lies (sums to 1) and how it is turned.
struct Weights {
    std::array<float, 3> place{};
    std::array<float, 3> turn{};
};

Weights fit_weights(const std::array<float, 3>& inverse_masses) {
    Weights weights;
    int pinned = 0;
    for (const float w : inverse_masses) pinned += w == 0.0f ? 1 : 0;
    float sum = 0.0f;
    for (int c = 0; c < 3; ++c) {
        const bool is_pinned = inverse_masses[c] == 0.0f;
        const float mass = is_pinned ? 0.0f : 1.0f / inverse_masses[c];
        weights.place[c] = pinned > 0 ? (is_pinned ? 1.0f : 0.0f) : mass;
        weights.turn[c] = pinned > 1 ? weights.place[c] : mass;
        sum += weights.place[c];
    }
    for (float& weight : weights.place) weight /= sum;
    return weights;
}

/// Brings the principal stretches into [1 − limit, 1 + limit].
void limit_triangle(const FramedTriangle& triangle, float limit, std::span<Vector3f> positions) {
    const auto& [i, j, k] = triangle.vertices;
    Eigen::Matrix<float, 3, 2> edges;
    edges << positions[j] - positions[i], positions[k] - positions[i];
    const Principal stretched = principal(edges * triangle.inverse);
    Vector2f stretches;
    Vector2f limited;
    for (int a = 0; a < 2; ++a) {
        stretches[a] = stretched.directions.col(a).norm();
        limited[a] = stretches[a] > 1e-3f ? std::clamp(stretches[a], 1.0f - limit, 1.0f + limit) : stretches[a];
    }
    if (limited == stretches) return;

    // The fit, in coordinates along u₁ and u₂ about c.
    const Weights weights = fit_weights(triangle.inverse_masses);
    const std::array<Vector2f, 3> rest{Vector2f::Zero(), triangle.edges.col(0), triangle.edges.col(1)};
    const Vector2f rest_centre = weights.place[1] * rest[1] + weights.place[2] * rest[2];
    const Vector3f centre = positions[i] + weights.place[1] * edges.col(0) + weights.place[2] * edges.col(1);
    std::array<Vector2f, 3> wanted;
    float cosine = 0.0f;
    float sine = 0.0f;
    for (int c = 0; c < 3; ++c) {
        const Vector2f material = stretched.right.transpose() * (rest[c] - rest_centre);
        const Vector2f now = stretches.cwiseProduct(material);
        wanted[c] = limited.cwiseProduct(material);
        cosine += weights.turn[c] * wanted[c].dot(now);
        sine += weights.turn[c] * (wanted[c][0] * now[1] - wanted[c][1] * now[0]);
    }
    const float length = std::hypot(cosine, sine);
    const Vector2f turn = length > 0.0f ? Vector2f(cosine / length, sine / length) : Vector2f(1.0f, 0.0f);
    const Vector3f u1 = stretched.directions.col(0).normalized();
    const Vector3f u2 = stretched.directions.col(1).normalized();
    for (int c = 0; c < 3; ++c)
        if (triangle.inverse_masses[c] > 0.0f)
            positions[triangle.vertices[c]] = centre + (turn[0] * wanted[c][0] - turn[1] * wanted[c][1]) * u1 +
                                              (turn[1] * wanted[c][0] + turn[0] * wanted[c][1]) * u2;
}

class ContinuumStrainLimiting : public Method {
public:
    ContinuumStrainLimiting(const Cloth& cloth, int iterations, double limit)
        : triangles_(framed_triangles(cloth)), iterations_(iterations), limit_(static_cast<float>(limit)) {
        coloring_ = sort_by_color(triangles_, cloth.topology->vertex_count(), &FramedTriangle::vertices);
    }

    void project(std::span<Vector3f> positions) override {
        sweep_colors(triangles_, coloring_, iterations_,
                     [&](const FramedTriangle& triangle) { limit_triangle(triangle, limit_, positions); });
    }

private:
    std::vector<FramedTriangle> triangles_;
    Coloring coloring_;
    int iterations_;
    float limit_;
};

std::unique_ptr<Method> make_continuum_strain_limiting(const Cloth& cloth, std::span<const double> values) {
    const int iterations = whole_number("iterations", values[0]);
    require_between("limit", values[1], 0.0, 1.0);
    return std::make_unique<ContinuumStrainLimiting>(cloth, iterations, values[1]);
}

}  // namespace

MethodInfo continuum_strain_limiting_info() {
    return {.name = "continuum_strain_limiting",
            .title = "Continuum-based strain limiting",
            .citation = "Thomaszewski et al. 2009",
            .parameters = {iterations_parameter(20), {"limit", 0.01, 0.0, {0.01, 0.0}}},
            .make = make_continuum_strain_limiting};
}

}  // namespace apsl::methods

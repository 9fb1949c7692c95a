// SPDX-License-Identifier: MIT
//
// Müller, Chentanez, Kim, Macklin 2014, "Strain Based Dynamics". Position based constraints on a triangle's deformation
// gradient F = [p₁ p₂] Q⁻¹ = [f₁ f₂] with edges p₁ = x_j − x_i, p₂ = x_k − x_i, and on its area, each solved by
//     Δx_v = −w_v ∇_v C · C / Σ_u w_u |∇_u C|².
// With c_a the columns of Q⁻¹ (f_a = [p₁ p₂] c_a) and S = FᵀF:
//     stretch  C = √S_aa − 1, a = 1, 2       [∇_p₁ ∇_p₂] C = (f_a / |f_a|) c_aᵀ
//     shear    C = S₁₂ / (|f₁| |f₂|)         [∇_p₁ ∇_p₂] C = (f̂₂ − C f̂₁) c₁ᵀ / |f₁| + (f̂₁ − C f̂₂) c₂ᵀ / |f₂|
//     area     C = |p₁ × p₂|² − |q₁ × q₂|²   ∇_p₁ C = 2 p₂ × (p₁ × p₂), ∇_p₂ C = 2 (p₁ × p₂) × p₁
// and ∇_i C = −∇_p₁ C − ∇_p₂ C. Stretch with the root and shear with normalised columns are the source's own form,
// which keeps stretch and shear apart. All stiffnesses are 1.
//
// Ours: the warp axis (framed_triangle.hpp); triangles in colours instead of in mesh order; and, as the gradients of
// area and shear vanish where a triangle has no area and where f₁ and f₂ are parallel, so that steps would grow without
// bound, denominators stay what they are at a third of the rest area and at sin(f₁, f₂) = 1/3.

#include "methods/all_methods.hpp"

#include "methods/area_constraints.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/framed_triangle.hpp"
#include "methods/parameter_values.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace apsl::methods {

namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// The three corners while a triangle is being solved.
struct Corners {
    std::array<Vector3f, 3> positions;
    std::array<float, 3> inverse_masses;

    Vector3f first_edge() const { return positions[1] - positions[0]; }
    Vector3f second_edge() const { return positions[2] - positions[0]; }

    /// Moves by −w ∇C · C / Σ w |∇C|²; nothing where no corner can lessen C. gradient_share: squared, how much is left
    /// of the gradient that C has near rest. Below a third of it the denominator stays what it is there.
    void solve(float constraint, const Vector3f& first_gradient, const Vector3f& second_gradient,
               float gradient_share = 1.0f) {
        const std::array<Vector3f, 3> gradients{-first_gradient - second_gradient, first_gradient, second_gradient};
        float denominator = 0.0f;
        for (int c = 0; c < 3; ++c) denominator += inverse_masses[c] * gradients[c].squaredNorm();
        denominator *= std::max(1.0f, 1.0f / (9.0f * gradient_share));
        if (!(denominator > 0.0f) || !std::isfinite(denominator)) return;
        for (int c = 0; c < 3; ++c) positions[c] -= (inverse_masses[c] * constraint / denominator) * gradients[c];
    }
};

void solve_stretch(Corners& corners, const Vector2f& column) {
    const Vector3f f = column[0] * corners.first_edge() + column[1] * corners.second_edge();
    const float length = f.norm();
    if (!(length > 0.0f)) return;
    const Vector3f direction = f / length;
    corners.solve(length - 1.0f, column[0] * direction, column[1] * direction);
}

void solve_shear(Corners& corners, const Eigen::Matrix2f& inverse) {
    const Vector3f first_edge = corners.first_edge();
    const Vector3f second_edge = corners.second_edge();
    const Vector3f first = inverse(0, 0) * first_edge + inverse(1, 0) * second_edge;
    const Vector3f second = inverse(0, 1) * first_edge + inverse(1, 1) * second_edge;
    const float first_length = first.norm();
    const float second_length = second.norm();
    if (!(first_length > 0.0f) || !(second_length > 0.0f)) return;
    const Vector3f first_direction = first / first_length;
    const Vector3f second_direction = second / second_length;
    const float cosine = first_direction.dot(second_direction);
    const Vector3f by_first = (second_direction - cosine * first_direction) / first_length;
    const Vector3f by_second = (first_direction - cosine * second_direction) / second_length;
    corners.solve(cosine, inverse(0, 0) * by_first + inverse(0, 1) * by_second,
                  inverse(1, 0) * by_first + inverse(1, 1) * by_second, 1.0f - cosine * cosine);
}

/// Divided by the constant |q₁ × q₂|², which leaves the motion as it is and 32-bit floats in range.
void solve_area(Corners& corners, float doubled_rest_area) {
    const Vector3f first_edge = corners.first_edge();
    const Vector3f second_edge = corners.second_edge();
    const Vector3f normal = first_edge.cross(second_edge) / doubled_rest_area;
    const float squared_ratio = normal.squaredNorm();
    const Vector3f first_gradient = 2.0f * second_edge.cross(normal) / doubled_rest_area;
    const Vector3f second_gradient = 2.0f * normal.cross(first_edge) / doubled_rest_area;
    corners.solve(squared_ratio - 1.0f, first_gradient, second_gradient, squared_ratio);
}

/// Coloured Gauss–Seidel; `solve(corners, constraint)` is one triangle's turn.
template <class Constraint, class Solve>
void sweep(std::vector<Constraint>& constraints, const Coloring& coloring, int iterations,
           std::span<Vector3f> positions, const Solve& solve) {
    sweep_colors(constraints, coloring, iterations, [&](const Constraint& constraint) {
        Corners corners;
        corners.inverse_masses = constraint.inverse_masses;
        for (int c = 0; c < 3; ++c) corners.positions[c] = positions[constraint.vertices[c]];
        solve(corners, constraint);
        for (int c = 0; c < 3; ++c)
            if (corners.inverse_masses[c] > 0.0f) positions[constraint.vertices[c]] = corners.positions[c];
    });
}

class Strain : public Method {
public:
    Strain(const Cloth& cloth, int iterations)
        : triangles_(framed_triangles(cloth)),
          coloring_(sort_by_color(triangles_, cloth.topology->vertex_count(), &FramedTriangle::vertices)),
          iterations_(iterations) {}

    void project(std::span<Vector3f> positions) override {
        sweep(triangles_, coloring_, iterations_, positions, [](Corners& corners, const FramedTriangle& triangle) {
            solve_stretch(corners, triangle.inverse.col(0));
            solve_stretch(corners, triangle.inverse.col(1));
            solve_shear(corners, triangle.inverse);
        });
    }

private:
    std::vector<FramedTriangle> triangles_;
    Coloring coloring_;
    int iterations_;
};

class Area : public Method {
public:
    Area(const Cloth& cloth, int iterations)
        : constraints_(area_constraints(cloth)),
          coloring_(sort_by_color(constraints_, cloth.topology->vertex_count(), &AreaConstraint::vertices)),
          iterations_(iterations) {}

    void project(std::span<Vector3f> positions) override {
        sweep(constraints_, coloring_, iterations_, positions, [](Corners& corners, const AreaConstraint& constraint) {
            if (constraint.rest_area > 0.0f) solve_area(corners, 2.0f * constraint.rest_area);
        });
    }

private:
    std::vector<AreaConstraint> constraints_;
    Coloring coloring_;
    int iterations_;
};

constexpr const char* source = "Müller et al. 2014";

std::unique_ptr<Method> make_strain_based_dynamics_strain(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<Strain>(cloth, whole_number("iterations", values[0]));
}

std::unique_ptr<Method> make_strain_based_dynamics_area(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<Area>(cloth, whole_number("iterations", values[0]));
}

}  // namespace

MethodInfo strain_based_dynamics_strain_info() {
    return {.name = "strain_based_dynamics_strain",
            .title = "Strain based dynamics, strain",
            .citation = source,
            .parameters = {iterations_parameter(20)},
            .make = make_strain_based_dynamics_strain};
}

MethodInfo strain_based_dynamics_area_info() {
    return {.name = "strain_based_dynamics_area",
            .title = "Strain based dynamics, area",
            .citation = source,
            .parameters = {iterations_parameter(20)},
            .make = make_strain_based_dynamics_area};
}

}  // namespace apsl::methods

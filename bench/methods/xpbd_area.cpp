// SPDX-License-Identifier: MIT
//
// Extended position-based dynamics with an area constraint on every triangle, of energy ½ C²/α.
//
//     C = A − A⁰,  ∇_i C = ½ n × e_i,  α̃ = α / Δt²
//     Δλ = (−C − α̃ λ) / (Σ_j w_j |∇_j C|² + α̃),  Δx_i = w_i Δλ ∇_i C,  λ = 0 at each call
//
// Gauss–Seidel, color by color so that the triangles of a color run in parallel. With α = 0 this is pbd_area_colored.
//
// M. Macklin, M. Müller, N. Chentanez: XPBD: position-based simulation of compliant constrained dynamics. Motion in
// Games 2016: Eq. (17), (18) and Algorithm 1.
#include "methods/all_methods.hpp"

#include "methods/area_constraints.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/parameter_values.hpp"

namespace apsl::methods {
namespace {

struct Compliant {
    AreaConstraint triangle;
    float multiplier;  // kg, λ
};

class XpbdArea : public Method {
public:
    XpbdArea(const Cloth& cloth, int iterations, double compliance)
        : iterations_(iterations), compliance_(static_cast<float>(compliance / (cloth.time_step * cloth.time_step))) {
        for (const AreaConstraint& triangle : area_constraints(cloth)) constraints_.push_back({triangle, 0.0f});
        coloring_ = sort_by_color(constraints_, cloth.topology->vertex_count(),
                                  [](const Compliant& constraint) -> auto& { return constraint.triangle.vertices; });
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        for (Compliant& constraint : constraints_) constraint.multiplier = 0.0f;
        sweep_colors(constraints_, coloring_, iterations_, [&](Compliant& constraint) {
            const AreaConstraint& triangle = constraint.triangle;
            const TriangleArea now = triangle.at(positions);
            const float weight = triangle.weight(now);
            if (!(weight > 0.0f)) return;  // no direction to push in
            const float change =
                (triangle.rest_area - now.area - compliance_ * constraint.multiplier) / (weight + compliance_);
            constraint.multiplier += change;
            triangle.move(now, change, positions);
        });
    }

private:
    std::vector<Compliant> constraints_;
    Coloring coloring_;
    int iterations_;
    float compliance_;  // m²/kg, α̃
};

std::unique_ptr<Method> make_xpbd_area(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<XpbdArea>(cloth, whole_number("iterations", values[0]), values[1]);
}

}  // namespace

MethodInfo xpbd_area_info() {
    return {.name = "xpbd_area",
            .title = "XPBD areas",
            .citation = "Macklin et al. 2016",
            .parameters = {iterations_parameter(20), {"compliance", 0.0, 0.0, {1e-6, 0.0}}},
            .make = make_xpbd_area};
}

}  // namespace apsl::methods

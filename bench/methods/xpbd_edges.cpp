// SPDX-License-Identifier: MIT
//
// Extended position-based dynamics with a distance constraint on every edge, of energy ½ C²/α.
//
//     C = |x_b − x_a| − L,  d = (x_b − x_a) / |x_b − x_a|,  α̃ = α / Δt²
//     Δλ = (−C − α̃ λ) / (w_a + w_b + α̃),  Δx_a = −w_a Δλ d,  Δx_b = +w_b Δλ d,  λ = 0 at each call
//
// Gauss–Seidel, color by color so that the edges of a color run in parallel. With α = 0 this is pbd_edges at full
// stiffness.
//
// M. Macklin, M. Müller, N. Chentanez: XPBD: position-based simulation of compliant constrained dynamics. Motion in
// Games 2016: Eq. (17), (18) and Algorithm 1.
#include "methods/all_methods.hpp"

#include "methods/color_sweeps.hpp"
#include "methods/edge_constraints.hpp"
#include "methods/parameter_values.hpp"

namespace apsl::methods {
namespace {

struct Compliant {
    EdgeConstraint edge;
    float multiplier;  // kg·m, λ
};

class XpbdEdges : public Method {
public:
    XpbdEdges(const Cloth& cloth, int iterations, double compliance)
        : iterations_(iterations), compliance_(static_cast<float>(compliance / (cloth.time_step * cloth.time_step))) {
        for (const EdgeConstraint& edge : edge_constraints(cloth)) constraints_.push_back({edge, 0.0f});
        coloring_ = sort_by_color(constraints_, cloth.topology->vertex_count(),
                                  [](const Compliant& constraint) -> auto& { return constraint.edge.vertices; });
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        for (Compliant& constraint : constraints_) constraint.multiplier = 0.0f;
        sweep_colors(constraints_, coloring_, iterations_, [&](Compliant& constraint) {
            const EdgeConstraint& edge = constraint.edge;
            const auto [a, b] = edge.vertices;
            const auto [wa, wb] = edge.inverse_masses;
            const Eigen::Vector3f along = positions[b] - positions[a];
            const float length = along.norm();
            if (!(length > 0.0f)) return;  // no direction to push in
            const float change =
                (edge.rest_length - length - compliance_ * constraint.multiplier) / (wa + wb + compliance_);
            constraint.multiplier += change;
            edge.pull(-change / length * along, positions);
        });
    }

private:
    std::vector<Compliant> constraints_;
    Coloring coloring_;
    int iterations_;
    float compliance_;  // 1/kg, α̃
};

std::unique_ptr<Method> make_xpbd_edges(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<XpbdEdges>(cloth, whole_number("iterations", values[0]), values[1]);
}

}  // namespace

MethodInfo xpbd_edges_info() {
    return {.name = "xpbd_edges",
            .title = "XPBD edges",
            .citation = "Macklin et al. 2016",
            .parameters = {iterations_parameter(20), {"compliance", 0.0, 0.0, {1e-6, 0.0}}},
            .make = make_xpbd_edges};
}

}  // namespace apsl::methods

// SPDX-License-Identifier: MIT
//
// Position-based dynamics with a distance constraint on every edge.
//
//     C = |x_b − x_a| − L,  d = (x_b − x_a) / |x_b − x_a|
//     Δx_a = +k' w_a / (w_a + w_b) C d,  Δx_b = −k' w_b / (w_a + w_b) C d,  k' = 1 − (1 − k)^(1/iterations)
//
// Gauss–Seidel, here color by color so that the edges of a color run in parallel.
//
// M. Müller, B. Heidelberger, M. Hennix, J. Ratcliff: Position based dynamics. Journal of Visual Communication and
// Image Representation 18(2), 2007: Section 3.3.
#include "methods/all_methods.hpp"

#include "methods/color_sweeps.hpp"
#include "methods/edge_constraints.hpp"
#include "methods/parameter_values.hpp"

#include <cmath>

namespace apsl::methods {
namespace {

class PbdEdges : public Method {
public:
    PbdEdges(const Cloth& cloth, int iterations, double stiffness)
        : constraints_(edge_constraints(cloth)),
          iterations_(iterations),
          stiffness_(static_cast<float>(1.0 - std::pow(1.0 - stiffness, 1.0 / iterations))) {
        coloring_ = sort_by_color(constraints_, cloth.topology->vertex_count(), &EdgeConstraint::vertices);
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        sweep_colors(constraints_, coloring_, iterations_, [&](const EdgeConstraint& edge) {
            const auto [a, b] = edge.vertices;
            const auto [wa, wb] = edge.inverse_masses;
            const Eigen::Vector3f along = positions[b] - positions[a];
            const float length = along.norm();
            if (!(length > 0.0f)) return;  // no direction to push in
            edge.pull(stiffness_ * (length - edge.rest_length) / (length * (wa + wb)) * along, positions);
        });
    }

private:
    std::vector<EdgeConstraint> constraints_;
    Coloring coloring_;
    int iterations_;
    float stiffness_;
};

std::unique_ptr<Method> make_pbd_edges(const Cloth& cloth, std::span<const double> values) {
    const int iterations = whole_number("iterations", values[0]);
    require_between("stiffness", values[1], 0.0, 1.0);
    return std::make_unique<PbdEdges>(cloth, iterations, values[1]);
}

}  // namespace

MethodInfo pbd_edges_info() {
    return {.name = "pbd_edges",
            .title = "PBD edges",
            .citation = "Müller et al. 2007",
            .parameters = {iterations_parameter(20), {"stiffness", 1.0, 0.0, {1.0}}},
            .make = make_pbd_edges};
}

}  // namespace apsl::methods

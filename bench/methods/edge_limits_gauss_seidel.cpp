// SPDX-License-Identifier: MIT
//
// Strain limits on edges: those shorter than (1 − s) L or longer than (1 + s) L are brought back to that bound by
// opposite impulses at their ends, here as what they add to the predicted positions.
//
//     d = (x_b − x_a) / |x_b − x_a|,  C = |x_b − x_a| − clamp(|x_b − x_a|, (1 − s) L, (1 + s) L)
//     Δx_a = +w_a / (w_a + w_b) C d,  Δx_b = −w_b / (w_a + w_b) C d
//
// Gauss–Seidel, color by color so that the edges of a color run in parallel.
//
// X. Provot: Deformation constraints in a mass-spring model to describe rigid cloth behavior. Graphics Interface 1995.
// R. Bridson, S. Marino, R. Fedkiw: Simulation of clothing with folds and wrinkles. Symposium on Computer Animation
// 2003.
#include "methods/all_methods.hpp"

#include "methods/color_sweeps.hpp"
#include "methods/edge_constraints.hpp"
#include "methods/parameter_values.hpp"

#include <algorithm>

namespace apsl::methods {
namespace {

class EdgeLimitsGaussSeidel : public Method {
public:
    EdgeLimitsGaussSeidel(const Cloth& cloth, int iterations, double limit)
        : constraints_(edge_constraints(cloth)),
          iterations_(iterations),
          least_(static_cast<float>(1.0 - limit)),
          greatest_(static_cast<float>(1.0 + limit)) {
        coloring_ = sort_by_color(constraints_, cloth.topology->vertex_count(), &EdgeConstraint::vertices);
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        sweep_colors(constraints_, coloring_, iterations_, [&](const EdgeConstraint& edge) {
            const auto [a, b] = edge.vertices;
            const auto [wa, wb] = edge.inverse_masses;
            const Eigen::Vector3f along = positions[b] - positions[a];
            const float length = along.norm();
            const float excess = length - std::clamp(length, least_ * edge.rest_length, greatest_ * edge.rest_length);
            if (excess == 0.0f || !(length > 0.0f)) return;
            edge.pull(excess / (length * (wa + wb)) * along, positions);
        });
    }

private:
    std::vector<EdgeConstraint> constraints_;
    Coloring coloring_;
    int iterations_;
    float least_, greatest_;  // of the rest length
};

std::unique_ptr<Method> make_edge_limits_gauss_seidel(const Cloth& cloth, std::span<const double> values) {
    const int iterations = whole_number("iterations", values[0]);
    require_between("limit", values[1], 0.0, 1.0);
    return std::make_unique<EdgeLimitsGaussSeidel>(cloth, iterations, values[1]);
}

}  // namespace

MethodInfo edge_limits_gauss_seidel_info() {
    return {.name = "edge_limits_gauss_seidel",
            .title = "Edge limits, Gauss–Seidel",
            .citation = "Provot 1995; Bridson et al. 2003",
            .parameters = {iterations_parameter(20), {"limit", 0.1, 0.0, {0.1, 0.01}}},
            .make = make_edge_limits_gauss_seidel};
}

}  // namespace apsl::methods

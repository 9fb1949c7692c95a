// SPDX-License-Identifier: MIT
//
// Strain limits on edges as in edge_limits_gauss_seidel.cpp, all edges at once from the same positions.
//
// Corrections that merely add up overshoot. Each vertex is divided evenly among the n edges at it that are out of their
// limits in this iteration, and its parts' displacements are averaged (Tonge et al. 2012):
//
//     Δx_a = w_a Σ_e C_e d_e / (n_a w_a + n_b w_b)
//
// Where all n are the same this is the average of the corrections; where they are not, it still keeps momentum, which
// an average would not.
//
// X. Provot: Deformation constraints in a mass-spring model to describe rigid cloth behavior. Graphics Interface 1995.
// R. Bridson, S. Marino, R. Fedkiw: Simulation of clothing with folds and wrinkles. Symposium on Computer Animation
// 2003.
// R. Tonge, F. Benevolenski, A. Voroshilov: Mass splitting for jitter-free parallel rigid body simulation. ACM
// Transactions on Graphics 31(4), 2012.
#include "methods/all_methods.hpp"

#include "methods/color_sweeps.hpp"
#include "methods/edge_constraints.hpp"
#include "methods/parameter_values.hpp"

#include <algorithm>

namespace apsl::methods {
namespace {

class EdgeLimitsJacobi : public Method {
public:
    EdgeLimitsJacobi(const Cloth& cloth, int iterations, double limit)
        : constraints_(edge_constraints(cloth)),
          excesses_(constraints_.size()),
          edge_offsets_(cloth.topology->vertex_count() + 1, 0),
          edges_(2 * constraints_.size()),
          inverse_masses_(cloth.topology->vertex_count()),
          parts_(cloth.topology->vertex_count()),
          iterations_(iterations),
          least_(static_cast<float>(1.0 - limit)),
          greatest_(static_cast<float>(1.0 + limit)) {
        for (std::size_t v = 0; v < inverse_masses_.size(); ++v)
            inverse_masses_[v] = static_cast<float>(cloth.inverse_masses[v]);
        for (const EdgeConstraint& edge : constraints_)
            for (const std::uint32_t v : edge.vertices) ++edge_offsets_[v + 1];
        for (std::size_t v = 1; v < edge_offsets_.size(); ++v) edge_offsets_[v] += edge_offsets_[v - 1];
        std::vector<std::uint32_t> next(edge_offsets_.begin(), edge_offsets_.end() - 1);
        for (std::uint32_t e = 0; e < constraints_.size(); ++e)
            for (const std::uint32_t v : constraints_[e].vertices) edges_[next[v]++] = e;
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        const std::size_t edge_count = constraints_.size();
        const std::size_t vertex_count = inverse_masses_.size();
#pragma omp parallel if (edge_count >= least_parallel_count)
        for (int iteration = 0; iteration < iterations_; ++iteration) {
#pragma omp for schedule(static)
            for (std::size_t e = 0; e < edge_count; ++e) excesses_[e] = excess(constraints_[e], positions);
#pragma omp for schedule(static)
            for (std::size_t v = 0; v < vertex_count; ++v) parts_[v] = inverse_masses_[v] * count_at(v);
#pragma omp for schedule(static)
            for (std::size_t v = 0; v < vertex_count; ++v)
                if (parts_[v] > 0.0f) positions[v] += inverse_masses_[v] * impulse(v);
        }
    }

private:
    struct Excess {
        Eigen::Vector3f vector;  // m, C d
        bool active;
    };

    Excess excess(const EdgeConstraint& edge, std::span<const Eigen::Vector3f> positions) const {
        const Eigen::Vector3f along = positions[edge.vertices[1]] - positions[edge.vertices[0]];
        const float length = along.norm();
        const float difference = length - std::clamp(length, least_ * edge.rest_length, greatest_ * edge.rest_length);
        if (difference == 0.0f || !(length > 0.0f)) return {Eigen::Vector3f::Zero(), false};
        return {difference / length * along, true};
    }

    float count_at(std::size_t v) const {
        int count = 0;
        for (std::uint32_t i = edge_offsets_[v]; i < edge_offsets_[v + 1]; ++i) count += excesses_[edges_[i]].active;
        return static_cast<float>(count);
    }

    Eigen::Vector3f impulse(std::size_t v) const {
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (std::uint32_t i = edge_offsets_[v]; i < edge_offsets_[v + 1]; ++i) {
            const Excess& excess = excesses_[edges_[i]];
            if (!excess.active) continue;
            const auto [a, b] = constraints_[edges_[i]].vertices;
            const float sign = a == v ? 1.0f : -1.0f;
            sum += sign / (parts_[a] + parts_[b]) * excess.vector;
        }
        return sum;
    }

    std::vector<EdgeConstraint> constraints_;
    std::vector<Excess> excesses_;             // [edges]
    std::vector<std::uint32_t> edge_offsets_;  // [V + 1]
    std::vector<std::uint32_t> edges_;         // at each vertex, ascending
    std::vector<float> inverse_masses_;        // 1/kg, [V]
    std::vector<float> parts_;                 // 1/kg, [V], n w: inverse mass of one part of a vertex
    int iterations_;
    float least_, greatest_;  // of the rest length
};

std::unique_ptr<Method> make_edge_limits_jacobi(const Cloth& cloth, std::span<const double> values) {
    const int iterations = whole_number("iterations", values[0]);
    require_between("limit", values[1], 0.0, 1.0);
    return std::make_unique<EdgeLimitsJacobi>(cloth, iterations, values[1]);
}

}  // namespace

MethodInfo edge_limits_jacobi_info() {
    return {.name = "edge_limits_jacobi",
            .title = "Edge limits, Jacobi",
            .citation = "Provot 1995; Bridson et al. 2003",
            .parameters = {iterations_parameter(20), {"limit", 0.1, 0.0, {0.1, 0.01}}},
            .make = make_edge_limits_jacobi};
}

}  // namespace apsl::methods

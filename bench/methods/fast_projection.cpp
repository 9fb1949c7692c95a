// SPDX-License-Identifier: MIT
//
// Goldenthal, Harmon, Fattal, Bercovier, Grinspun 2007, "Efficient Simulation of Inextensible Cloth": fast projection.
// Constraints C_e = (|x_j − x_i|² − L²) / L on edges, all at once, by Newton steps on their linearisation:
//     (∇C M⁻¹ ∇Cᵀ) δλ = C,  Δx = −M⁻¹ ∇Cᵀ δλ
// (their Δt² is taken into δλ), until every edge is within `tolerance` of its length, relative, or `iterations` are
// spent. A sparse direct solver (LDLᵀ in double precision); the pattern is analysed once.
//
// Ours: the diagonal is multiplied by 1 + regularization. A triangle mesh has about as many edges as its vertices have
// coordinates, and on flat cloth, where no edge can act across the plane, a third of them is redundant: the matrix is
// singular there and close to singular nearby. The source avoids that with a quad-dominant mesh, warp and weft edges
// alone; `quads` = 1 does likewise by leaving out an edge wherever two triangles pair up to a quad, longest edges
// first.

#include "methods/all_methods.hpp"

#include "methods/parameter_values.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace apsl::methods {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Matrix = Eigen::SparseMatrix<double>;

struct Edge {
    VertexPair vertices;
    double rest_length;
};

/// Edges left out so that pairs of triangles become quads.
std::vector<bool> quad_diagonals(const Cloth& cloth) {
    const Topology& topology = *cloth.topology;
    const std::span<const VertexPair> edges = topology.edges();
    std::vector<double> lengths;
    for (const auto& [i, j] : edges) lengths.push_back((cloth.rest_positions[j] - cloth.rest_positions[i]).norm());
    std::vector<std::size_t> order(edges.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return lengths[a] > lengths[b]; });
    std::vector<bool> left_out(edges.size());
    std::vector<bool> paired(topology.triangle_count());
    for (const std::size_t edge : order) {
        const std::uint32_t first = topology.edge_corner_offsets()[edge];
        if (topology.edge_corner_offsets()[edge + 1] - first != 2) continue;
        const std::uint32_t one = topology.edge_corners()[first] / 3;
        const std::uint32_t other = topology.edge_corners()[first + 1] / 3;
        if (paired[one] || paired[other]) continue;
        paired[one] = paired[other] = left_out[edge] = true;
    }
    return left_out;
}

std::vector<Edge> constrained_edges(const Cloth& cloth, bool quads) {
    const std::vector<bool> left_out =
        quads ? quad_diagonals(cloth) : std::vector<bool>(cloth.topology->edges().size());
    std::vector<Edge> edges;
    for (std::size_t e = 0; e < left_out.size(); ++e) {
        const VertexPair& vertices = cloth.topology->edges()[e];
        const auto& [i, j] = vertices;
        const double length = (cloth.rest_positions[j] - cloth.rest_positions[i]).norm();
        const bool movable = cloth.inverse_masses[i] + cloth.inverse_masses[j] > 0.0;
        if (!left_out[e] && movable && length > 0.0) edges.push_back({vertices, length});
    }
    return edges;
}

/// Edge numbers at each vertex, ascending: incident[offsets[v]] up to offsets[v + 1].
struct Incidence {
    std::vector<std::uint32_t> offsets;
    std::vector<std::uint32_t> edges;
};

Incidence incidence(const std::vector<Edge>& edges, std::size_t vertex_count) {
    Incidence result;
    result.offsets.assign(vertex_count + 1, 0);
    for (const Edge& edge : edges)
        for (const std::uint32_t vertex : edge.vertices) ++result.offsets[vertex + 1];
    std::partial_sum(result.offsets.begin(), result.offsets.end(), result.offsets.begin());
    result.edges.resize(2 * edges.size());
    std::vector<std::uint32_t> next(result.offsets.begin(), result.offsets.end() - 1);
    for (std::uint32_t e = 0; e < edges.size(); ++e)
        for (const std::uint32_t vertex : edges[e].vertices) result.edges[next[vertex]++] = e;
    return result;
}

/// +1 where the edge ends, −1 where it starts.
double sign(const Edge& edge, std::uint32_t vertex) {
    return edge.vertices[1] == vertex ? 1.0 : -1.0;
}

/// Lower triangle of what ∇C M⁻¹ ∇Cᵀ holds beside the gradients: entry (e, f) is this number times g_e · g_f, where
/// g_e = 2 (x_j − x_i) / L.
Matrix coupling(const std::vector<Edge>& edges, const Incidence& at_vertex, const std::vector<double>& inverse_masses) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::uint32_t vertex = 0; vertex + 1 < at_vertex.offsets.size(); ++vertex)
        for (std::uint32_t p = at_vertex.offsets[vertex]; p < at_vertex.offsets[vertex + 1]; ++p)
            for (std::uint32_t q = at_vertex.offsets[vertex]; q <= p; ++q) {
                const std::uint32_t row = at_vertex.edges[p];
                const std::uint32_t column = at_vertex.edges[q];
                entries.emplace_back(static_cast<int>(row), static_cast<int>(column),
                                     inverse_masses[vertex] * sign(edges[row], vertex) * sign(edges[column], vertex));
            }
    const auto size = static_cast<Eigen::Index>(edges.size());
    Matrix matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    matrix.makeCompressed();
    return matrix;
}

class FastProjection final : public Method {
public:
    FastProjection(const Cloth& cloth, int iterations, double tolerance, double regularization, bool quads)
        : edges_(constrained_edges(cloth, quads)),
          at_vertex_(incidence(edges_, cloth.topology->vertex_count())),
          inverse_masses_(cloth.inverse_masses),
          coupling_(coupling(edges_, at_vertex_, inverse_masses_)),
          matrix_(coupling_),
          gradients_(edges_.size()),
          constraints_(static_cast<Eigen::Index>(edges_.size())),
          iterations_(iterations),
          tolerance_(tolerance),
          regularization_(regularization) {
        if (!edges_.empty()) solver_.analyzePattern(matrix_);
    }

    void project(std::span<Vector3f> positions) override {
        if (edges_.empty()) return;
        for (int iteration = 0; iteration < iterations_; ++iteration) {
            const double greatest_strain = linearize(positions);
            // Also left on numbers that are not finite: a factorisation has nothing to say about them.
            if (!(greatest_strain > tolerance_) || !constraints_.allFinite()) return;
            assemble();
            solver_.factorize(matrix_);
            if (solver_.info() != Eigen::Success) return;
            const Eigen::VectorXd multipliers = solver_.solve(constraints_);
            if (!multipliers.allFinite()) return;
            move(positions, multipliers);
        }
    }

private:
    /// Fills gradients and constraints; returns the greatest | |x_j − x_i| − L | / L.
    double linearize(std::span<const Vector3f> positions) {
        double greatest = 0.0;
        const auto count = static_cast<std::int64_t>(edges_.size());
#pragma omp parallel for schedule(static) reduction(max : greatest)
        for (std::int64_t e = 0; e < count; ++e) {
            const auto& [vertices, rest_length] = edges_[e];
            const Vector3d edge = positions[vertices[1]].cast<double>() - positions[vertices[0]].cast<double>();
            gradients_[e] = (2.0 / rest_length) * edge;
            constraints_[e] = (edge.squaredNorm() - rest_length * rest_length) / rest_length;
            greatest = std::max(greatest, std::abs(edge.norm() - rest_length) / rest_length);
        }
        return greatest;
    }

    void assemble() {
        const auto columns = static_cast<int>(matrix_.cols());
#pragma omp parallel for schedule(static)
        for (int column = 0; column < columns; ++column)
            for (int n = matrix_.outerIndexPtr()[column]; n < matrix_.outerIndexPtr()[column + 1]; ++n) {
                const int row = matrix_.innerIndexPtr()[n];
                double value = coupling_.valuePtr()[n] * gradients_[row].dot(gradients_[column]);
                if (row == column) {
                    value *= 1.0 + regularization_;
                    // An edge shrunk to a point acts on nothing: its row is zero, and its multiplier shall be 0.
                    if (value == 0.0) value = 1.0;
                }
                matrix_.valuePtr()[n] = value;
            }
    }

    void move(std::span<Vector3f> positions, const Eigen::VectorXd& multipliers) const {
        const auto count = static_cast<std::int64_t>(positions.size());
#pragma omp parallel for schedule(static)
        for (std::int64_t v = 0; v < count; ++v) {
            if (inverse_masses_[v] == 0.0) continue;
            Vector3d sum = Vector3d::Zero();
            for (std::uint32_t n = at_vertex_.offsets[v]; n < at_vertex_.offsets[v + 1]; ++n) {
                const std::uint32_t e = at_vertex_.edges[n];
                sum += sign(edges_[e], static_cast<std::uint32_t>(v)) * multipliers[e] * gradients_[e];
            }
            positions[v] = (positions[v].cast<double>() - inverse_masses_[v] * sum).cast<float>();
        }
    }

    std::vector<Edge> edges_;
    Incidence at_vertex_;
    std::vector<double> inverse_masses_;
    Matrix coupling_;
    Matrix matrix_;
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower> solver_;
    std::vector<Vector3d> gradients_;
    Eigen::VectorXd constraints_;
    int iterations_;
    double tolerance_;
    double regularization_;
};

std::unique_ptr<Method> make_fast_projection(const Cloth& cloth, std::span<const double> values) {
    const int iterations = whole_number("iterations", values[0]);
    require_between("quads", values[3], 0.0, 1.0);
    const bool quads = whole_number("quads", values[3]) == 1;
    return std::make_unique<FastProjection>(cloth, iterations, values[1], values[2], quads);
}

}  // namespace

MethodInfo fast_projection_info() {
    return {.name = "fast_projection",
            .title = "Fast projection",
            .citation = "Goldenthal et al. 2007",
            .parameters = {{"iterations", 5.0, 1.0, {1, 2, 3, 5, 10}},
                           {"tolerance", 1e-4, 0.0, {1e-4}},
                           {"regularization", 1e-4, 0.0, {1e-4}},
                           {"quads", 0.0, 0.0, {0}}},
            .make = make_fast_projection};
}

}  // namespace apsl::methods

// SPDX-License-Identifier: MIT
//
// Inextensible cloth without locking: variables on edge midpoints.
//
// J. Bender, R. Diziol, D. Bayer: Simulating inextensible cloth using locking-free triangle meshes. VRIPHYS 2011, on
// the nonconforming elements of E. English, R. Bridson: Animating developable surfaces using nonconforming elements.
// ACM Transactions on Graphics 27(3), 2008.
//
// The sources': particles on edge midpoints, hard distance constraints between the three of each triangle. Triangles
// are then joined at midpoints alone, so that edge lengths do not take away all freedom. The mesh with vertices is
// coupled to it and is what is seen and collides. Bender et al. solve the constraints one by one until they hold, by
// impulses.
//
// Ours, as the methods here are stages without memory, where the sources keep midpoints as the state that is simulated.
// A pass, of which there are `passes`:
//   1. midpoints from the vertices, m_e = (x_a + x_b) / 2;
//   2. `iterations` of coloured Gauss–Seidel on positions: C = |m_f − m_e| − l for the three pairs of each triangle,
//      l half the rest length of the edge between; and C = |m_e − x_v| − L_e / 2 at both edges of each pinned corner v;
//   3. each free vertex moves by the mean over its triangles of Δm_b + Δm_c − Δm_a, weighted by the triangles' masses.
// A midpoint has a third of its triangles' masses; a triangle's mass is its area times the density that its free
// corners' masses tell. With vertex masses lumped the same way, step 3 keeps momentum. Midpoints between pins do not
// move.
#include "methods/all_methods.hpp"

#include "methods/color_sweeps.hpp"
#include "methods/parameter_values.hpp"

#include <array>
#include <cmath>

namespace apsl::methods {
namespace {

using Eigen::Vector3f;

/// Midpoint k lies on the edge opposite corner k.
struct MidpointTriangle {
    std::array<std::uint32_t, 3> midpoints;
    std::array<float, 3> inverse_masses;  // 1/kg, of the midpoints
    std::array<float, 3> rest_lengths;    // m, entry k between the midpoints other than k
    std::array<std::uint32_t, 3> vertices;
    std::array<bool, 3> pinned;  // corners
};

/// A corner's say in where its vertex goes.
struct Corner {
    std::uint32_t opposite, first, second;  // midpoints
    float weight;                           // those of a vertex add up to 1
};

std::vector<std::uint32_t> edge_opposite_corner(const Topology& topology) {
    std::vector<std::uint32_t> edge_of(3 * topology.triangle_count());
    for (std::uint32_t edge = 0; edge < topology.edges().size(); ++edge)
        for (std::uint32_t n = topology.edge_corner_offsets()[edge]; n < topology.edge_corner_offsets()[edge + 1]; ++n)
            edge_of[topology.edge_corners()[n]] = edge;
    return edge_of;
}

/// kg, [T]; 0 for triangles with three pinned corners.
std::vector<double> triangle_masses(const Cloth& cloth) {
    const std::span<const Triangle> triangles = cloth.topology->triangles();
    std::vector<double> lumped_areas(cloth.topology->vertex_count());
    for (std::size_t a = 0; a < triangles.size(); ++a)
        for (const std::uint32_t vertex : triangles[a]) lumped_areas[vertex] += cloth.rest_areas[a] / 3.0;
    std::vector<double> masses;
    for (std::size_t a = 0; a < triangles.size(); ++a) {
        double density = 0.0;
        int free_corners = 0;
        for (const std::uint32_t vertex : triangles[a]) {
            if (!(cloth.inverse_masses[vertex] > 0.0) || !(lumped_areas[vertex] > 0.0)) continue;
            density += 1.0 / (cloth.inverse_masses[vertex] * lumped_areas[vertex]);
            ++free_corners;
        }
        masses.push_back(free_corners == 0 ? 0.0 : cloth.rest_areas[a] * density / free_corners);
    }
    return masses;
}

class NonconformingEdgeMidpoint : public Method {
public:
    NonconformingEdgeMidpoint(const Cloth& cloth, int iterations, int passes)
        : topology_(cloth.topology),
          midpoints_(cloth.topology->edges().size()),
          start_(cloth.topology->edges().size()),
          iterations_(iterations),
          passes_(passes) {
        for (const double w : cloth.inverse_masses) is_free_.push_back(w > 0.0);
        const std::vector<std::uint32_t> edge_of = edge_opposite_corner(*topology_);
        const std::vector<double> masses = triangle_masses(cloth);
        set_triangles(cloth, edge_of, masses);
        set_corners(edge_of, masses);
    }

    void project(std::span<Vector3f> positions) override {
        const std::span<const VertexPair> edges = topology_->edges();
        const auto edge_count = static_cast<std::int64_t>(edges.size());
        for (int pass = 0; pass < passes_; ++pass) {
#pragma omp parallel for schedule(static)
            for (std::int64_t e = 0; e < edge_count; ++e) {
                start_[e] = 0.5f * (positions[edges[e][0]] + positions[edges[e][1]]);
                midpoints_[e] = start_[e];
            }
            sweep_colors(triangles_, coloring_, iterations_,
                         [&](const MidpointTriangle& triangle) { relax(triangle, positions); });
            follow(positions);
        }
    }

private:
    void set_triangles(const Cloth& cloth, const std::vector<std::uint32_t>& edge_of,
                       const std::vector<double>& masses) {
        const std::span<const Triangle> triangles = topology_->triangles();
        std::vector<double> midpoint_masses(topology_->edges().size());
        for (std::size_t corner = 0; corner < edge_of.size(); ++corner)
            midpoint_masses[edge_of[corner]] += masses[corner / 3] / 3.0;
        for (std::size_t a = 0; a < triangles.size(); ++a) {
            MidpointTriangle triangle{};
            triangle.vertices = triangles[a];
            bool movable = false;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t edge = edge_of[3 * a + k];
                const auto& [first, second] = topology_->edges()[edge];
                triangle.midpoints[k] = edge;
                triangle.pinned[k] = !is_free_[triangles[a][k]];
                if ((is_free_[first] || is_free_[second]) && midpoint_masses[edge] > 0.0)
                    triangle.inverse_masses[k] = static_cast<float>(1.0 / midpoint_masses[edge]);
                triangle.rest_lengths[k] =
                    static_cast<float>(0.5 * (cloth.rest_positions[second] - cloth.rest_positions[first]).norm());
                movable = movable || triangle.inverse_masses[k] > 0.0f;
            }
            if (movable) triangles_.push_back(triangle);
        }
        coloring_ = sort_by_color(triangles_, topology_->edges().size(), &MidpointTriangle::midpoints);
    }

    void set_corners(const std::vector<std::uint32_t>& edge_of, const std::vector<double>& masses) {
        const std::span<const std::uint32_t> offsets = topology_->corner_offsets();
        for (std::size_t v = 0; v + 1 < offsets.size(); ++v) {
            double sum = 0.0;
            for (std::uint32_t n = offsets[v]; n < offsets[v + 1]; ++n) sum += masses[topology_->corners()[n] / 3];
            for (std::uint32_t n = offsets[v]; n < offsets[v + 1]; ++n) {
                const std::uint32_t corner = topology_->corners()[n];
                const std::uint32_t first_of_triangle = corner - corner % 3;
                corners_.push_back({edge_of[corner], edge_of[first_of_triangle + (corner + 1) % 3],
                                    edge_of[first_of_triangle + (corner + 2) % 3],
                                    sum > 0.0 ? static_cast<float>(masses[corner / 3] / sum) : 0.0f});
            }
        }
    }

    void relax(const MidpointTriangle& triangle, std::span<const Vector3f> positions) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t one = (k + 1) % 3;
            const std::size_t other = (k + 2) % 3;
            const float w_one = triangle.inverse_masses[one];
            const float w_other = triangle.inverse_masses[other];
            Vector3f& m_one = midpoints_[triangle.midpoints[one]];
            Vector3f& m_other = midpoints_[triangle.midpoints[other]];
            const Vector3f along = m_other - m_one;
            const float length = along.norm();
            if (!(length > 0.0f) || !(w_one + w_other > 0.0f)) continue;
            const Vector3f step = (length - triangle.rest_lengths[k]) / (length * (w_one + w_other)) * along;
            m_one += w_one * step;
            m_other -= w_other * step;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            if (!triangle.pinned[k]) continue;
            for (const std::size_t m : {(k + 1) % 3, (k + 2) % 3}) {
                if (!(triangle.inverse_masses[m] > 0.0f)) continue;
                Vector3f& midpoint = midpoints_[triangle.midpoints[m]];
                const Vector3f& pin = positions[triangle.vertices[k]];
                const float length = (midpoint - pin).norm();
                // Edge m has the half length that the midpoints other than m lie apart.
                if (length > 0.0f) midpoint = pin + triangle.rest_lengths[m] / length * (midpoint - pin);
            }
        }
    }

    void follow(std::span<Vector3f> positions) const {
        const std::span<const std::uint32_t> offsets = topology_->corner_offsets();
        const auto vertex_count = static_cast<std::int64_t>(positions.size());
        const auto moved = [&](std::uint32_t midpoint) -> Vector3f { return midpoints_[midpoint] - start_[midpoint]; };
#pragma omp parallel for schedule(static)
        for (std::int64_t v = 0; v < vertex_count; ++v) {
            if (!is_free_[v]) continue;
            Vector3f sum = Vector3f::Zero();
            for (std::uint32_t n = offsets[v]; n < offsets[v + 1]; ++n) {
                const Corner& corner = corners_[n];
                sum += corner.weight * (moved(corner.first) + moved(corner.second) - moved(corner.opposite));
            }
            positions[v] += sum;
        }
    }

    std::shared_ptr<const Topology> topology_;
    std::vector<bool> is_free_;  // [V]
    std::vector<MidpointTriangle> triangles_;
    Coloring coloring_;
    std::vector<Corner> corners_;      // [3T], by vertex as in Topology::corners
    std::vector<Vector3f> midpoints_;  // m, [E]
    std::vector<Vector3f> start_;      // m, [E]
    int iterations_;
    int passes_;
};

std::unique_ptr<Method> make_nonconforming_edge_midpoint(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<NonconformingEdgeMidpoint>(cloth, whole_number("iterations", values[0]),
                                                       whole_number("passes", values[1]));
}

}  // namespace

MethodInfo nonconforming_edge_midpoint_info() {
    return {.name = "nonconforming_edge_midpoint",
            .title = "Nonconforming edge midpoints",
            .citation = "Bender et al. 2011",
            .parameters = {iterations_parameter(20), {"passes", 2.0, 1.0, {2}}},
            .make = make_nonconforming_edge_midpoint};
}

}  // namespace apsl::methods

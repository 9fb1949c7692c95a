// SPDX-License-Identifier: MIT
//
// One area constraint for each vertex: the triangles around it may trade area among each other, their sum is kept. With
// one constraint a vertex instead of two (there are about twice as many triangles), in-plane shapes do not lock.
//
//     C_v = Σ_{a∋v} (A_a − A_a⁰),  ∇_i C_v = Σ_{a∋v,i} ½ n_a × e_{a,i},  Δx_i = −w_i C_v / (Σ_j w_j |∇_j C_v|²) ∇_i C_v
//
// The one-ring is that of Irving et al., who keep the volume of tetrahedra around a vertex by a global solve; here the
// rings are projected one by one as in position-based dynamics. Gauss–Seidel by colors rather than Jacobi: on a regular
// mesh seven rings meet at a vertex, so that averaging would slow each down sevenfold, and the colors, though more than
// for triangles, still hold V / colors rings each.
//
// G. Irving, C. Schroeder, R. Fedkiw: Volume conserving finite element simulations of deformable models. ACM
// Transactions on Graphics 26(3), 2007.
// M. Müller, B. Heidelberger, M. Hennix, J. Ratcliff: Position based dynamics. Journal of Visual Communication and
// Image Representation 18(2), 2007: Section 3.3.
#include "methods/all_methods.hpp"

#include "methods/area_constraints.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/parameter_values.hpp"

#include <algorithm>

namespace apsl::methods {
namespace {

struct Ring {
    std::uint32_t first_vertex, vertex_count;      // in ring_vertices
    std::uint32_t first_triangle, triangle_count;  // in ring_triangles
    float rest_area;                               // m², of all its triangles
};

class RingArea : public Method {
public:
    RingArea(const Cloth& cloth, int iterations)
        : inverse_masses_(cloth.topology->vertex_count()), iterations_(iterations) {
        for (std::size_t v = 0; v < inverse_masses_.size(); ++v)
            inverse_masses_[v] = static_cast<float>(cloth.inverse_masses[v]);
        for (std::uint32_t v = 0; v < inverse_masses_.size(); ++v) add_ring(cloth, v);
        coloring_ = sort_by_color(rings_, inverse_masses_.size(), [&](const Ring& ring) { return vertices_of(ring); });
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        sweep_colors(rings_, coloring_, iterations_, [&](const Ring& ring) { project_ring(ring, positions); });
    }

private:
    // None for a vertex in no triangle, nor where all vertices are pinned.
    void add_ring(const Cloth& cloth, std::uint32_t center) {
        const Topology& topology = *cloth.topology;
        Ring ring{static_cast<std::uint32_t>(vertices_.size()), 0, static_cast<std::uint32_t>(triangles_.size()), 0, 0};
        double rest_area = 0.0;
        for (std::uint32_t c = topology.corner_offsets()[center]; c < topology.corner_offsets()[center + 1]; ++c) {
            const std::uint32_t a = topology.corners()[c] / 3;
            rest_area += cloth.rest_areas[a];
            const Triangle& triangle = topology.triangles()[a];
            vertices_.insert(vertices_.end(), triangle.begin(), triangle.end());
            triangles_.push_back(triangle);
        }
        std::sort(vertices_.begin() + ring.first_vertex, vertices_.end());
        vertices_.erase(std::unique(vertices_.begin() + ring.first_vertex, vertices_.end()), vertices_.end());
        ring.vertex_count = static_cast<std::uint32_t>(vertices_.size()) - ring.first_vertex;
        ring.triangle_count = static_cast<std::uint32_t>(triangles_.size()) - ring.first_triangle;
        ring.rest_area = static_cast<float>(rest_area);
        const std::span<const std::uint32_t> vertices = vertices_of(ring);
        for (std::uint32_t t = ring.first_triangle; t < triangles_.size(); ++t)
            for (std::uint32_t& v : triangles_[t])
                v = static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, v) - vertices.begin());
        if (std::ranges::any_of(vertices, [&](std::uint32_t v) { return inverse_masses_[v] > 0.0f; })) {
            rings_.push_back(ring);
        } else {
            vertices_.resize(ring.first_vertex);
            triangles_.resize(ring.first_triangle);
        }
    }

    std::span<const std::uint32_t> vertices_of(const Ring& ring) const {
        return std::span(vertices_).subspan(ring.first_vertex, ring.vertex_count);
    }

    void project_ring(const Ring& ring, std::span<Eigen::Vector3f> positions) const {
        thread_local std::vector<Eigen::Vector3f> gradients;
        gradients.assign(ring.vertex_count, Eigen::Vector3f::Zero());
        const std::span<const std::uint32_t> vertices = vertices_of(ring);
        float area = 0.0f;
        for (std::uint32_t t = ring.first_triangle; t < ring.first_triangle + ring.triangle_count; ++t) {
            const auto [i, j, k] = triangles_[t];
            const TriangleArea now =
                triangle_area(positions[vertices[i]], positions[vertices[j]], positions[vertices[k]]);
            area += now.area;
            gradients[i] += now.gradients[0];
            gradients[j] += now.gradients[1];
            gradients[k] += now.gradients[2];
        }
        float weight = 0.0f;
        for (std::size_t n = 0; n < vertices.size(); ++n)
            weight += inverse_masses_[vertices[n]] * gradients[n].squaredNorm();
        if (!(weight > 0.0f)) return;  // no direction to push in
        const float multiplier = (ring.rest_area - area) / weight;
        for (std::size_t n = 0; n < vertices.size(); ++n) {
            const float w = inverse_masses_[vertices[n]];
            if (w > 0.0f) positions[vertices[n]] += w * multiplier * gradients[n];
        }
    }

    std::vector<float> inverse_masses_;    // 1/kg, [V]
    std::vector<Ring> rings_;              // in color order
    std::vector<std::uint32_t> vertices_;  // ring by ring, ascending within one
    std::vector<Triangle> triangles_;      // ring by ring, numbers within the ring's vertices
    Coloring coloring_;
    int iterations_;
};

std::unique_ptr<Method> make_ring_area(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<RingArea>(cloth, whole_number("iterations", values[0]));
}

}  // namespace

MethodInfo ring_area_info() {
    return {.name = "ring_area",
            .title = "One-ring areas",
            .citation = "after Irving et al. 2007",
            .parameters = {iterations_parameter(20)},
            .make = make_ring_area};
}

}  // namespace apsl::methods

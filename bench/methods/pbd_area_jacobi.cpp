// SPDX-License-Identifier: MIT
//
// The area constraints of pbd_area_gauss_seidel.cpp, all triangles at once from the same positions.
//
// Corrections that merely add up overshoot. Each vertex is divided evenly among the n triangles at it, and its parts'
// displacements are averaged (Tonge et al. 2012):
//
//     λ_a = −C_a / (Σ_j n_j w_j |∇_j C_a|²),  Δx_i = w_i Σ_{a∋i} λ_a ∇_i C_a
//
// Where all n are the same this is the average of the corrections; where they are not, it still keeps momentum, which
// an average would not.
//
// M. Müller, B. Heidelberger, M. Hennix, J. Ratcliff: Position based dynamics. Journal of Visual Communication and
// Image Representation 18(2), 2007: Section 3.3.
// R. Tonge, F. Benevolenski, A. Voroshilov: Mass splitting for jitter-free parallel rigid body simulation. ACM
// Transactions on Graphics 31(4), 2012.
#include "methods/all_methods.hpp"

#include "methods/area_constraints.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/parameter_values.hpp"

namespace apsl::methods {
namespace {

class PbdAreaJacobi : public Method {
public:
    PbdAreaJacobi(const Cloth& cloth, int iterations)
        : constraints_(area_constraints(cloth)),
          impulses_(3 * constraints_.size()),
          corner_offsets_(cloth.topology->vertex_count() + 1, 0),
          corners_(impulses_.size()),
          inverse_masses_(cloth.topology->vertex_count()),
          iterations_(iterations) {
        for (std::size_t v = 0; v < inverse_masses_.size(); ++v)
            inverse_masses_[v] = static_cast<float>(cloth.inverse_masses[v]);
        for (const AreaConstraint& triangle : constraints_)
            for (const std::uint32_t v : triangle.vertices) ++corner_offsets_[v + 1];
        for (AreaConstraint& triangle : constraints_)
            for (std::size_t k = 0; k < 3; ++k)
                triangle.inverse_masses[k] *= static_cast<float>(corner_offsets_[triangle.vertices[k] + 1]);
        for (std::size_t v = 1; v < corner_offsets_.size(); ++v) corner_offsets_[v] += corner_offsets_[v - 1];
        std::vector<std::uint32_t> next(corner_offsets_.begin(), corner_offsets_.end() - 1);
        for (std::uint32_t c = 0; c < corners_.size(); ++c) corners_[next[constraints_[c / 3].vertices[c % 3]]++] = c;
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        const std::size_t triangle_count = constraints_.size();
        const std::size_t vertex_count = inverse_masses_.size();
#pragma omp parallel if (triangle_count >= least_parallel_count)
        for (int iteration = 0; iteration < iterations_; ++iteration) {
#pragma omp for schedule(static)
            for (std::size_t a = 0; a < triangle_count; ++a) {
                const TriangleArea now = constraints_[a].at(positions);
                const float weight = constraints_[a].weight(now);
                const float multiplier = weight > 0.0f ? (constraints_[a].rest_area - now.area) / weight : 0.0f;
                for (std::size_t k = 0; k < 3; ++k) impulses_[3 * a + k] = multiplier * now.gradients[k];
            }
#pragma omp for schedule(static)
            for (std::size_t v = 0; v < vertex_count; ++v) {
                if (inverse_masses_[v] == 0.0f) continue;
                Eigen::Vector3f sum = Eigen::Vector3f::Zero();
                for (std::uint32_t c = corner_offsets_[v]; c < corner_offsets_[v + 1]; ++c)
                    sum += impulses_[corners_[c]];
                positions[v] += inverse_masses_[v] * sum;
            }
        }
    }

private:
    std::vector<AreaConstraint> constraints_;    // with the inverse masses n w of the vertices' parts
    std::vector<Eigen::Vector3f> impulses_;      // kg·m, [3T], λ ∇C at each corner
    std::vector<std::uint32_t> corner_offsets_;  // [V + 1]
    std::vector<std::uint32_t> corners_;         // at each vertex, ascending
    std::vector<float> inverse_masses_;          // 1/kg, [V]
    int iterations_;
};

std::unique_ptr<Method> make_pbd_area_jacobi(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<PbdAreaJacobi>(cloth, whole_number("iterations", values[0]));
}

}  // namespace

MethodInfo pbd_area_jacobi_info() {
    return {.name = "pbd_area_jacobi",
            .title = "PBD areas, Jacobi",
            .citation = "Müller et al. 2007; Tonge et al. 2012",
            .parameters = {iterations_parameter(20)},
            .make = make_pbd_area_jacobi};
}

}  // namespace apsl::methods

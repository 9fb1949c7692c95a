// SPDX-License-Identifier: MIT
//
// Position-based dynamics with an area constraint on every triangle.
//
//     C = A − A⁰,  ∇_i C = ½ n × e_i,  Δx_i = −w_i C / (Σ_j w_j |∇_j C|²) ∇_i C
//
// Gauss–Seidel as the paper has it: one triangle after another in the order of the mesh, on one thread.
//
// M. Müller, B. Heidelberger, M. Hennix, J. Ratcliff: Position based dynamics. Journal of Visual Communication and
// Image Representation 18(2), 2007: Section 3.3.
#include "methods/all_methods.hpp"

#include "methods/area_constraints.hpp"
#include "methods/parameter_values.hpp"

namespace apsl::methods {
namespace {

class PbdAreaGaussSeidel : public Method {
public:
    PbdAreaGaussSeidel(const Cloth& cloth, int iterations)
        : constraints_(area_constraints(cloth)), iterations_(iterations) {}

    void project(std::span<Eigen::Vector3f> positions) override {
        for (int iteration = 0; iteration < iterations_; ++iteration)
            for (const AreaConstraint& triangle : constraints_) project_area(triangle, positions);
    }

private:
    std::vector<AreaConstraint> constraints_;
    int iterations_;
};

std::unique_ptr<Method> make_pbd_area_gauss_seidel(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<PbdAreaGaussSeidel>(cloth, whole_number("iterations", values[0]));
}

}  // namespace

MethodInfo pbd_area_gauss_seidel_info() {
    return {.name = "pbd_area_gauss_seidel",
            .title = "PBD areas, Gauss–Seidel",
            .citation = "Müller et al. 2007",
            .parameters = {iterations_parameter(20)},
            .make = make_pbd_area_gauss_seidel};
}

}  // namespace apsl::methods

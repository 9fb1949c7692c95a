// SPDX-License-Identifier: MIT
//
// pbd_area_gauss_seidel.cpp color by color: no two triangles of a color share a vertex, so they run in parallel.
//
// M. Müller, B. Heidelberger, M. Hennix, J. Ratcliff: Position based dynamics. Journal of Visual Communication and
// Image Representation 18(2), 2007: Section 3.3.
// M. Fratarcangeli, V. Tibaldo, F. Pellacini: Vivace: a practical Gauss–Seidel method for stable soft body dynamics.
// ACM Transactions on Graphics 35(6), 2016: graph coloring for parallel Gauss–Seidel.
#include "methods/all_methods.hpp"

#include "methods/area_constraints.hpp"
#include "methods/color_sweeps.hpp"
#include "methods/parameter_values.hpp"

namespace apsl::methods {
namespace {

class PbdAreaColored : public Method {
public:
    PbdAreaColored(const Cloth& cloth, int iterations)
        : constraints_(area_constraints(cloth)), iterations_(iterations) {
        coloring_ = sort_by_color(constraints_, cloth.topology->vertex_count(), &AreaConstraint::vertices);
    }

    void project(std::span<Eigen::Vector3f> positions) override {
        sweep_colors(constraints_, coloring_, iterations_,
                     [&](const AreaConstraint& triangle) { project_area(triangle, positions); });
    }

private:
    std::vector<AreaConstraint> constraints_;
    Coloring coloring_;
    int iterations_;
};

std::unique_ptr<Method> make_pbd_area_colored(const Cloth& cloth, std::span<const double> values) {
    return std::make_unique<PbdAreaColored>(cloth, whole_number("iterations", values[0]));
}

}  // namespace

MethodInfo pbd_area_colored_info() {
    return {.name = "pbd_area_colored",
            .title = "PBD areas, colored Gauss–Seidel",
            .citation = "Müller et al. 2007; Fratarcangeli et al. 2016",
            .parameters = {iterations_parameter(20)},
            .make = make_pbd_area_colored};
}

}  // namespace apsl::methods

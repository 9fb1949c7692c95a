// SPDX-License-Identifier: MIT
//
// Every method is judged by the displacements it makes, for those are what all of them give: a device's pressures stay
// on the device, and G has null vectors, along which pressures may differ and mean nothing.
#pragma once

#include "cloth.hpp"
#include "pressure_system.hpp"

#include <apsl/parameters.hpp>
#include <apsl/reference.hpp>

#include "reference/conjugate_gradient.hpp"

#include <cstddef>
#include <vector>

namespace apsl::bench {

/// What double precision makes of a cloth.
class Accuracy {
public:
    explicit Accuracy(const Cloth& cloth);

    std::size_t entries() const { return static_cast<std::size_t>(consistent_.nonZeros()); }
    /// In float, with α = regularization on the diagonal.
    PressureSystem system(double regularization) const;
    /// Eq. (6), m, [3V].
    std::vector<double> displacements(const std::vector<float>& lambda) const;

    /// ‖Δx − Δx'‖ / ‖Δx'‖ where Δx' is what the same number of iterations makes of it in double precision.
    double displacement_error(const std::vector<double>& displacements, double regularization, int iterations) const;
    /// ‖b − G λ‖ / ‖b‖ of a solve with α = 1, from Δx = −W Jᵀ… λ alone: G λ = −J Δx. (With α > 1 the damping would ask
    /// for λ itself.)
    double residual(const std::vector<double>& displacements) const;
    /// ‖ṽ − ṽ'‖ / ‖ṽ'‖ of a filter call that began with ṽ = 0, ṽ' by the double-precision filter. `velocities` may hold
    /// several copies of the cloth; the worst counts.
    double filter_error(const std::vector<float>& velocities, const Parameters& parameters);

private:
    const Cloth& cloth_;
    std::vector<double> inverse_masses_;
    std::vector<reference::TriangleGeometry<double>> geometry_;
    reference::SparseMatrix<double> consistent_;  // G, α = 1
    reference::TriangleVector<double> area_excess_;
    std::vector<double> filtered_;  // ṽ', by the double-precision filter with the parameters it was last asked for
};

}  // namespace apsl::bench

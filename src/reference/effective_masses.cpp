// SPDX-License-Identifier: MIT
#include "reference/effective_masses.hpp"

#include "raised_masses.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::reference {

template <class Real>
Real geometric_stiffness(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                         std::span<const Real> lambda, std::size_t vertex) {
    Real sum = 0;
    for (std::uint32_t n = topology.corner_offsets()[vertex]; n < topology.corner_offsets()[vertex + 1]; ++n) {
        const Corner corner = topology.corners()[n];
        const TriangleGeometry<Real>& triangle = geometry[corner / 3];
        if (triangle.area > Real(0))
            sum += std::max(lambda[corner / 3], Real(0)) * triangle.gradients[corner % 3].squaredNorm() /
                   (Real(2) * triangle.area);
    }
    return sum;
}

template <class Real>
Real effective_mass(Real mass, Real stiffness, Real greatest) {
    return std::max(mass, std::min(static_cast<Real>(mass_per_stiffness) * stiffness, greatest));
}

template <class Real>
Real greatest_effective_mass(std::span<const Real> inverse_masses) {
    Real sum = 0, movable = 0;
    for (Real w : inverse_masses)
        if (w > Real(0)) {
            sum -= std::log(w);
            movable += Real(1);
        }
    return movable > Real(0) ? static_cast<Real>(greatest_mean_masses) * std::exp(sum / movable) : Real(0);
}

template <class Real>
void EffectiveMasses<Real>::start(std::span<const Real> inverse_masses) {
    inverse.assign(inverse_masses.begin(), inverse_masses.end());
    tension.assign(inverse_masses.size(), Real(0));
    stiffness.assign(inverse_masses.size(), Real(0));
    greatest = greatest_effective_mass(inverse_masses);
}

template <class Real>
void EffectiveMasses<Real>::find_tension(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                                         std::span<const Real> lambda) {
    for (std::size_t i = 0; i < tension.size(); ++i) tension[i] = geometric_stiffness(topology, geometry, lambda, i);
}

template <class Real>
Real EffectiveMasses<Real>::share_taken(std::size_t vertex, Real inverse_mass) const {
    if (!(inverse_mass > Real(0))) return Real(1);
    const Real mass = std::min(tension[vertex], std::max(Real(1) / inverse_mass, greatest));
    return mass * inverse[vertex] > Real(1) ? Real(1) / (mass * inverse[vertex]) : Real(1);
}

template <class Real>
void EffectiveMasses<Real>::raise(std::span<const Real> inverse_masses) {
    for (std::size_t i = 0; i < inverse.size(); ++i) {
        if (!(inverse_masses[i] > Real(0))) continue;
        stiffness[i] = std::max(tension[i], static_cast<Real>(stiffness_kept) * stiffness[i]);
        const Real mass = Real(1) / inverse_masses[i];
        const Real effective = effective_mass(mass, stiffness[i], greatest);
        inverse[i] = effective > mass ? Real(1) / effective : inverse_masses[i];
    }
}

template double geometric_stiffness(const Topology&, std::span<const TriangleGeometry<double>>, std::span<const double>,
                                    std::size_t);
template float geometric_stiffness(const Topology&, std::span<const TriangleGeometry<float>>, std::span<const float>,
                                   std::size_t);
template double effective_mass(double, double, double);
template float effective_mass(float, float, float);
template double greatest_effective_mass(std::span<const double>);
template float greatest_effective_mass(std::span<const float>);
template struct EffectiveMasses<double>;
template struct EffectiveMasses<float>;

}  // namespace apsl::reference

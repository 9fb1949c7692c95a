// SPDX-License-Identifier: MIT
#include "reference/bending.hpp"

#include "../../kernels/constants.h"

#include <algorithm>
#include <cmath>

namespace apsl::reference {

template <class Real>
BendingPolynomial<Real>::BendingPolynomial(int degree) {
    const Real ripple = Real(APSLK_BENDING_RIPPLE), count = static_cast<Real>(degree);
    eta_ = std::acosh(ripple) / count;
    // y p(y) = scale (1 − T(σ − slope y) / T(σ)), T(σ) = ripple: its greatest value and its slope at 0 are as said.
    scale_ = Real(APSLK_BENDING_GREATEST) / (Real(1) + Real(1) / ripple);
    const Real derivative = count * std::sinh(count * eta_) / std::sinh(eta_);
    slope_ = ripple / (scale_ * derivative);
    const Real sigma = chebyshev(1);
    reach_ = (sigma + Real(1)) / slope_;
    first_ = slope_ / sigma;
}

template <class Real>
Real BendingPolynomial<Real>::chebyshev(int k) const {
    return std::cosh(static_cast<Real>(k) * eta_);
}

template <class Real>
Real BendingPolynomial<Real>::momentum(int k) const {
    return chebyshev(k - 1) / chebyshev(k + 1);
}

template <class Real>
Real BendingPolynomial<Real>::gain(int k) const {
    return Real(2) * slope_ * chebyshev(k) / chebyshev(k + 1);
}

template <class Real>
HingeRow<Real> hinge_row(const Hinge& hinge, const RestHinge<Real>& rest, std::span<const Real> positions,
                         std::span<const Real> inverse_masses, std::span<const std::uint32_t> hinge_counts,
                         Real rigidity, Real duration, Real reach) {
    const HingeGeometry<Real> geometry = hinge_geometry(hinge, positions);
    Real greatest = Real(0), sum = Real(0);
    for (std::size_t n = 0; n < 4; ++n) {
        const Real length = geometry.gradients[n].norm();
        greatest = std::max(greatest, static_cast<Real>(hinge_counts[hinge[n]]) * inverse_masses[hinge[n]] * length);
        sum += length;
    }
    const Real unit = duration * duration * greatest * sum;
    const Real asked = rigidity * rest.shape;
    const Real root = std::sqrt(asked * unit > reach ? reach / unit : asked);
    HingeRow<Real> row{root * bend(geometry.angle, rest.angle), geometry.gradients};
    for (Vector3<Real>& gradient : row.gradients) gradient *= root;
    return row;
}

template <class Real>
Bending<Real>::Bending(const Topology& topology) : hinges_(topology.hinges()) {
    hinge_counts_.assign(topology.vertex_count(), 0);
    for (const Hinge& hinge : hinges_)
        for (const std::uint32_t vertex : hinge) ++hinge_counts_[vertex];
}

template <class Real>
void Bending<Real>::start(const Buffers<Real>& buffers) {
    inverse_masses_ = buffers.inverse_masses;
    rest_hinges_ = buffers.rest_hinges;
}

template <class Real>
template <class Factor>
void Bending<Real>::gather(const Factor& factor, std::vector<Real>& target) const {
    target.assign(3 * inverse_masses_.size(), Real(0));
    for (std::size_t r = 0; r < hinges_.size(); ++r) {
        const Real times = factor(rows_[r], hinges_[r]);
        for (std::size_t n = 0; n < 4; ++n)
            Eigen::Map<Vector3<Real>>(target.data() + 3 * hinges_[r][n]) -=
                inverse_masses_[hinges_[r][n]] * times * rows_[r].gradients[n];
    }
}

template <class Real>
void Bending<Real>::find_velocity_changes(std::span<const Real> positions, std::span<const Real> motion,
                                          const ResolvedParameters& parameters) {
    const Real parts = static_cast<Real>(parameters.small_steps);
    const Real duration = static_cast<Real>(parameters.time_step) / parts;
    const BendingPolynomial<Real> polynomial(parameters.bending_iterations);
    changes_.assign(positions.size(), Real(0));
    rows_.clear();
    if (!(parameters.bending > 0.0f)) return;

    ahead_.resize(positions.size());
    for (std::size_t n = 0; n < ahead_.size(); ++n)
        ahead_[n] = positions[n] + Real(APSLK_BENDING_LEAD) * motion[n] / parts;
    rows_.resize(hinges_.size());
    for (std::size_t r = 0; r < hinges_.size(); ++r)
        rows_[r] = hinge_row<Real>(hinges_[r], {rest_hinges_[2 * r], rest_hinges_[2 * r + 1]}, ahead_, inverse_masses_,
                                   hinge_counts_, static_cast<Real>(parameters.bending), duration, polynomial.reach());

    gather([](const HingeRow<Real>& row, const Hinge&) { return row.moment; }, residual_);
    for (Real& r : residual_) r *= polynomial.scale() * duration;
    step_.resize(residual_.size());
    for (std::size_t n = 0; n < step_.size(); ++n) step_[n] = changes_[n] = polynomial.first() * residual_[n];
    for (int k = 1; k < parameters.bending_iterations; ++k) {
        gather(
            [&](const HingeRow<Real>& row, const Hinge& hinge) {
                Real sum = Real(0);
                for (std::size_t n = 0; n < 4; ++n) sum += row.gradients[n].dot(position<Real>(step_, hinge[n]));
                return sum;
            },
            product_);
        for (std::size_t n = 0; n < step_.size(); ++n) {
            residual_[n] += duration * duration * product_[n];
            step_[n] = polynomial.momentum(k) * step_[n] + polynomial.gain(k) * residual_[n];
            changes_[n] += step_[n];
        }
    }
}

template <class Real>
double Bending<Real>::energy() const {
    double sum = 0.0;
    for (const HingeRow<Real>& row : rows_) sum += 0.5 * static_cast<double>(row.moment * row.moment);
    return sum;
}

template <class Real>
std::size_t Bending<Real>::bytes() const {
    return hinges_.size() * sizeof(Hinge) + hinge_counts_.size() * sizeof(std::uint32_t) +
           rows_.size() * sizeof(HingeRow<Real>) +
           (ahead_.size() + residual_.size() + step_.size() + product_.size() + changes_.size()) * sizeof(Real);
}

#define APSL_INSTANTIATE(Real)                                                                                  \
    template class BendingPolynomial<Real>;                                                                     \
    template HingeRow<Real> hinge_row(const Hinge&, const RestHinge<Real>&, std::span<const Real>,              \
                                      std::span<const Real>, std::span<const std::uint32_t>, Real, Real, Real); \
    template class Bending<Real>;
APSL_INSTANTIATE(double)
APSL_INSTANTIATE(float)
#undef APSL_INSTANTIATE

}  // namespace apsl::reference

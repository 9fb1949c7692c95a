// SPDX-License-Identifier: MIT
#pragma once

#include "reference/hinges.hpp"

#include "resolved_parameters.hpp"

#include <apsl/reference.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace apsl::reference {

/// What stands in place of the bending force f(x) in a small step of duration h: p(h² W K) f, W the inverse masses, K
/// the stiffness. y p(y) is a Chebyshev polynomial of degree `degree`, with 1 its slope at y = 0, which stays between 0
/// and APSLK_BENDING_GREATEST up to y = reach (leapfrog-Chebyshev: Carle, Hochbruck & Sturm 2020, On leapfrog-Chebyshev
/// schemes, SIAM Journal on Numerical Analysis 58). Of degree 1 it is the force itself.
///
/// With r₀ = scale · h W f and s₀ = first · r₀, r_k = r_{k−1} − h² W K s_{k−1} and s_k = momentum(k) s_{k−1} + gain(k)
/// r_k, the change of velocity is Σ s_k over k < degree.
template <class Real>
class BendingPolynomial {
public:
    explicit BendingPolynomial(int degree);

    Real reach() const { return reach_; }
    Real scale() const { return scale_; }
    Real first() const { return first_; }
    Real momentum(int k) const;
    Real gain(int k) const;

private:
    Real chebyshev(int k) const;  ///< T_k at y = 0

    Real eta_, slope_, reach_, scale_, first_;
};

/// A hinge linearised: moment and gradients times √k, so that its force on vertex n is −moment · gradients[n], and its
/// share of the stiffness gradients gradientsᵀ.
template <class Real>
struct HingeRow {
    Real moment;                             ///< √k (θ − θ⁰), √J
    std::array<Vector3<Real>, 4> gradients;  ///< √k ∂θ/∂x, √J/m
};

/// Of a hinge of stiffness k = `rigidity` · rest.shape, or of the greatest that keeps h² W K within `reach`: a hinge's
/// K is at most k |∂θ/∂x_i| Σ_j |∂θ/∂x_j| at vertex i (Gershgorin), and each of the `hinge_counts` [V] hinges there
/// gets an equal share.
template <class Real>
HingeRow<Real> hinge_row(const Hinge& hinge, const RestHinge<Real>& rest, std::span<const Real> positions,
                         std::span<const Real> inverse_masses, std::span<const std::uint32_t> hinge_counts,
                         Real rigidity, Real duration, Real reach);

/// Bending of one cloth (docs/formulation.md, Bending).
template <class Real>
class Bending {
public:
    Bending() = default;
    explicit Bending(const Topology& topology);

    /// At the beginning of a call.
    void start(const Buffers<Real>& buffers);
    /// Of a small step that starts at `positions`, m, with `motion` = Δt u.
    void find_velocity_changes(std::span<const Real> positions, std::span<const Real> motion,
                               const ResolvedParameters& parameters);
    std::span<const Real> velocity_changes() const { return changes_; }  ///< m/s, [3V]
    double energy() const;                                               ///< J, at the start of that small step

    std::size_t bytes() const;  ///< held between calls

private:
    /// target ← −w Σ factor(r) · gradients over the hinges r at each vertex.
    template <class Factor>
    void gather(const Factor& factor, std::vector<Real>& target) const;

    std::vector<Hinge> hinges_;
    std::vector<std::uint32_t> hinge_counts_;  ///< hinges at each vertex, [V]
    std::span<const Real> inverse_masses_, rest_hinges_;
    std::vector<HingeRow<Real>> rows_;
    std::vector<Real> ahead_, residual_, step_, product_, changes_;
};

}  // namespace apsl::reference

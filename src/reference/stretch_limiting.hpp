// SPDX-License-Identifier: MIT
#pragma once

#include "reference/chebyshev.hpp"
#include "reference/stretch_rows.hpp"

#include "../../kernels/constants.h"

#include <apsl/reference.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace apsl::reference {

/// max(0, principal stretch − ceiling) over the triangles of a cloth that have a ceiling.
struct StretchExcess {
    double greatest_stretch = 0.0;
    double max = 0.0;
    double rms = 0.0;         ///< root of the mean of the squares, weighted with A⁰
    double capped_rms = 0.0;  ///< the same with each triangle's counted as at most 1
    bool finite = true;       ///< every triangle's is; where not, the others mean nothing
};

/// What a solve for areas and stretches at once needs to know.
struct StretchSolve {
    int small_steps = 0;  ///< of the call
    int products = 1;     ///< of the polynomial
    /// How fast, a step, an excess is asked for again that a sub-step could not take.
    float asked_again = APSLK_EXCESS_ASKED_AGAIN;
};

/// The stretch ceiling of one call: two rows a triangle, of its area and of its greatest principal stretch, solved
/// together by a polynomial whose multipliers of stretch rows stay at or above zero (docs/formulation.md, Stretch
/// ceiling).
template <class Real>
class StretchLimiting {
public:
    /// `ceiling`: of all triangles, where `buffers` has none for each.
    void start(const Topology& topology, const Buffers<Real>& buffers, Real ceiling);
    /// Lets the excess of the start of the step stand, for now.
    void hold_excess(std::span<const Real> positions);

    StretchExcess measure(std::span<const Real> positions) const;
    /// Of triangle a: max(0, s₁ − ceiling).
    Real excess(std::size_t a, std::span<const Real> positions) const;
    /// Likewise, at the start of the step.
    Real start_excess(std::size_t a) const { return start_excess_[a]; }

    /// One solve at `positions`, whose triangles have `geometry` and lack `area_excess` (b, m²).
    void solve(std::span<const Real> positions, std::span<const TriangleGeometry<Real>> geometry,
               const TriangleVector<Real>& area_excess, const StretchSolve& how);
    /// −w' Σ y ∇C of every vertex, [3V]; with `raises_masses` where the tension just found asks for more mass, with
    /// that.
    void displacements(bool raises_masses, std::vector<Real>& displacements) const;
    /// The share of its velocity that a vertex keeps after the last solve. Mass beyond the ratio that sub-steps aim at
    /// resists a change of velocity and carries none.
    Real velocity_kept(std::size_t vertex) const;
    /// The masses of the next sub-step.
    void raise_masses();

    bool finite() const { return y_.allFinite(); }  ///< the last solve's multipliers
    std::uint32_t rows_at_work() const;             ///< stretch rows with a multiplier above zero
    std::span<const Real> inverse_masses() const { return inverse_masses_; }  ///< w', [V]
    std::size_t bytes() const;                                                ///< held between calls

private:
    Real stretch(std::size_t a, std::span<const Real> positions) const;  ///< s₁
    Real excess(std::size_t a, Real stretch) const;                      ///< of a triangle with a ceiling
    /// w' of its corners.
    std::array<Real, 3> corner_masses(std::size_t a) const;
    ConstraintRow<Real> limited_row(std::size_t a, std::span<const Real> positions, const ConstraintRow<Real>& area,
                                    const StretchSolve& how);
    void find_tension(std::span<const TriangleGeometry<Real>> geometry);
    Real taken_inverse_mass(std::size_t vertex) const;

    const Topology* topology_ = nullptr;
    std::span<const Real> given_inverse_masses_, rest_areas_;
    std::vector<RestShape<Real>> shapes_;
    std::vector<Real> ceilings_;                    ///< 0: none
    std::vector<Real> start_excess_, held_excess_;  ///< at the start of the step, and that the sub-step lets stand

    std::vector<ConstraintRow<Real>> rows_;  ///< areas, [T], then stretches, [T]; one that takes no part is zero
    std::vector<std::uint32_t> owners_;
    std::vector<Real> stretch_, share_;  ///< s₁ and r of the orthogonalized row, [T]
    RowSystem<Real> system_;
    std::vector<std::uint8_t> one_sided_;
    ChebyshevScratch<Real> scratch_;
    TriangleVector<Real> y_;

    std::vector<Real> inverse_masses_;       ///< w'
    std::vector<Real> tension_, stiffness_;  ///< K of the last solve, and the K that is kept; kg
};

}  // namespace apsl::reference

// SPDX-License-Identifier: MIT
#include "reference/stretch_limiting.hpp"

#include "raised_masses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace apsl::reference {
namespace {

constexpr float stretch_margin = APSLK_STRETCH_MARGIN;
constexpr float excess_taken = APSLK_EXCESS_TAKEN;
constexpr float least_row_share = APSLK_LEAST_ROW_SHARE;
constexpr float mass_added_per_stiffness = APSLK_MASS_ADDED_PER_STIFFNESS;

template <class Real>
constexpr ConstraintRow<Real> no_row() {
    return {Real(0), {Vector3<Real>::Zero(), Vector3<Real>::Zero(), Vector3<Real>::Zero()}};
}

/// The excess that the next of `small_steps` sub-steps lets stand, from what this one lets stand and what there is
/// before it: what this one is asked to take and cannot is asked for again slowly, `asked_again` a step.
template <class Real>
Real next_held_excess(Real held, Real excess, Real start, const StretchSolve& how) {
    const Real part = Real(1) / static_cast<Real>(how.small_steps);
    const Real could_not = excess - Real(excess_taken) * (excess - held) - Real(how.asked_again) * part;
    return std::max(std::exp(-Real(APSLK_EXCESS_LEAD) * part) * held, std::min(could_not, start));
}

}  // namespace

template <class Real>
void StretchLimiting<Real>::start(const Topology& topology, const Buffers<Real>& buffers, Real ceiling) {
    topology_ = &topology;
    given_inverse_masses_ = buffers.inverse_masses;
    rest_areas_ = buffers.rest_areas;
    const std::size_t count = topology.triangle_count();
    shapes_.resize(count);
    ceilings_.resize(count);
    for (std::size_t a = 0; a < count; ++a) {
        shapes_[a] = rest_shape(buffers.rest_shapes, a);
        const bool has_shape = shapes_[a][1][0] * shapes_[a][2][1] - shapes_[a][1][1] * shapes_[a][2][0] != Real(0);
        const Real given = buffers.stretch_ceilings.empty() ? ceiling : buffers.stretch_ceilings[a];
        ceilings_[a] = has_shape && rest_areas_[a] > Real(0) ? given : Real(0);
    }
    start_excess_.assign(count, Real(0));
    held_excess_.assign(count, Real(0));
    inverse_masses_.assign(given_inverse_masses_.begin(), given_inverse_masses_.end());
    tension_.assign(inverse_masses_.size(), Real(0));
    stiffness_.assign(inverse_masses_.size(), Real(0));
    rows_.assign(2 * count, no_row<Real>());
    owners_.resize(2 * count);
    one_sided_.assign(2 * count, 0);
    for (std::size_t a = 0; a < count; ++a) {
        owners_[a] = owners_[count + a] = static_cast<std::uint32_t>(a);
        one_sided_[count + a] = 1;
    }
    stretch_.assign(count, Real(0));
    share_.assign(count, Real(0));
    y_ = TriangleVector<Real>::Zero(static_cast<Eigen::Index>(2 * count));
}

template <class Real>
Real StretchLimiting<Real>::stretch(std::size_t a, std::span<const Real> positions) const {
    return principal_stretch(shapes_[a], topology_->triangles()[a], positions).value;
}

template <class Real>
Real StretchLimiting<Real>::excess(std::size_t a, Real stretch) const {
    const Real value = stretch - ceilings_[a];
    return value < Real(0) ? Real(0) : value;  // a NaN stays
}

template <class Real>
Real StretchLimiting<Real>::excess(std::size_t a, std::span<const Real> positions) const {
    return ceilings_[a] == Real(0) ? Real(0) : excess(a, stretch(a, positions));
}

template <class Real>
void StretchLimiting<Real>::hold_excess(std::span<const Real> positions) {
    for (std::size_t a = 0; a < start_excess_.size(); ++a) start_excess_[a] = excess(a, positions);
    held_excess_ = start_excess_;
}

template <class Real>
StretchExcess StretchLimiting<Real>::measure(std::span<const Real> positions) const {
    StretchExcess sums;
    double squares = 0.0, capped_squares = 0.0, weights = 0.0;
    constexpr double greatest = std::numeric_limits<float>::max();
    for (std::size_t a = 0; a < ceilings_.size(); ++a) {
        const auto rest_area = static_cast<double>(rest_areas_[a]);
        weights += rest_area;
        if (ceilings_[a] == Real(0)) continue;
        const Real drawn = stretch(a, positions);
        const auto above = static_cast<double>(excess(a, drawn));
        sums.finite = sums.finite && static_cast<double>(drawn) * static_cast<double>(drawn) <= greatest;
        sums.greatest_stretch = std::max(sums.greatest_stretch, static_cast<double>(drawn));
        sums.max = std::max(sums.max, above);
        squares += rest_area * above * above;
        const double capped = std::min(above, 1.0);
        capped_squares += rest_area * capped * capped;
    }
    if (weights > 0.0) {
        sums.rms = std::sqrt(squares / weights);
        sums.capped_rms = std::sqrt(capped_squares / weights);
    }
    return sums;
}

template <class Real>
std::array<Real, 3> StretchLimiting<Real>::corner_masses(std::size_t a) const {
    const Triangle& triangle = topology_->triangles()[a];
    return {inverse_masses_[triangle[0]], inverse_masses_[triangle[1]], inverse_masses_[triangle[2]]};
}

/// What triangle a's ceiling demands beyond its area row; zero where it takes no part.
template <class Real>
ConstraintRow<Real> StretchLimiting<Real>::limited_row(std::size_t a, std::span<const Real> positions,
                                                       const ConstraintRow<Real>& area, const StretchSolve& how) {
    share_[a] = Real(0);
    if (ceilings_[a] == Real(0)) return no_row<Real>();
    const Triangle& triangle = topology_->triangles()[a];
    const Real ceiling = ceilings_[a] + held_excess_[a];
    const ConstraintRow<Real> row = stretch_row(shapes_[a], triangle, positions, rest_areas_[a], ceiling);
    stretch_[a] = ceiling + row.value / rest_areas_[a];
    if (how.small_steps > 0)
        held_excess_[a] = next_held_excess(held_excess_[a], stretch_[a] - ceilings_[a], start_excess_[a], how);
    if (!(stretch_[a] > ceiling - Real(stretch_margin))) return no_row<Real>();
    const std::array<Real, 3> w = corner_masses(a);
    ConstraintRow<Real> limited = orthogonalized(row, area, w);
    const Real left = weighted_product(limited, limited, w), size = weighted_product(row, row, w);
    if (!(left > Real(least_row_share) * size)) return no_row<Real>();
    share_[a] = share_of_other(row, area, w);
    limited.value =
        asked_of_row(Real(excess_taken) * limited.value, std::min(movable_share(row, w) * size, left), size);
    return limited;
}

template <class Real>
void StretchLimiting<Real>::solve(std::span<const Real> positions, std::span<const TriangleGeometry<Real>> geometry,
                                  const TriangleVector<Real>& area_excess, const StretchSolve& how) {
    const std::size_t count = geometry.size();
    for (std::size_t a = 0; a < count; ++a) {
        rows_[a] = area_row(geometry[a], Real(0));
        rows_[a].value = area_excess[static_cast<Eigen::Index>(a)];
        rows_[a].value = asked_of_area_row(rows_[a], rest_areas_[a], corner_masses(a));
        rows_[count + a] = limited_row(a, positions, rows_[a], how);
    }
    system_ = row_system<Real>(*topology_, rows_, owners_, inverse_masses_);
    const SparseMatrix<Real> G = row_matrix<Real>(system_, inverse_masses_);
    const TriangleVector<Real> bound = Real(APSLK_ROWS_BOUND_MARGIN) * row_bound<Real>(system_, inverse_masses_);
    chebyshev<Real>(G, bound, system_.b, how.products, scratch_, y_, one_sided_);
    find_tension(geometry);
}

/// K_i = max(0, Σ μ |∇C_i|² / size) over the rows of the triangles around i: area rows over A, with what stretch rows
/// lend them, and stretch rows as they are before orthogonalization over A⁰ s₁.
template <class Real>
void StretchLimiting<Real>::find_tension(std::span<const TriangleGeometry<Real>> geometry) {
    const std::size_t count = geometry.size();
    const auto multiplier = [&](std::size_t row) {
        const auto n = static_cast<Eigen::Index>(row);
        return system_.scale[n] > Real(0) ? y_[n] / system_.scale[n] : Real(0);
    };
    std::fill(tension_.begin(), tension_.end(), Real(0));
    for (std::size_t a = 0; a < count; ++a) {
        const Real stretch_multiplier = multiplier(count + a);
        const Real area_multiplier = multiplier(a) - share_[a] * stretch_multiplier;
        for (std::size_t k = 0; k < 3; ++k) {
            Real& sum = tension_[topology_->triangles()[a][k]];
            if (geometry[a].area > Real(0))
                sum += area_multiplier * rows_[a].gradients[k].squaredNorm() / geometry[a].area;
            if (stretch_multiplier > Real(0))
                sum += stretch_multiplier *
                       (rows_[count + a].gradients[k] + share_[a] * rows_[a].gradients[k]).squaredNorm() /
                       (rest_areas_[a] * stretch_[a]);
        }
    }
    for (std::size_t i = 0; i < tension_.size(); ++i) {
        // With what is already added the same tension comes out heavier: the fourth root keeps that from running away.
        const Real given = given_inverse_masses_[i];
        tension_[i] = given > Real(0)
                          ? std::max(tension_[i], Real(0)) * std::sqrt(std::sqrt(inverse_masses_[i] / given))
                          : Real(0);
    }
}

/// w', 1/kg, for the stiffness K; `given` is w > 0.
template <class Real>
Real inverse_mass_under_tension(Real given, Real stiffness) {
    if (!(stiffness > Real(0))) return given;
    return std::max(Real(1) / (Real(1) / given + Real(mass_added_per_stiffness) * stiffness),
                    given / Real(APSLK_GREATEST_MASS_RATIO));
}

/// 1/kg, of the displacement: of the masses that were solved with and those that its own tension asks for the greater.
template <class Real>
Real StretchLimiting<Real>::taken_inverse_mass(std::size_t vertex) const {
    const Real given = given_inverse_masses_[vertex];
    if (!(given > Real(0))) return Real(0);
    return std::min(inverse_masses_[vertex], inverse_mass_under_tension(given, tension_[vertex]));
}

template <class Real>
void StretchLimiting<Real>::displacements(bool raises_masses, std::vector<Real>& displacements) const {
    const TriangleVector<Real> sums = system_.J.transpose() * y_;
    displacements.resize(static_cast<std::size_t>(sums.size()));
    for (std::size_t n = 0; n < displacements.size(); ++n) {
        const std::size_t i = n / 3;
        displacements[n] =
            -(raises_masses ? taken_inverse_mass(i) : inverse_masses_[i]) * sums[static_cast<Eigen::Index>(n)];
    }
}

template <class Real>
Real StretchLimiting<Real>::velocity_kept(std::size_t vertex) const {
    const Real given = given_inverse_masses_[vertex];
    return given > Real(0) ? std::min(Real(1), Real(APSLK_AIMED_MASS_RATIO) * taken_inverse_mass(vertex) / given)
                           : Real(1);
}

template <class Real>
void StretchLimiting<Real>::raise_masses() {
    for (std::size_t i = 0; i < stiffness_.size(); ++i) {
        const Real given = given_inverse_masses_[i];
        if (!(given > Real(0))) continue;
        stiffness_[i] = std::max(tension_[i], static_cast<Real>(stiffness_kept) * stiffness_[i]);
        inverse_masses_[i] = inverse_mass_under_tension(given, stiffness_[i]);
    }
}

template <class Real>
std::uint32_t StretchLimiting<Real>::rows_at_work() const {
    std::uint32_t count = 0;
    for (Eigen::Index n = y_.size() / 2; n < y_.size(); ++n) count += y_[n] > Real(0) ? 1u : 0u;
    return count;
}

template <class Real>
std::size_t StretchLimiting<Real>::bytes() const {
    return shapes_.size() * sizeof(shapes_[0]) + rows_.size() * (sizeof(rows_[0]) + sizeof(owners_[0]) + 1) +
           (ceilings_.size() + start_excess_.size() + held_excess_.size() + stretch_.size() + share_.size() +
            inverse_masses_.size() + tension_.size() + stiffness_.size()) *
               sizeof(Real) +
           static_cast<std::size_t>(system_.J.nonZeros()) * (sizeof(Real) + sizeof(int)) +
           5 * static_cast<std::size_t>(y_.size()) * sizeof(Real);
}

template class StretchLimiting<double>;
template class StretchLimiting<float>;

}  // namespace apsl::reference

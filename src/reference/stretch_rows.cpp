// SPDX-License-Identifier: MIT
#include "reference/stretch_rows.hpp"

#include "reference/chebyshev.hpp"

#include <algorithm>
#include <cmath>

namespace apsl::reference {
namespace {

template <class Real>
using Triplets = std::vector<Eigen::Triplet<Real>>;

template <class Real>
TriangleVector<Real> inverse_masses_of_coordinates(std::span<const Real> inverse_masses) {
    TriangleVector<Real> each(static_cast<Eigen::Index>(3 * inverse_masses.size()));
    for (std::size_t n = 0; n < 3 * inverse_masses.size(); ++n)
        each[static_cast<Eigen::Index>(n)] = inverse_masses[n / 3];
    return each;
}

}  // namespace

template <class Real>
RestShape<Real> rest_shape(const Triangle& triangle, std::span<const Real> rest_positions) {
    const Vector3<Real> first = position(rest_positions, triangle[1]) - position(rest_positions, triangle[0]);
    const Vector3<Real> second = position(rest_positions, triangle[2]) - position(rest_positions, triangle[0]);
    RestShape<Real> shape;
    shape.fill(Vector2<Real>::Zero());
    const Vector3<Real> x_axis = first.stableNormalized();
    const Real length = first.norm(), along = second.dot(x_axis), height = (second - along * x_axis).norm();
    if (!(length * height > Real(0))) return shape;
    shape[1] = {Real(1) / length, -along / (length * height)};
    shape[2] = {Real(0), Real(1) / height};
    shape[0] = -(shape[1] + shape[2]);
    return shape;
}

template <class Real>
RestShape<Real> rest_shape(std::span<const Real> rest_shapes, std::size_t triangle) {
    const Real* M = rest_shapes.data() + 4 * triangle;
    const Vector2<Real> first{M[0], M[1]}, second{M[2], M[3]};
    return {-(first + second), first, second};
}

template <class Real>
PrincipalStretch<Real> principal_stretch(const RestShape<Real>& shape, const Triangle& triangle,
                                         std::span<const Real> positions) {
    Eigen::Matrix<Real, 3, 2> F = Eigen::Matrix<Real, 3, 2>::Zero();
    for (std::size_t k = 1; k < 3; ++k)
        F += (position(positions, triangle[k]) - position(positions, triangle[0])) * shape[k].transpose();
    // FᵀF = [p q; q r] in closed form: its eigenvalues are mean ± radius, and twice the angle of v₁ is that of (half,
    // q).
    const Real p = F.col(0).squaredNorm(), q = F.col(0).dot(F.col(1)), r = F.col(1).squaredNorm();
    const Real mean = (p + r) / Real(2), half = (p - r) / Real(2), radius = std::hypot(half, q);
    const Real cosine = radius > Real(0) ? half / radius : Real(1);
    PrincipalStretch<Real> stretch;
    stretch.value = std::sqrt(mean + radius);
    stretch.material = {std::sqrt(std::max(Real(0), (Real(1) + cosine) / Real(2))),
                        std::copysign(std::sqrt(std::max(Real(0), (Real(1) - cosine) / Real(2))), q)};
    stretch.spatial = (F * stretch.material).stableNormalized();
    return stretch;
}

template <class Real>
ConstraintRow<Real> area_row(const TriangleGeometry<Real>& geometry, Real rest_area) {
    ConstraintRow<Real> row{geometry.area - rest_area, geometry.gradients};
    for (Vector3<Real>& gradient : row.gradients) gradient /= Real(2);
    return row;
}

template <class Real>
ConstraintRow<Real> stretch_row(const RestShape<Real>& shape, const Triangle& triangle, std::span<const Real> positions,
                                Real rest_area, Real ceiling) {
    const PrincipalStretch<Real> stretch = principal_stretch(shape, triangle, positions);
    ConstraintRow<Real> row;
    row.value = rest_area * (stretch.value - ceiling);
    for (std::size_t k = 0; k < 3; ++k) row.gradients[k] = rest_area * stretch.material.dot(shape[k]) * stretch.spatial;
    return row;
}

namespace {

/// Σ |∇C_k|² of corners that can move.
template <class Real>
Real movable_squares(const ConstraintRow<Real>& row, const std::array<Real, 3>& inverse_masses) {
    Real sum = Real(0);
    for (std::size_t k = 0; k < 3; ++k)
        if (inverse_masses[k] > Real(0)) sum += row.gradients[k].squaredNorm();
    return sum;
}

}  // namespace

template <class Real>
Real movable_share(const ConstraintRow<Real>& row, const std::array<Real, 3>& inverse_masses) {
    const Real all = movable_squares<Real>(row, {Real(1), Real(1), Real(1)});
    return all > Real(0) ? movable_squares(row, inverse_masses) / all : Real(0);
}

template <class Real>
Real asked_of_area_row(const ConstraintRow<Real>& row, Real rest_area, const std::array<Real, 3>& inverse_masses) {
    const bool all_move = std::all_of(inverse_masses.begin(), inverse_masses.end(), [](Real w) { return w > Real(0); });
    if (all_move || !(rest_area > Real(0))) return row.value;
    const Real share =
        std::min(movable_squares(row, inverse_masses) / (Real(APSLK_WEAK_AREA_ROW_SHARE) * rest_area), Real(1));
    return share * share * row.value;
}

template <class Real>
Real weighted_product(const ConstraintRow<Real>& a, const ConstraintRow<Real>& b,
                      const std::array<Real, 3>& inverse_masses) {
    Real sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += inverse_masses[k] * a.gradients[k].dot(b.gradients[k]);
    return sum;
}

template <class Real>
Real share_of_other(const ConstraintRow<Real>& row, const ConstraintRow<Real>& other,
                    const std::array<Real, 3>& inverse_masses) {
    const Real length = weighted_product(other, other, inverse_masses);
    return length > Real(0) ? weighted_product(row, other, inverse_masses) / length : Real(0);
}

template <class Real>
ConstraintRow<Real> orthogonalized(const ConstraintRow<Real>& row, const ConstraintRow<Real>& other,
                                   const std::array<Real, 3>& inverse_masses) {
    const Real share = share_of_other(row, other, inverse_masses);
    ConstraintRow<Real> result = row;
    result.value -= share * other.value;
    for (std::size_t k = 0; k < 3; ++k) result.gradients[k] -= share * other.gradients[k];
    return result;
}

template <class Real>
RowSystem<Real> row_system(const Topology& topology, std::span<const ConstraintRow<Real>> rows,
                           std::span<const std::uint32_t> owners, std::span<const Real> inverse_masses) {
    const auto row_count = static_cast<Eigen::Index>(rows.size());
    RowSystem<Real> system;
    system.J.resize(row_count, static_cast<Eigen::Index>(3 * topology.vertex_count()));
    system.b = TriangleVector<Real>::Zero(row_count);
    system.scale = TriangleVector<Real>::Zero(row_count);
    Triplets<Real> entries;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const Triangle& triangle = topology.triangles()[owners[r]];
        const std::array<Real, 3> w{inverse_masses[triangle[0]], inverse_masses[triangle[1]],
                                    inverse_masses[triangle[2]]};
        const Real scale = std::sqrt(weighted_product(rows[r], rows[r], w));
        if (!(scale > Real(0))) continue;
        const auto n = static_cast<Eigen::Index>(r);
        system.scale[n] = scale;
        system.b[n] = rows[r].value / scale;
        for (std::size_t k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                entries.emplace_back(static_cast<int>(r), static_cast<int>(3 * triangle[k]) + axis,
                                     rows[r].gradients[k][axis] / scale);
    }
    system.J.setFromTriplets(entries.begin(), entries.end());
    return system;
}

template <class Real>
SparseMatrix<Real> row_matrix(const RowSystem<Real>& system, std::span<const Real> inverse_masses) {
    const SparseMatrix<Real> weighted = system.J * inverse_masses_of_coordinates(inverse_masses).asDiagonal();
    return weighted * SparseMatrix<Real>(system.J.transpose());
}

template <class Real>
TriangleVector<Real> row_bound(const RowSystem<Real>& system, std::span<const Real> inverse_masses) {
    std::vector<Eigen::Matrix<Real, 3, 3>> around(inverse_masses.size(), Eigen::Matrix<Real, 3, 3>::Zero());
    // The entries of a row come three a vertex.
    const auto each_vertex_of = [&](Eigen::Index row, const auto& use) {
        for (typename SparseMatrix<Real>::InnerIterator entry(system.J, row); entry;) {
            const auto vertex = static_cast<std::size_t>(entry.col()) / 3;
            Vector3<Real> gradient;
            for (int axis = 0; axis < 3; ++axis, ++entry) gradient[axis] = entry.value();
            use(vertex, gradient);
        }
    };
    for (Eigen::Index r = 0; r < system.J.rows(); ++r)
        each_vertex_of(r, [&](std::size_t i, const Vector3<Real>& gradient) {
            const Vector3<Real> direction = gradient.stableNormalized();
            around[i] += direction * direction.transpose();
        });
    std::vector<Real> greatest(around.size());
    std::transform(around.begin(), around.end(), greatest.begin(), greatest_eigenvalue<Real>);
    TriangleVector<Real> bound = TriangleVector<Real>::Zero(system.J.rows());
    for (Eigen::Index r = 0; r < system.J.rows(); ++r)
        each_vertex_of(r, [&](std::size_t i, const Vector3<Real>& gradient) {
            bound[r] += greatest[i] * inverse_masses[i] * gradient.squaredNorm();
        });
    return bound;
}

#define APSL_INSTANTIATE(Real)                                                                                         \
    template RestShape<Real> rest_shape(std::span<const Real>, std::size_t);                                           \
    template Real weighted_product(const ConstraintRow<Real>&, const ConstraintRow<Real>&,                             \
                                   const std::array<Real, 3>&);                                                        \
    template Real movable_share(const ConstraintRow<Real>&, const std::array<Real, 3>&);                               \
    template Real asked_of_area_row(const ConstraintRow<Real>&, Real, const std::array<Real, 3>&);                     \
    template Real share_of_other(const ConstraintRow<Real>&, const ConstraintRow<Real>&, const std::array<Real, 3>&);  \
    template RestShape<Real> rest_shape(const Triangle&, std::span<const Real>);                                       \
    template PrincipalStretch<Real> principal_stretch(const RestShape<Real>&, const Triangle&, std::span<const Real>); \
    template ConstraintRow<Real> area_row(const TriangleGeometry<Real>&, Real);                                        \
    template ConstraintRow<Real> stretch_row(const RestShape<Real>&, const Triangle&, std::span<const Real>, Real,     \
                                             Real);                                                                    \
    template ConstraintRow<Real> orthogonalized(const ConstraintRow<Real>&, const ConstraintRow<Real>&,                \
                                                const std::array<Real, 3>&);                                           \
    template RowSystem<Real> row_system(const Topology&, std::span<const ConstraintRow<Real>>,                         \
                                        std::span<const std::uint32_t>, std::span<const Real>);                        \
    template SparseMatrix<Real> row_matrix(const RowSystem<Real>&, std::span<const Real>);                             \
    template TriangleVector<Real> row_bound(const RowSystem<Real>&, std::span<const Real>);
APSL_INSTANTIATE(double)
APSL_INSTANTIATE(float)
#undef APSL_INSTANTIATE

}  // namespace apsl::reference

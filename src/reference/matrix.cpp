// SPDX-License-Identifier: MIT
#include "reference/matrix.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace apsl::reference {
namespace {

/// Corner of the column's triangle that corner k of the row's triangle meets, 3 for none (CsrPattern::shared).
unsigned met_corner(std::uint8_t shared, unsigned k) {
    return (shared >> (2 * k)) & 3u;
}

/// Calls entry_value(a, c, shared code) for every entry of the matrix and stores what it returns.
template <class Real, class EntryValue>
void fill(std::span<const std::uint8_t> shared, SparseMatrix<Real>& G, EntryValue entry_value) {
    const int* row_offsets = G.outerIndexPtr();
    const int* columns = G.innerIndexPtr();
    Real* values = G.valuePtr();
    for (int a = 0; a < G.rows(); ++a)
        for (int e = row_offsets[a]; e < row_offsets[a + 1]; ++e)
            values[e] = entry_value(static_cast<std::size_t>(a), static_cast<std::size_t>(columns[e]), shared[e]);
}

}  // namespace

template <class Real>
SparseMatrix<Real> zero_matrix(const CsrPattern& pattern) {
    const std::size_t entries = pattern.columns.size();
    if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw Error(ErrorCode::invalid_mesh, "the matrix has " + std::to_string(entries) +
                                                 " entries, expected at most " +
                                                 std::to_string(std::numeric_limits<int>::max()) + " in the reference");
    const auto triangle_count = static_cast<Eigen::Index>(pattern.row_offsets.size()) - 1;
    SparseMatrix<Real> G(triangle_count, triangle_count);
    G.resizeNonZeros(static_cast<Eigen::Index>(entries));
    std::copy(pattern.row_offsets.begin(), pattern.row_offsets.end(), G.outerIndexPtr());
    std::copy(pattern.columns.begin(), pattern.columns.end(), G.innerIndexPtr());
    std::fill_n(G.valuePtr(), entries, Real(0));
    return G;
}

template <class Real>
void consistent_matrix(const Topology& topology, std::span<const std::uint8_t> shared,
                       std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> inverse_masses,
                       SparseMatrix<Real>& G) {
    fill(shared, G, [&](std::size_t a, std::size_t c, std::uint8_t code) {
        Real sum = 0;
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned m = met_corner(code, k);
            if (m == 3) continue;
            const Real w = inverse_masses[topology.triangles()[a][k]];
            sum += w * geometry[a].gradients[k].dot(geometry[c].gradients[m]);
        }
        return Real(0.5) * sum;
    });
}

template <class Real>
void printed_matrix(const Topology& topology, std::span<const std::uint8_t> shared,
                    std::span<const TriangleGeometry<Real>> geometry, std::span<const Real> inverse_masses,
                    SparseMatrix<Real>& G) {
    fill(shared, G, [&](std::size_t a, std::size_t c, std::uint8_t code) {
        Real sum = 0;
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned m = met_corner(code, k);
            if (m == 3) continue;
            const Real w = std::sqrt(inverse_masses[topology.triangles()[a][k]]) *
                           std::sqrt(inverse_masses[topology.triangles()[c][m]]);
            sum += w * geometry[a].gradients[k].squaredNorm();  // |g_{a,i}| = |e_i|
        }
        return Real(0.5) * sum * geometry[a].normal.dot(geometry[c].normal);
    });
}

template <class Real>
SparseMatrix<Real> pressure_matrix(Matrix matrix, const Topology& topology,
                                   std::span<const TriangleGeometry<Real>> geometry,
                                   std::span<const Real> inverse_masses) {
    const CsrPattern pattern = topology.csr_pattern(matrix);
    SparseMatrix<Real> G = zero_matrix<Real>(pattern);
    if (matrix == Matrix::consistent)
        consistent_matrix<Real>(topology, pattern.shared, geometry, inverse_masses, G);
    else
        printed_matrix<Real>(topology, pattern.shared, geometry, inverse_masses, G);
    return G;
}

template <class Real>
void regularize(Real alpha, SparseMatrix<Real>& G) {
    for (Eigen::Index a = 0; a < G.rows(); ++a) G.coeffRef(a, a) *= alpha;
}

template <class Real>
void regularize(std::span<const Real> alpha, SparseMatrix<Real>& G) {
    for (Eigen::Index a = 0; a < G.rows(); ++a) G.coeffRef(a, a) *= alpha[a];
}

template SparseMatrix<double> zero_matrix(const CsrPattern&);
template SparseMatrix<float> zero_matrix(const CsrPattern&);
template void consistent_matrix(const Topology&, std::span<const std::uint8_t>,
                                std::span<const TriangleGeometry<double>>, std::span<const double>,
                                SparseMatrix<double>&);
template void consistent_matrix(const Topology&, std::span<const std::uint8_t>,
                                std::span<const TriangleGeometry<float>>, std::span<const float>, SparseMatrix<float>&);
template void printed_matrix(const Topology&, std::span<const std::uint8_t>, std::span<const TriangleGeometry<double>>,
                             std::span<const double>, SparseMatrix<double>&);
template void printed_matrix(const Topology&, std::span<const std::uint8_t>, std::span<const TriangleGeometry<float>>,
                             std::span<const float>, SparseMatrix<float>&);
template SparseMatrix<double> pressure_matrix(Matrix, const Topology&, std::span<const TriangleGeometry<double>>,
                                              std::span<const double>);
template SparseMatrix<float> pressure_matrix(Matrix, const Topology&, std::span<const TriangleGeometry<float>>,
                                             std::span<const float>);
template void regularize(double, SparseMatrix<double>&);
template void regularize(float, SparseMatrix<float>&);
template void regularize(std::span<const double>, SparseMatrix<double>&);
template void regularize(std::span<const float>, SparseMatrix<float>&);

}  // namespace apsl::reference

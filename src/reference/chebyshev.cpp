// SPDX-License-Identifier: MIT
#include "reference/chebyshev.hpp"

#include "finite.hpp"

#include <apsl/topology.hpp>

#include <algorithm>
#include <cmath>

namespace apsl::reference {

template <class Real>
Real greatest_eigenvalue(const Eigen::Matrix<Real, 3, 3>& M) {
    const Real scale = M.trace();
    if (!(scale > Real(0))) return Real(0);
    Eigen::Matrix<Real, 3, 3> power = M / scale;
    for (int n = 0; n < 4; ++n) power = (power * power).eval();
    return scale * std::pow(power.squaredNorm(), Real(1) / Real(32));
}

template <class Real>
void vertex_bounds(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                   std::vector<Real>& bounds) {
    const auto triangles = topology.triangles();
    std::vector<Eigen::Matrix<Real, 3, 3>> around(topology.vertex_count(), Eigen::Matrix<Real, 3, 3>::Zero());
    std::vector<Real> unknown(around.size(), Real(0));
    for (std::size_t a = 0; a < triangles.size(); ++a)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = triangles[a][k];
            const Vector3<Real> direction = geometry[a].gradients[k].stableNormalized();
            if (direction.squaredNorm() > Real(0))
                around[i] += direction * direction.transpose();
            else
                unknown[i] += Real(1);
        }
    bounds.resize(around.size());
    for (std::size_t i = 0; i < around.size(); ++i) bounds[i] = greatest_eigenvalue(around[i]) + unknown[i];
}

template <class Real>
void diagonal_bound(const Topology& topology, std::span<const TriangleGeometry<Real>> geometry,
                    std::span<const Real> inverse_masses, std::span<const Real> vertex_bounds,
                    TriangleVector<Real>& bound) {
    const auto triangles = topology.triangles();
    bound.resize(static_cast<Eigen::Index>(triangles.size()));
    for (std::size_t a = 0; a < triangles.size(); ++a) {
        Real sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = triangles[a][k];
            sum += vertex_bounds[i] * Real(0.5) * inverse_masses[i] * geometry[a].gradients[k].squaredNorm();
        }
        bound[static_cast<Eigen::Index>(a)] = sum;
    }
}

template <class Real>
void chebyshev(const SparseMatrix<Real>& G, const TriangleVector<Real>& bound, const TriangleVector<Real>& b,
               int products, ChebyshevScratch<Real>& scratch, TriangleVector<Real>& lambda,
               std::span<const std::uint8_t> one_sided, bool from_lambda) {
    auto& [inverse_bound, r, step, product] = scratch;
    inverse_bound = bound.cwiseInverse();
    for (Real& inverse : inverse_bound)
        if (!is_finite(inverse)) inverse = Real(0);

    // T_d(σ) = 3 at x = 0; the polynomial swings between ±1/3 from x = low to x = 1.
    const Real sigma = std::cosh(std::acosh(Real(3)) / static_cast<Real>(products + 1));
    const Real low = (sigma - Real(1)) / (sigma + Real(1));
    const Real centre = (Real(1) + low) / Real(2), half_width = (Real(1) - low) / Real(2);
    Real rho = Real(1) / sigma;
    r = b;
    if (from_lambda) {
        product.noalias() = G * lambda;
        r -= product;
    } else {
        lambda = TriangleVector<Real>::Zero(b.size());
    }
    const auto clamp_step = [&] {
        for (std::size_t a = 0; a < one_sided.size(); ++a) {
            const auto n = static_cast<Eigen::Index>(a);
            if (one_sided[a] != 0 && lambda[n] + step[n] < Real(0)) step[n] = -lambda[n];
        }
    };
    step = inverse_bound.cwiseProduct(r) / centre;
    clamp_step();
    lambda += step;
    for (int k = 0; k < products; ++k) {
        product.noalias() = G * step;
        r -= product;
        const Real next = Real(1) / (Real(2) * sigma - rho);
        step = (next * rho) * step + (Real(2) * next / half_width) * inverse_bound.cwiseProduct(r);
        clamp_step();
        lambda += step;
        rho = next;
    }
}

template double greatest_eigenvalue(const Eigen::Matrix<double, 3, 3>&);
template float greatest_eigenvalue(const Eigen::Matrix<float, 3, 3>&);
template void vertex_bounds(const Topology&, std::span<const TriangleGeometry<double>>, std::vector<double>&);
template void vertex_bounds(const Topology&, std::span<const TriangleGeometry<float>>, std::vector<float>&);
template void diagonal_bound(const Topology&, std::span<const TriangleGeometry<double>>, std::span<const double>,
                             std::span<const double>, TriangleVector<double>&);
template void diagonal_bound(const Topology&, std::span<const TriangleGeometry<float>>, std::span<const float>,
                             std::span<const float>, TriangleVector<float>&);
template void chebyshev(const SparseMatrix<double>&, const TriangleVector<double>&, const TriangleVector<double>&, int,
                        ChebyshevScratch<double>&, TriangleVector<double>&, std::span<const std::uint8_t>, bool);
template void chebyshev(const SparseMatrix<float>&, const TriangleVector<float>&, const TriangleVector<float>&, int,
                        ChebyshevScratch<float>&, TriangleVector<float>&, std::span<const std::uint8_t>, bool);

}  // namespace apsl::reference

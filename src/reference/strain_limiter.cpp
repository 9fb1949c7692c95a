// SPDX-License-Identifier: MIT
//
// Algorithm 1: predict, solve for the pressures, displace, repeat; only the corrections go into the velocities.

#include "reference/adaptive_regularization.hpp"
#include "reference/area_change.hpp"
#include "reference/check.hpp"
#include "reference/conjugate_gradient.hpp"
#include "reference/displacements.hpp"
#include "reference/geometry.hpp"
#include "reference/matrix.hpp"
#include "reference/scheduled_regularization.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace apsl::reference {
namespace {

template <class Real>
void check(const Topology& topology, const Buffers<Real>& buffers) {
    check_size("positions", buffers.positions.size(), 3 * topology.vertex_count());
    check_size("velocities", buffers.velocities.size(), 3 * topology.vertex_count());
    check_size("inverse_masses", buffers.inverse_masses.size(), topology.vertex_count());
    check_size("rest_areas", buffers.rest_areas.size(), topology.triangle_count());
    if (!buffers.regularization.empty())
        check_size("regularization", buffers.regularization.size(), topology.triangle_count());
    check_values("inverse_masses", "vertex", buffers.inverse_masses, "a finite number >= 0 (1/kg)",
                 [](Real w) { return w >= Real(0); });
    check_values("rest_areas", "triangle", buffers.rest_areas, "a finite number > 0 (m2)",
                 [](Real area) { return area > Real(0); });
    check_values("regularization", "triangle", buffers.regularization, "a finite number >= 1",
                 [](Real alpha) { return alpha >= Real(1); });
}

template <class Real>
bool all_finite(std::span<const Real> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](Real number) { return std::isfinite(number); });
}

template <class Range>
std::size_t bytes(const Range& range) {
    return static_cast<std::size_t>(range.size()) * sizeof(*range.data());
}

}  // namespace

template <class Real>
struct BasicStrainLimiter<Real>::Implementation {
    std::shared_ptr<const Topology> topology;
    Matrix matrix;
    std::vector<std::uint8_t> shared;  // CsrPattern::shared; its offsets and columns live on in G
    SparseMatrix<Real> G;

    std::vector<Real> predicted;  // x̃ + Δt ṽ
    std::vector<Real> moved;      // x_j, corrected sub-step by sub-step
    std::vector<Real> correction;
    std::vector<TriangleGeometry<Real>> geometry;
    TriangleVector<Real> area_excess;  // b = A − A⁰
    TriangleVector<Real> lambda;
    std::vector<Real> effective_regularization;  // α, [T]
    Real adaptive_factor = Real(1);              // outlives the call
    std::vector<TriangleVector<Real>> kept;      // √(α D) λ of the sub-steps of the call before
    ConjugateGradientScratch<Real> scratch;
    Stats stats{};

    void predict(const Buffers<Real>& buffers, Real time_step) {
        predicted.resize(buffers.positions.size());
        for (std::size_t n = 0; n < predicted.size(); ++n)
            predicted[n] = buffers.positions[n] + time_step * buffers.velocities[n];
        moved = predicted;
    }

    /// One solve of (G + (α − 1) diag G) λ = b at the present geometry; λ is left in `lambda`.
    SolveResult<Real> solve(const Buffers<Real>& buffers, const Parameters& parameters) {
        const std::span<const TriangleGeometry<Real>> triangles = geometry;
        if (matrix == Matrix::consistent)
            consistent_matrix(*topology, shared, triangles, buffers.inverse_masses, G);
        else
            printed_matrix(*topology, shared, triangles, buffers.inverse_masses, G);
        effective_regularization.resize(geometry.size());
        for (std::size_t a = 0; a < geometry.size(); ++a) {
            const Real given = buffers.regularization.empty() ? static_cast<Real>(parameters.regularization)
                                                              : buffers.regularization[a];
            effective_regularization[a] =
                raised_regularization(scheduled_regularization(given, parameters, stats.sub_steps), adaptive_factor);
        }
        regularize(std::span<const Real>(effective_regularization), G);

        area_excess.resize(static_cast<Eigen::Index>(geometry.size()));
        for (std::size_t a = 0; a < geometry.size(); ++a) area_excess[a] = geometry[a].area - buffers.rest_areas[a];
        const auto tolerance = static_cast<Real>(parameters.tolerance);
        if (kept.empty())
            return conjugate_gradient(G, area_excess, tolerance, parameters.max_iterations, scratch, lambda);

        TriangleVector<Real>& guess = kept[std::min(static_cast<std::size_t>(stats.sub_steps), kept.size() - 1)];
        const TriangleVector<Real> scale = G.diagonal().cwiseSqrt();
        lambda = (scale.array() > Real(0)).select(guess.cwiseQuotient(scale), Real(0));
        SolveResult<Real> result =
            conjugate_gradient(G, area_excess, tolerance, parameters.max_iterations, scratch, lambda, true);
        guess = scale.cwiseProduct(lambda);
        return result;
    }

    void displace(std::span<const Real> inverse_masses) {
        displacements<Real>(*topology, geometry, inverse_masses, {lambda.data(), geometry.size()}, correction);
        for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += correction[n];
    }

    /// ṽ + (x_j − (x̃ + Δt ṽ)) / Δt into `correction`; false where a number is not finite. Velocities of pinned vertices
    /// are copied, not computed, so that they keep every bit.
    bool filtered_velocities(const Buffers<Real>& buffers, Real time_step) {
        correction.resize(moved.size());
        for (std::size_t n = 0; n < moved.size(); ++n) {
            correction[n] = buffers.velocities[n];
            if (buffers.inverse_masses[n / 3] > Real(0)) correction[n] += (moved[n] - predicted[n]) / time_step;
        }
        return all_finite<Real>(correction);
    }

    /// Leaves the outcome in `stats`; what is not finite ends it as diverged, with the last finite area change.
    void filter(const Buffers<Real>& buffers, const Parameters& parameters) {
        const Real time_step = parameters.time_step;
        stats = {};
        stats.status = Status::diverged;
        if (!all_finite(buffers.positions) || !all_finite<Real>(buffers.velocities)) return;

        bool all_converged = true;
        predict(buffers, time_step);
        for (;;) {
            triangle_geometries<Real>(*topology, moved, geometry);
            const AreaChange change = area_change<Real>(geometry, buffers.rest_areas);
            if (!change.finite) return;
            stats.max_area_change = static_cast<float>(change.max);
            stats.rms_area_change = static_cast<float>(change.rms);
            if (stats.sub_steps == parameters.sub_steps) break;
            if (change.max <= static_cast<double>(parameters.target_area_change)) break;

            const SolveResult<Real> result = solve(buffers, parameters);
            if (!std::isfinite(result.relative_residual)) return;
            displace(buffers.inverse_masses);
            ++stats.sub_steps;
            stats.cg_iterations +=
                result.iterations + (kept.empty() ? 0 : 1);  // the product with a guess costs as much
            stats.residual = std::max(stats.residual, static_cast<float>(result.relative_residual));
            all_converged = all_converged && result.converged;
            adaptive_factor = adapted_factor(adaptive_factor, parameters, result.iterations, result.converged);
        }
        // Without a sub-step there is nothing to add, not even a zero: −0 + 0 would lose its sign.
        if (stats.sub_steps > 0) {
            if (!filtered_velocities(buffers, time_step)) return;
            std::copy(correction.begin(), correction.end(), buffers.velocities.begin());
        }
        stats.status = all_converged ? Status::ok : Status::not_converged;
    }
};

template <class Real>
BasicStrainLimiter<Real>::BasicStrainLimiter(std::shared_ptr<const Topology> topology, Matrix matrix,
                                             std::uint32_t kept_pressures)
    : implementation_(std::make_unique<Implementation>()) {
    if (!topology) throw Error(ErrorCode::invalid_argument, "topology is null, expected one from Topology::build");
    if (matrix != Matrix::consistent && matrix != Matrix::printed)
        throw Error(ErrorCode::invalid_argument, "matrix is " + std::to_string(static_cast<int>(matrix)) +
                                                     ", expected consistent (0) or printed (1)");
    CsrPattern pattern = topology->csr_pattern(matrix);
    implementation_->topology = std::move(topology);
    implementation_->matrix = matrix;
    implementation_->kept.assign(
        kept_pressures,
        TriangleVector<Real>::Zero(static_cast<Eigen::Index>(implementation_->topology->triangle_count())));
    implementation_->G = zero_matrix<Real>(pattern);
    implementation_->shared = std::move(pattern.shared);
}

template <class Real>
BasicStrainLimiter<Real>::~BasicStrainLimiter() = default;
template <class Real>
BasicStrainLimiter<Real>::BasicStrainLimiter(BasicStrainLimiter&&) noexcept = default;
template <class Real>
BasicStrainLimiter<Real>& BasicStrainLimiter<Real>::operator=(BasicStrainLimiter&&) noexcept = default;

template <class Real>
std::size_t BasicStrainLimiter<Real>::scratch_bytes() const {
    const Implementation& i = *implementation_;
    const auto entries = static_cast<std::size_t>(i.G.nonZeros());
    const auto rows = static_cast<std::size_t>(i.G.rows());
    return entries * (sizeof(Real) + sizeof(int)) + (rows + 1) * sizeof(int) + bytes(i.shared) + bytes(i.predicted) +
           bytes(i.moved) + bytes(i.correction) + bytes(i.geometry) + bytes(i.area_excess) + bytes(i.lambda) +
           bytes(i.effective_regularization) + i.kept.size() * static_cast<std::size_t>(rows) * sizeof(Real) +
           bytes(i.scratch.inverse_diagonal) + bytes(i.scratch.residual) + bytes(i.scratch.preconditioned) +
           bytes(i.scratch.direction) + bytes(i.scratch.product);
}

template <class Real>
void BasicStrainLimiter<Real>::enqueue(const Buffers<Real>& buffers, const Parameters& parameters) {
    validate(parameters);
    check(*implementation_->topology, buffers);
    implementation_->filter(buffers, parameters);
}

template <class Real>
Stats BasicStrainLimiter<Real>::read_stats() const {
    return implementation_->stats;
}

template class BasicStrainLimiter<double>;
template class BasicStrainLimiter<float>;

}  // namespace apsl::reference

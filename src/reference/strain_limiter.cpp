// SPDX-License-Identifier: MIT
//
// Algorithm 1: predict, solve for the pressures, displace, repeat; only the corrections go into the velocities.

#include "finite.hpp"
#include "reference/accept_or_reject.hpp"
#include "reference/adaptive_regularization.hpp"
#include "reference/area_change.hpp"
#include "reference/bending.hpp"
#include "reference/chebyshev.hpp"
#include "reference/check_buffers.hpp"
#include "reference/conjugate_gradient.hpp"
#include "reference/contact.hpp"
#include "reference/displacements.hpp"
#include "reference/effective_masses.hpp"
#include "reference/energy_bound.hpp"
#include "reference/free_motion.hpp"
#include "reference/geometry.hpp"
#include "reference/matrix.hpp"
#include "reference/stretch_limiting.hpp"
#include "reference/tethers.hpp"
#include "reference/worst_miss.hpp"

#include "chebyshev_products.hpp"
#include "fields.hpp"
#include "resolved_parameters.hpp"
#include "scheduled_regularization.hpp"
#include "stepping.hpp"

#include <apsl/error.hpp>
#include <apsl/reference.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace apsl::reference {
namespace {

template <class Real>
bool all_finite(std::span<const Real> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](Real number) { return is_finite(number); });
}

/// The first vertex with a number that is not finite, or the count of vertices.
template <class Real>
std::size_t first_bad_vertex(std::span<const Real> coordinates) {
    std::size_t n = 0;
    while (n < coordinates.size() && is_finite(coordinates[n])) ++n;
    return n / 3;
}

template <class Range>
std::size_t bytes(const Range& range) {
    return static_cast<std::size_t>(range.size()) * sizeof(*range.data());
}

}  // namespace

template <class Real>
struct BasicStrainLimiter<Real>::Implementation {
    std::shared_ptr<const Topology> topology;
    Options options;
    int bound_interval = 1;
    std::vector<std::uint8_t> shared;  // CsrPattern::shared; its offsets and columns live on in G
    SparseMatrix<Real> G;

    std::vector<Real> predicted;         // x̃ + Δt ṽ, outside of what is touched
    std::vector<Real> unlimited;         // m/s, velocities where nothing is limited
    std::vector<Real> moved;             // x_j, corrected sub-step by sub-step
    std::vector<Real> motion;            // Δt times the velocity, in small steps with the corrections so far
    std::vector<Real> before_forces;     // the motion, less what acceleration and damping made of it in a part
    std::vector<Real> total_correction;  // what the corrections so far add to the end of the step
    std::vector<Real> correction;
    std::vector<TriangleGeometry<Real>> geometry;
    EffectiveMasses<Real> masses;
    TriangleVector<Real> start_error;  // A(x̃) − A⁰, only in small steps
    TriangleVector<Real> area_excess;  // b
    TriangleVector<Real> lambda;
    std::vector<Real> effective_regularization;  // α, [T]
    Real adaptive_factor = Real(1);              // outlives the call
    float asked_sub_steps = 0.0f;                // by the tension of the calls before
    std::vector<TriangleVector<Real>> kept;      // √(α D) λ of the sub-steps of the call before
    ConjugateGradientScratch<Real> scratch;
    std::vector<Real> direction_bounds;  // s, [V]
    TriangleVector<Real> bound;          // B with its margin, [T]
    ChebyshevScratch<Real> chebyshev_scratch;
    StretchLimiting<Real> stretches;  ///< with Options::limits_stretch
    Bending<Real> bending;            ///< with Options::bends
    EnergyBound<Real> energy;         ///< with Options::integrates
    double bending_energy = 0.0;      ///< J, of hinges at the start of the step
    Stats stats{};

    void predict(const Buffers<Real>& buffers, const ResolvedParameters& parameters) {
        const auto time_step = static_cast<Real>(parameters.time_step);
        const FreeStep<Real> free(parameters, buffers.accelerations);
        predicted.resize(buffers.positions.size());
        for (std::size_t n = 0; n < predicted.size(); ++n)
            predicted[n] =
                buffers.positions[n] + time_step * free.mean(buffers.velocities[n], n, buffers.inverse_masses);
        if (options.integrates || options.keeps_contacts) {
            unlimited.resize(predicted.size());
            for (std::size_t n = 0; n < unlimited.size(); ++n)
                unlimited[n] = free.end(buffers.velocities[n], n, buffers.inverse_masses);
        }
        if (options.integrates) energy = EnergyBound<Real>(buffers, {predicted, unlimited, time_step});
        if (options.keeps_contacts)
            for (std::size_t i = 0; i < buffers.inverse_masses.size(); ++i)
                if (buffers.inverse_masses[i] > Real(0)) keep_end(i, buffers, time_step);
        moved = predicted;
        total_correction.assign(predicted.size(), Real(0));
    }

    /// The free end of vertex i's step, outside of what it touches. Of a filter the end is where the velocity leads.
    void keep_end(std::size_t i, const Buffers<Real>& buffers, Real time_step) {
        Eigen::Map<Vector3<Real>> x(predicted.data() + 3 * i), velocity(unlimited.data() + 3 * i);
        MovingVertex<Real> end{x, time_step * velocity, x - position(buffers.positions, i)};
        if (!end.keep(Contact<Real>(buffers.contacts, i), time_step, Real(0), Real(1))) return;
        velocity = options.integrates ? Vector3<Real>(end.motion / time_step)
                                      : Vector3<Real>(velocity + (end.position - x) / time_step);
        x = end.position;
    }

    /// Geometry at x_j. A triangle without a rest area gets no gradients: nothing moves for it.
    AreaChange measure(const Buffers<Real>& buffers) {
        triangle_geometries<Real>(*topology, moved, geometry);
        for (std::size_t a = 0; a < geometry.size(); ++a)
            if (buffers.rest_areas[a] == Real(0))
                for (Vector3<Real>& gradient : geometry[a].gradients) gradient.setZero();
        return area_change<Real>(geometry, buffers.rest_areas);
    }

    /// Whether there is more in small steps than limits: where nothing is to be limited there still is this.
    bool acts_in_parts() const { return options.bends || options.tethers_per_vertex > 0; }

    /// At x_j.
    Standing standing(const Buffers<Real>& buffers) {
        Standing state{measure(buffers), {}};
        if (options.limits_stretch) state.stretches = stretches.measure(moved);
        return state;
    }

    /// What the areas are off by at the start of the step, and the first of its parts.
    Standing start_small_steps(const Buffers<Real>& buffers, const ResolvedParameters& parameters) {
        const auto time_step = static_cast<Real>(parameters.time_step);
        std::copy(buffers.positions.begin(), buffers.positions.end(), moved.begin());
        const Standing at_start = standing(buffers);
        if (!at_start.finite()) return at_start;
        start_error = area_errors(buffers);
        if (options.limits_stretch) stretches.hold_excess(moved);
        motion.resize(moved.size());
        for (std::size_t n = 0; n < moved.size(); ++n) motion[n] = time_step * buffers.velocities[n];
        begin_part(buffers, parameters, 0);
        bending_energy = bending.energy();
        return standing(buffers);
    }

    /// The forces of small step `part` change the velocities, tethers keep what they lead to within reach, and they
    /// move x_j on.
    void begin_part(const Buffers<Real>& buffers, const ResolvedParameters& parameters, int part) {
        const auto time_step = static_cast<Real>(parameters.time_step),
                   parts = static_cast<Real>(parameters.small_steps);
        const FreePart<Real> free(parameters, buffers.accelerations);
        if (options.integrates)
            for (std::size_t n = 0; n < moved.size(); ++n)
                motion[n] = time_step * free(motion[n] / time_step, n, buffers.inverse_masses);
        if (options.tethers_per_vertex > 0)
            keep_within_reach(buffers, {Real(1) / parts, static_cast<Real>(part + 1) / parts * time_step, time_step});
        if (options.bends) {
            before_forces.resize(motion.size());
            for (std::size_t n = 0; n < motion.size(); ++n)
                before_forces[n] = time_step * free.before(motion[n] / time_step, n, buffers.inverse_masses);
            bending.find_velocity_changes(moved, before_forces, parameters);
            for (std::size_t n = 0; n < motion.size(); ++n) motion[n] += time_step * bending.velocity_changes()[n];
        }
        for (std::size_t n = 0; n < moved.size(); ++n) moved[n] += motion[n] / parts;
    }

    void keep_within_reach(const Buffers<Real>& buffers, const Move<Real>& move) {
        for (std::size_t i = 0; i < buffers.inverse_masses.size(); ++i) {
            if (!(buffers.inverse_masses[i] > Real(0))) continue;
            const Eigen::Map<Vector3<Real>> x(moved.data() + 3 * i);
            Eigen::Map<Vector3<Real>> step(motion.data() + 3 * i);
            step = within_reach<Real>(x, step, move, holds(move, buffers, options.tethers_per_vertex, i));
        }
    }

    /// A − A⁰ at the present geometry; 0 where there is no rest area.
    TriangleVector<Real> area_errors(const Buffers<Real>& buffers) const {
        TriangleVector<Real> errors(static_cast<Eigen::Index>(geometry.size()));
        for (std::size_t a = 0; a < geometry.size(); ++a)
            errors[a] = buffers.rest_areas[a] == Real(0) ? Real(0) : geometry[a].area - buffers.rest_areas[a];
        return errors;
    }

    /// b at the present geometry, in sub-step stats.sub_steps of small steps of `parts` parts: what is left of the
    /// start's error stays for now, and no triangle is asked for more growth than a linearised step can give it.
    void find_excess(const Buffers<Real>& buffers, int parts) {
        area_excess = area_errors(buffers);
        if (parts == 0) return;
        area_excess -=
            static_cast<Real>(start_error_left(stats.sub_steps, parts, options.limits_stretch)) * start_error;
        for (std::size_t a = 0; a < geometry.size(); ++a)
            area_excess[a] = std::max(area_excess[a], Real(1 - greatest_growth) * geometry[a].area);
    }

    /// The bounds that the matrix is scaled by, of the present geometry.
    void bound_vertices(std::span<const Real> inverse_masses) {
        vertex_bounds(*topology, std::span<const TriangleGeometry<Real>>(geometry), direction_bounds);
        for (std::size_t i = 0; i < direction_bounds.size(); ++i)
            if (masses.inverse[i] < inverse_masses[i]) direction_bounds[i] *= static_cast<Real>(raised_margin);
    }

    int products(const ResolvedParameters& parameters) const {
        const double alpha =
            scheduled_regularization(static_cast<double>(parameters.regularization), parameters, stats.sub_steps);
        return chebyshev_products(alpha, parameters.max_iterations, options.limits_stretch);
    }

    /// What a polynomial of `count` products left.
    static SolveResult<Real> polynomial_result(int count, bool finite) {
        return {count, finite ? Real(0) : std::numeric_limits<Real>::quiet_NaN(), true};
    }

    /// Both rows of every triangle.
    SolveResult<Real> solve_with_stretches(const ResolvedParameters& parameters) {
        const StretchSolve how{parameters.small_steps, products(parameters),
                               excess_asked_again(asked_sub_steps, parameters.sub_steps, parameters.most_sub_steps)};
        stretches.solve(moved, geometry, area_excess, how);
        return polynomial_result(how.products, stretches.finite());
    }

    /// A Chebyshev polynomial in place of a solve, of the degree that belongs to α; λ is left in `lambda`.
    SolveResult<Real> solve_by_chebyshev(std::span<const Real> inverse_masses, const ResolvedParameters& parameters) {
        const std::span<const TriangleGeometry<Real>> triangles = geometry;
        consistent_matrix(*topology, shared, triangles, std::span<const Real>(masses.inverse), G);
        if (stats.sub_steps % bound_interval == 0) bound_vertices(inverse_masses);
        diagonal_bound(*topology, triangles, std::span<const Real>(masses.inverse),
                       std::span<const Real>(direction_bounds), bound);
        bound *= static_cast<Real>(bound_margin);
        const int count = products(parameters);
        chebyshev(G, bound, area_excess, count, chebyshev_scratch, lambda);
        return polynomial_result(count, lambda.allFinite());
    }

    /// One solve of (G + (α − 1) diag G) λ = b at the present geometry; λ is left in `lambda`.
    SolveResult<Real> solve(const Buffers<Real>& buffers, const ResolvedParameters& parameters) {
        find_excess(buffers, parameters.small_steps);
        if (options.limits_stretch) return solve_with_stretches(parameters);
        if (options.solver == Solver::chebyshev) return solve_by_chebyshev(buffers.inverse_masses, parameters);
        const std::span<const TriangleGeometry<Real>> triangles = geometry;
        const std::span<const Real> inverse_masses = masses.inverse;
        if (options.matrix == Matrix::consistent)
            consistent_matrix(*topology, shared, triangles, inverse_masses, G);
        else
            printed_matrix(*topology, shared, triangles, inverse_masses, G);
        effective_regularization.resize(geometry.size());
        for (std::size_t a = 0; a < geometry.size(); ++a) {
            const Real given = buffers.regularization.empty() ? static_cast<Real>(parameters.regularization)
                                                              : buffers.regularization[a];
            effective_regularization[a] =
                raised_regularization(scheduled_regularization(given, parameters, stats.sub_steps), adaptive_factor);
        }
        regularize(std::span<const Real>(effective_regularization), G);

        const auto tolerance = static_cast<Real>(parameters.solve_tolerance);
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

    /// What sub-step stats.sub_steps leaves to the next.
    void prepare_next(const Buffers<Real>& buffers, const ResolvedParameters& parameters) {
        if (stats.sub_steps + 1 < parameters.sub_steps && parameters.raises_masses)
            options.limits_stretch ? stretches.raise_masses() : masses.raise(buffers.inverse_masses);
    }

    /// The displacements that the pressures make.
    void find_correction(std::span<const Real> inverse_masses, const ResolvedParameters& parameters) {
        const std::span<const Real> pressures{lambda.data(), geometry.size()};
        displacements<Real>(*topology, geometry, masses.inverse, pressures, correction);
        if (!parameters.raises_masses) return;
        masses.find_tension(*topology, geometry, pressures);
        for (std::size_t n = 0; n < correction.size(); ++n)
            correction[n] *= masses.share_taken(n / 3, inverse_masses[n / 3]);
    }

    /// x_j out of what it touches, and its motion. What that adds to the end of the step carries on through the parts
    /// left.
    void keep_contacts(const Buffers<Real>& buffers, const ResolvedParameters& parameters) {
        const auto time_step = static_cast<Real>(parameters.time_step),
                   parts = static_cast<Real>(parameters.small_steps);
        const Real parts_left = std::max(parts - static_cast<Real>(stats.sub_steps + 1), Real(0));
        const bool mends = stats.sub_steps >= parameters.small_steps;
        for (std::size_t i = 0; i < buffers.inverse_masses.size(); ++i) {
            if (!(buffers.inverse_masses[i] > Real(0))) continue;
            const Contact<Real> contact(buffers.contacts, i);
            Eigen::Map<Vector3<Real>> x(moved.data() + 3 * i), step(motion.data() + 3 * i),
                total(total_correction.data() + 3 * i);
            // What mends positions has no speed.
            const Vector3<Real> now = mends ? Vector3<Real>(time_step * contact.velocity) : Vector3<Real>(step);
            MovingVertex<Real> vertex{x, now, now / parts};
            if (!vertex.keep(contact, time_step, time_step * parts_left / parts, Real(1) / parts)) continue;
            total += vertex.position - x + (vertex.motion - now) * (parts_left / parts);
            x = vertex.position;
            if (!mends) step = vertex.motion;
        }
    }

    /// What vertices under too much tension keep of their motion. `share_left`: of the time step, that the rest carries
    /// on through.
    void keep_velocities(Real share_left) {
        for (std::size_t n = 0; n < motion.size(); ++n) {
            const Real carried_on = stretches.velocity_kept(n / 3);
            total_correction[n] += share_left * (carried_on - Real(1)) * motion[n];
            motion[n] *= carried_on;
        }
    }

    /// Corrects x_j. In small steps of `parts` parts a displacement of sub-step k changes the velocity too, by parts ·
    /// Δx / Δt, and carries on through the parts left.
    void displace(const Buffers<Real>& buffers, const ResolvedParameters& parameters) {
        const int sub_step = stats.sub_steps, parts = parameters.small_steps;
        if (options.limits_stretch)
            stretches.displacements(parameters.raises_masses, correction);
        else
            find_correction(buffers.inverse_masses, parameters);
        const auto carried = static_cast<Real>(std::max(parts - sub_step, 1));
        for (std::size_t n = 0; n < moved.size(); ++n) {
            moved[n] += correction[n];
            total_correction[n] += carried * correction[n];
        }
        const auto count = static_cast<Real>(parts);
        // After the last part only positions are mended.
        if (sub_step < parts) {
            for (std::size_t n = 0; n < moved.size(); ++n) motion[n] += count * correction[n];
            if (options.limits_stretch) keep_velocities((carried - Real(1)) / count);
        }
        if (options.keeps_contacts) keep_contacts(buffers, parameters);
        if (sub_step + 1 < parts) begin_part(buffers, parameters, sub_step + 1);
    }

    /// Where a whole step ends and with what velocities, `limited` or by acceleration and damping alone; false, and
    /// nothing written, where a number is not finite. What pins a vertex moves it, and its velocity keeps every bit.
    bool write_step(const Buffers<Real>& buffers, const ResolvedParameters& parameters, bool limited) {
        const auto time_step = static_cast<Real>(parameters.time_step);
        correction.resize(moved.size());
        std::vector<Real>& velocities = correction;
        for (std::size_t n = 0; n < velocities.size(); ++n) {
            const bool moves = limited && buffers.inverse_masses[n / 3] > Real(0);
            velocities[n] = moves ? motion[n] / time_step : unlimited[n];
            if (!moves) moved[n] = predicted[n];
        }
        if (limited) {
            energy.add_bending(bending_given(bending_energy, bending.energy(), parameters.small_steps));
            const auto excess = [&](std::size_t a) {
                return options.limits_stretch ? std::max(stretches.start_excess(a), stretches.excess(a, moved))
                                              : Real(0);
            };
            const FreeStep<Real> free(parameters, buffers.accelerations);
            energy.follow(
                buffers.velocities, static_cast<double>(time_step),
                [&](std::size_t n) { return static_cast<double>(moved[n] - buffers.positions[n]); },
                [&](std::size_t n) { return static_cast<double>(free.gain(n)); });
            stats.energy_kept = static_cast<float>(
                energy.apply(velocities, worst_miss<Real>(buffers.rest_areas, start_error, geometry, excess)));
        }
        if (!all_finite<Real>(moved) || !all_finite<Real>(velocities)) return false;
        std::copy(moved.begin(), moved.end(), buffers.end_positions.begin());
        std::copy(velocities.begin(), velocities.end(), buffers.velocities.begin());
        return true;
    }

    /// ṽ + Σ Δx / Δt into `correction`; false where a number is not finite. Velocities of pinned vertices are copied,
    /// not computed, so that they keep every bit.
    bool filtered_velocities(const Buffers<Real>& buffers, Real time_step) {
        correction.resize(moved.size());
        for (std::size_t n = 0; n < moved.size(); ++n) {
            correction[n] = buffers.velocities[n];
            if (buffers.inverse_masses[n / 3] > Real(0) && total_correction[n] != Real(0))
                correction[n] += total_correction[n] / time_step;
        }
        return all_finite<Real>(correction);
    }

    void name_offender(Offender offender, std::size_t index) {
        stats.offender = offender;
        stats.offender_index = static_cast<std::uint32_t>(index);
    }

    /// The first triangle whose area is not finite or has no place in 32-bit statistics.
    void name_triangle(const Buffers<Real>& buffers) {
        for (std::size_t a = 0; a < geometry.size(); ++a)
            if (!area_change<Real>(std::span(geometry).subspan(a, 1), buffers.rest_areas.subspan(a, 1)).finite ||
                (options.limits_stretch && !is_finite(stretches.excess(a, moved))))
                return name_offender(Offender::triangle, a);
    }

    /// True where the result of the call is dropped: greatest and RMS are then those at x̃ + Δt ṽ. Where the result
    /// stands and the greatest rose, the triangle that has it is named.
    bool is_worse(const Standing& initial, const Standing& change, std::span<const Real> rest_areas) {
        const Verdict verdict = judge(initial, change, options.limits_stretch, acts_in_parts());
        set_standing(verdict.worse ? initial : change);
        if (verdict.rose) stats.status = Status::worsened;
        if (verdict.names) name_offender(Offender::triangle, worst_triangle(rest_areas));
        return verdict.worse;
    }

    /// The first triangle with the greatest area change or, with a ceiling, excess.
    std::size_t worst_triangle(std::span<const Real> rest_areas) const {
        std::size_t worst = 0;
        double greatest = -1.0;
        for (std::size_t a = 0; a < geometry.size(); ++a) {
            double change = area_change<Real>(std::span(geometry).subspan(a, 1), rest_areas.subspan(a, 1)).max;
            if (options.limits_stretch) change = std::max(change, static_cast<double>(stretches.excess(a, moved)));
            if (change > greatest) {
                greatest = change;
                worst = a;
            }
        }
        return worst;
    }

    /// Vertices that weighed more than given in the last sub-step.
    void count_raised(std::span<const Real> inverse_masses) {
        const std::span<const Real> effective =
            options.limits_stretch ? stretches.inverse_masses() : std::span<const Real>(masses.inverse);
        for (std::size_t i = 0; i < inverse_masses.size(); ++i) {
            if (!(effective[i] < inverse_masses[i])) continue;
            ++stats.raised_vertices;
            stats.greatest_mass_ratio =
                std::max(stats.greatest_mass_ratio, static_cast<float>(inverse_masses[i] / effective[i]));
        }
    }

    void set_standing(const Standing& state) {
        stats.max_area_change = static_cast<float>(state.areas.max);
        stats.rms_area_change = static_cast<float>(state.areas.rms);
        stats.max_stretch = static_cast<float>(state.stretches.greatest_stretch);
        stats.max_stretch_excess = static_cast<float>(state.stretches.max);
        stats.rms_stretch_excess = static_cast<float>(state.stretches.rms);
    }

    /// Leaves the outcome in `stats`; what is not finite ends it as diverged, with the area change of the velocities as
    /// given.
    void filter(const Buffers<Real>& buffers, ResolvedParameters parameters) {
        const Real time_step = parameters.time_step;
        stats = {};
        stats.status = Status::diverged;
        stats.greatest_mass_ratio = 1.0f;
        stats.energy_kept = 1.0f;
        predict(buffers, parameters);
        if (!all_finite<Real>(predicted)) return name_offender(Offender::vertex, first_bad_vertex<Real>(predicted));
        if (options.limits_stretch) stretches.start(*topology, buffers, static_cast<Real>(parameters.stretch_ceiling));
        if (options.bends) bending.start(buffers);
        const Standing initial = standing(buffers);
        if (!initial.finite()) return name_triangle(buffers);
        set_standing(initial);
        stats.initial_max_area_change = stats.max_area_change;
        stats.initial_rms_area_change = stats.rms_area_change;
        stats.initial_max_stretch_excess = stats.max_stretch_excess;
        stats.initial_rms_stretch_excess = stats.rms_stretch_excess;

        parameters.follow(initial.stretches.max, asked_sub_steps);
        const int parts = parameters.small_steps;
        Standing change = initial;
        bool all_converged = true;
        const auto target = static_cast<double>(parameters.target_area_change);
        const bool met = !acts_in_parts() && initial.max() <= target;
        masses.start(buffers.inverse_masses);
        if (parts > 0 && !met) change = start_small_steps(buffers, parameters);
        for (;;) {
            if (!change.finite()) return name_triangle(buffers);
            if (stats.sub_steps == parameters.sub_steps) break;
            // On the way the areas are not those of the end of the step.
            const bool at_the_end = stats.sub_steps >= parts || met;
            if (at_the_end && change.max() <= target) break;

            const SolveResult<Real> result = solve(buffers, parameters);
            if (!is_finite(result.relative_residual)) return;
            displace(buffers, parameters);
            prepare_next(buffers, parameters);
            ++stats.sub_steps;
            stats.iterations += result.iterations + (kept.empty() ? 0 : 1);  // the product with a guess costs as much
            stats.residual = std::max(stats.residual, static_cast<float>(result.relative_residual));
            all_converged = all_converged && result.converged;
            adaptive_factor = adapted_factor(adaptive_factor, parameters, result.iterations, result.converged);
            change = standing(buffers);
        }
        // Without a sub-step there is nothing to add, not even a zero: −0 + 0 would lose its sign.
        const bool any = stats.sub_steps > 0;
        if (any && !options.integrates && !filtered_velocities(buffers, time_step)) return;
        stats.status = all_converged ? Status::ok : Status::not_converged;
        count_raised(buffers.inverse_masses);
        if (options.limits_stretch) {
            stats.stretch_rows = stretches.rows_at_work();
            asked_sub_steps = next_asked_sub_steps(asked_sub_steps, stats.sub_steps, stats.greatest_mass_ratio);
        }
        const bool limited = !is_worse(initial, change, buffers.rest_areas) && any;
        if (options.integrates) {
            if (!write_step(buffers, parameters, limited)) stats.status = Status::diverged;
        } else if (limited) {
            std::copy(correction.begin(), correction.end(), buffers.velocities.begin());
        } else if (options.keeps_contacts) {
            std::copy(unlimited.begin(), unlimited.end(), buffers.velocities.begin());
        }
    }
};

template <class Real>
BasicStrainLimiter<Real>::BasicStrainLimiter(std::shared_ptr<const Topology> topology, const Options& options)
    : implementation_(std::make_unique<Implementation>()) {
    if (!topology) throw Error(ErrorCode::invalid_argument, "topology is null, expected one from Topology::build");
    validate(options);
    CsrPattern pattern = topology->csr_pattern(options.matrix);
    implementation_->options = options;
    implementation_->options.solver = resolved_solver(options);
    implementation_->bound_interval = static_cast<int>(std::min(options.bound_interval, 1u << 30));
    implementation_->topology = std::move(topology);
    implementation_->kept.assign(
        options.warm_start_sub_steps,
        TriangleVector<Real>::Zero(static_cast<Eigen::Index>(implementation_->topology->triangle_count())));
    if (options.bends) implementation_->bending = Bending<Real>(*implementation_->topology);
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
           bytes(i.unlimited) + bytes(i.moved) + bytes(i.motion) + bytes(i.before_forces) + bytes(i.total_correction) +
           bytes(i.correction) + bytes(i.geometry) + bytes(i.area_excess) + bytes(i.start_error) +
           bytes(i.masses.inverse) + bytes(i.masses.tension) + bytes(i.masses.stiffness) + bytes(i.lambda) +
           bytes(i.effective_regularization) + i.kept.size() * static_cast<std::size_t>(rows) * sizeof(Real) +
           bytes(i.scratch.inverse_diagonal) + bytes(i.scratch.residual) + bytes(i.scratch.preconditioned) +
           bytes(i.scratch.direction) + bytes(i.scratch.product) + bytes(i.direction_bounds) + bytes(i.bound) +
           bytes(i.chebyshev_scratch.inverse_bound) + bytes(i.chebyshev_scratch.residual) +
           bytes(i.chebyshev_scratch.step) + bytes(i.chebyshev_scratch.product) + i.stretches.bytes() +
           i.bending.bytes();
}

template <class Real>
void BasicStrainLimiter<Real>::enqueue(const Buffers<Real>& buffers, const Parameters& parameters) {
    Options options = implementation_->options;
    options.positions_only = false;
    options.regularization_per_triangle = !buffers.regularization.empty();
    validate(options, parameters);
    check_buffers(*implementation_->topology, buffers, options);
    if (!parameters.enabled) {
        implementation_->stats = {};
        implementation_->stats.status = Status::off;
        return;
    }
    implementation_->filter(buffers, ResolvedParameters(parameters, options));
}

template <class Real>
Stats BasicStrainLimiter<Real>::read_stats() const {
    return implementation_->stats;
}

template class BasicStrainLimiter<double>;
template class BasicStrainLimiter<float>;

}  // namespace apsl::reference

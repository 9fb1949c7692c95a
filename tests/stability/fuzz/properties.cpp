// SPDX-License-Identifier: MIT
#include "stability/fuzz/properties.hpp"

#include "chebyshev_products.hpp"
#include "resolved_parameters.hpp"
#include "support/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <utility>

namespace apsl::test {
namespace {

using Check = std::optional<Violation>;

Violation broken(const std::string& property, std::initializer_list<std::pair<const char*, double>> figures) {
    std::ostringstream details;
    details.precision(9);
    const char* separator = "";
    for (const auto& [name, value] : figures) {
        details << separator << name << ' ' << value;
        separator = ", ";
    }
    return {property, details.str()};
}

// What went in is there; what came out is finite wherever what went in was.
Check check_velocities(const MovingCloth& cloth, const Filtered& filtered) {
    for (std::size_t n = 0; n < cloth.velocities.size(); ++n) {
        const bool finite_in = std::isfinite(cloth.velocities[n]) && std::isfinite(cloth.positions[n]);
        if (finite_in && !std::isfinite(filtered.velocities[n]))
            return broken("a velocity that is not finite was written",
                          {{"vertex", static_cast<double>(n / 3)}, {"velocity", filtered.velocities[n]}});
        if (cloth.inverse_masses[n / 3] == 0.0 && !same_velocities({cloth.velocities[n]}, {filtered.velocities[n]}))
            return broken("the velocity of a pinned vertex changed",
                          {{"vertex", static_cast<double>(n / 3)}, {"velocity", filtered.velocities[n]}});
    }
    const bool unchanged = same_velocities(cloth.velocities, filtered.velocities);
    if (filtered.stats.status == Status::diverged && !unchanged) return broken("diverged, but velocities changed", {});
    return {};
}

// Of a whole step: a pinned vertex goes its way, and where a call gives up or is switched off nothing moves.
Check check_positions(const MovingCloth& cloth, const CallFacts& facts, const Parameters& parameters,
                      const Filtered& filtered) {
    if (filtered.stats.status == Status::diverged) {
        if (!same_velocities(cloth.positions, filtered.positions)) return broken("diverged, but positions changed", {});
        return {};
    }
    for (std::size_t n = 0; n < cloth.positions.size(); ++n) {
        if (!std::isfinite(filtered.positions[n]) && std::isfinite(cloth.positions[n]))
            return broken("a position that is not finite was written",
                          {{"vertex", static_cast<double>(n / 3)}, {"position", filtered.positions[n]}});
        if (cloth.inverse_masses[n / 3] != 0.0 || !facts.ordinary_numbers) continue;
        const double expected = cloth.positions[n] + static_cast<double>(parameters.time_step) * cloth.velocities[n];
        if (std::abs(filtered.positions[n] - expected) > 4.0 * facts.position_error)
            return broken("a pinned vertex did not go its way", {{"vertex", static_cast<double>(n / 3)},
                                                                 {"off", filtered.positions[n] - expected},
                                                                 {"allowed", 4.0 * facts.position_error}});
    }
    return {};
}

Check check_idle(const MovingCloth& cloth, const Filtered& filtered) {
    if (filtered.stats.sub_steps == 0 && !same_velocities(cloth.velocities, filtered.velocities))
        return broken("no sub-step, but velocities changed", {});
    return {};
}

// Every free vertex is led outside of what it touches.
Check check_outside(const MovingCloth& cloth, const CallFacts& facts, const Parameters& parameters,
                    const Filtered& filtered) {
    if (filtered.stats.status == Status::diverged || !facts.ordinary_numbers) return {};
    const auto time_step = static_cast<double>(parameters.time_step);
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        const double* contact = cloth.contacts.data() + 8 * v;
        const std::array<double, 3> normal{contact[0], contact[1], contact[2]};
        if (cloth.inverse_masses[v] == 0.0 || normal == std::array<double, 3>{}) continue;
        double depth = contact[3];
        for (std::size_t k = 0; k < 3; ++k) depth -= normal[k] * facts.end[3 * v + k];
        // Rounding, and normals that are not quite of length 1: what is left of a push, wherever the body comes from.
        const double way =
            std::abs(contact[3]) + facts.greatest_position + time_step * std::hypot(contact[4], contact[5], contact[6]);
        const double allowed = 4.0 * facts.position_error + 1e-5 * way;
        if (depth > allowed)
            return broken("a vertex ends inside of what it touches",
                          {{"vertex", static_cast<double>(v)}, {"depth", depth}, {"allowed", allowed}});
    }
    return {};
}

Check check_off(const MovingCloth& cloth, const Filtered& filtered) {
    const Stats& stats = filtered.stats;
    if (stats.status != Status::off)
        return broken("switched off, and the status is another", {{"status", static_cast<double>(stats.status)}});
    if (!same_velocities(cloth.velocities, filtered.velocities)) return broken("off, but velocities changed", {});
    if (!filtered.positions.empty() && !same_velocities(cloth.positions, filtered.positions))
        return broken("off, but positions changed", {});
    if (stats.sub_steps != 0 || stats.iterations != 0 || stats.max_area_change != 0.0f ||
        stats.rms_area_change != 0.0f || stats.offender != Offender::none)
        return broken("off, and statistics are not zero", {{"max", stats.max_area_change}});
    return {};
}

// What α − 1 is in the bounds below. A Chebyshev solve has the reach of one that its degree goes with, which the least
// and the greatest number of products may put off: α − 1 = 2.8 / degree².
double damping_of(const CallFacts& facts, const Options& options, const Parameters& parameters) {
    if (resolved_solver(options) == Solver::conjugate_gradient) return facts.smallest_alpha - 1.0;
    const double degree = 1.0 + chebyshev_products(facts.smallest_alpha, parameters.max_iterations);
    return 2.8 / (degree * degree);
}

Check check_status(const CallFacts& facts, const Parameters& parameters, const Options& options,
                   const Filtered& filtered) {
    const Stats& stats = filtered.stats;
    const bool diverged = stats.status == Status::diverged;
    // Where a solve broke, no vertex and no triangle did.
    const bool worsened = stats.status == Status::worsened;
    if (!diverged && stats.offender != Offender::none && !(worsened && stats.offender == Offender::triangle))
        return broken(
            "an offender is named where no call diverged or worsened",
            {{"status", static_cast<double>(stats.status)}, {"offender", static_cast<double>(stats.offender)}});
    if (facts.must_diverge && !diverged)
        return broken("input that is not finite did not diverge", {{"status", static_cast<double>(stats.status)}});
    // The printed matrix amplifies, and so does alpha near 1, and a polynomial where triangles become others within a
    // call, since it has the bound of its first sub-step (docs/formulation.md). And a correction may throw a vertex
    // far off where a triangle is nearly a line: no further than the bound of check_bound, which here is the cloth's
    // size.
    const double reach =
        facts.scaled_excess * std::sqrt(2.0 / (facts.smallest_alpha - 1.0) * facts.greatest_inverse_mass);
    const bool tame = options.matrix == Matrix::consistent && resolved_solver(options) == Solver::conjugate_gradient &&
                      facts.smallest_alpha >= 1.01 && reach < 10.0 * facts.greatest_position &&
                      facts.max_change_error < 0.1;
    if (diverged && facts.ordinary_numbers && !facts.must_diverge && tame)
        return broken(
            parameters.tolerance > 0.0f ? "ordinary input diverged" : "ordinary input diverged at tolerance 0",
            {{"greatest area change before", facts.max_before}});
    if (diverged) return {};
    const int most = parameters.max_iterations + (options.warm_start_sub_steps > 0 ? 1 : 0);
    const int most_sub_steps = ResolvedParameters(parameters, options).most_sub_steps;
    if (stats.sub_steps < 0 || stats.sub_steps > most_sub_steps || stats.iterations < 0 ||
        stats.iterations > most * stats.sub_steps)
        return broken("more sub-steps or iterations than allowed",
                      {{"sub-steps", stats.sub_steps}, {"iterations", stats.iterations}});
    if (!std::isfinite(stats.max_area_change) || !std::isfinite(stats.rms_area_change) ||
        !std::isfinite(stats.residual) || !std::isfinite(stats.max_stretch) ||
        !std::isfinite(stats.max_stretch_excess) || !std::isfinite(stats.rms_stretch_excess))
        return broken("statistics that are not finite without having diverged", {{"max", stats.max_area_change},
                                                                                 {"rms", stats.rms_area_change},
                                                                                 {"residual", stats.residual},
                                                                                 {"stretch", stats.max_stretch}});
    if (stats.status == Status::ok &&
        stats.residual > std::max(ResolvedParameters(parameters, options).solve_tolerance, 1e-6f) * (1.0f + 1e-5f))
        return broken("ok, but a solve missed the tolerance", {{"residual", stats.residual}});
    return {};
}

// The device's sums are exact to their rounding; each triangle's change to what rounding of positions does to it.
Check check_statistics(const CallFacts& facts, const Parameters& parameters, const Filtered& filtered) {
    if (filtered.stats.status == Status::diverged || !facts.ordinary_numbers) return {};
    const auto max = static_cast<double>(filtered.stats.max_area_change);
    const auto rms = static_cast<double>(filtered.stats.rms_area_change);
    const double error = facts.max_change_error;
    if (std::abs(max - facts.max_after) > error)
        return broken("the greatest area change is not that of the velocities",
                      {{"said", max}, {"is", facts.max_after}, {"allowed", error}});
    const double rms_error = error + 1e-4 * facts.rms_after;
    if (std::abs(rms - facts.rms_after) > rms_error)
        return broken("the RMS area change is not that of the velocities",
                      {{"said", rms}, {"is", facts.rms_after}, {"allowed", rms_error}});
    if (filtered.stats.status != Status::worsened && filtered.stats.sub_steps < parameters.sub_steps &&
        max > static_cast<double>(parameters.target_area_change))
        return broken("stopped before the target", {{"max", max}, {"sub-steps", filtered.stats.sub_steps}});
    return {};
}

// Of the two ends of a call the one with less RMS stands, and where either measure rose the status says so. With a
// stretch ceiling areas may rise for the sake of the excess.
Check check_never_worse(const CallFacts& facts, const Options& options, const Filtered& filtered) {
    const Stats& stats = filtered.stats;
    if (stats.status == Status::diverged || !facts.ordinary_numbers) return {};
    const double error = facts.max_change_error + 1e-4 * facts.rms_before;
    if (std::abs(static_cast<double>(stats.initial_max_area_change) - facts.max_before) > error ||
        std::abs(static_cast<double>(stats.initial_rms_area_change) - facts.rms_before) > error)
        return broken("the area change before the call is not that of the velocities given",
                      {{"said", stats.initial_max_area_change},
                       {"is", facts.max_before},
                       {"said RMS", stats.initial_rms_area_change},
                       {"is", facts.rms_before}});
    if (options.limits_stretch) return {};
    // Rounding of the velocities comes after the two were compared.
    if (facts.capped_rms_after > facts.capped_rms_before + 2.0 * error)
        return broken("capped RMS area change rose",
                      {{"before", facts.capped_rms_before}, {"after", facts.capped_rms_after}});
    if (facts.max_after > facts.max_before + 2.0 * error && stats.status != Status::worsened)
        return broken("greatest area change rose, and the status does not say so",
                      {{"before", facts.max_before}, {"after", facts.max_after}});
    return {};
}

// Corrections of one sub-step in the norm of kinetic energy, Σ |Δx|²/w. With A = G + (α − 1) D, Δx = −W gᵀλ:
//   Σ |Δx|²/w = 2 λᵀG'λ, G' the consistent matrix, whatever A's is. A ≥ (α − 1) D, and CG from zero reaches at most
//   λᵀAλ ≤ bᵀA⁻¹b ≤ Σ b²/D / (α − 1). G' ≤ A where A's matrix is the consistent one; else G' ≤ 3 v D with v triangles
//   at a vertex, the row sum of |G'| against D, so that λᵀG'λ ≤ 3 v λᵀAλ / (α − 1).
// A first guess that is no worse than none doubles √(λᵀAλ) at most.
Check check_bound(const MovingCloth& cloth, const CallFacts& facts, const Options& options,
                  const Parameters& parameters, const Filtered& filtered) {
    if (filtered.stats.status == Status::diverged || filtered.stats.sub_steps != 1 || !facts.ordinary_numbers)
        return {};
    const double damping = damping_of(facts, options, parameters);
    if (!(damping > 0.0) || !std::isfinite(facts.scaled_excess)) return {};
    double bound = facts.scaled_excess * std::sqrt(2.0 / damping);
    if (options.matrix == Matrix::printed) bound *= std::sqrt(3.0 * facts.greatest_valence / damping);
    if (options.warm_start_sub_steps > 0) bound *= 2.0;
    // Σ |Δx|²/w = 2 Σ x q(x)² b̄² with b̄² ≤ b²/D, and x q² ≤ 4/3 q(0) = 4/3 · 1.07 degree².
    if (resolved_solver(options) == Solver::chebyshev) bound *= 2.0;
    const auto time_step = static_cast<double>(parameters.time_step);
    double squares = 0.0, rounding = 0.0;
    for (std::size_t n = 0; n < cloth.velocities.size(); ++n) {
        const double w = cloth.inverse_masses[n / 3];
        if (w == 0.0) continue;
        const double moved = time_step * (filtered.velocities[n] - cloth.velocities[n]);
        squares += moved * moved / w;
        rounding += facts.position_error * facts.position_error / w;
    }
    const double moved = std::sqrt(squares), allowed = 1.1 * bound + std::sqrt(rounding);
    if (moved > allowed)
        return broken("corrections greater than the solve can give", {{"moved", moved}, {"bound", allowed}});
    return {};
}

// The corner gradients of a triangle add up to zero, so pressures move no centre of mass. On the device a component of
// the scaled gradient ḡ is off by half a unit of its fixed point: a triangle with scaled pressure y then pushes by
// √2 y q Σ_k 1/√w_k at most, and ‖y‖ ≤ α/(α − 1) √(Σ b²/(α D)).
Check check_momentum(const MovingCloth& cloth, const CallFacts& facts, const Options& options,
                     const Parameters& parameters, const Filtered& filtered, const FuzzedFilter& filter) {
    if (filtered.stats.status == Status::diverged || filtered.stats.sub_steps != 1 || !facts.ordinary_numbers)
        return {};
    const double damping = damping_of(facts, options, parameters);
    if (!(damping > 0.0) || !std::isfinite(facts.scaled_excess)) return {};
    const std::vector<double>& w = cloth.inverse_masses;
    double shares = 0.0;
    for (const Triangle& triangle : cloth.topology->triangles()) {
        double share = 0.0;
        for (const std::uint32_t v : triangle) {
            if (w[v] == 0.0) return {};  // a pin takes up momentum
            share += 1.0 / std::sqrt(w[v]);
        }
        shares += share * share;
    }
    const double unit = (filter.on_device() ? 0.5 * gradient_unit : 0.0) + 20.0 * filter.epsilon();
    const double pressures = resolved_solver(options) == Solver::chebyshev
                                 ? 3.0 / damping * facts.scaled_excess  // q(0) = 1.07 degree²
                                 : std::sqrt(facts.smallest_alpha) / damping * facts.scaled_excess *
                                       (options.warm_start_sub_steps > 0 ? 2.0 : 1.0);
    const double leak = std::sqrt(2.0) * unit * pressures * std::sqrt(shares);
    const auto time_step = static_cast<double>(parameters.time_step);
    double change[3] = {}, rounding = 0.0;
    for (std::size_t n = 0; n < cloth.velocities.size(); ++n) {
        if (w[n / 3] == 0.0) continue;
        change[n % 3] += time_step * (filtered.velocities[n] - cloth.velocities[n]) / w[n / 3];
        rounding += facts.position_error / w[n / 3];
    }
    for (const double along_axis : change)
        if (std::abs(along_axis) > 1.1 * leak + rounding)
            return broken("a free cloth's momentum changed",
                          {{"m · Δx, kg m", along_axis}, {"allowed", 1.1 * leak + rounding}});
    return {};
}

}  // namespace

bool same_velocities(const std::vector<double>& a, const std::vector<double>& b) {
    return same_bytes(a, b);
}

std::optional<Violation> violation_of(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                                      const Filtered& filtered, const FuzzedFilter& filter) {
    if (!filter.on_device() && refused_by_reference(cloth)) return {};
    if (!parameters.enabled) return check_off(cloth, filtered);
    const CallFacts facts(cloth, options, parameters, filtered, filter.epsilon());
    Check check = check_velocities(cloth, filtered);
    if (!check && options.integrates) check = check_positions(cloth, facts, parameters, filtered);
    if (!check) check = check_status(facts, parameters, options, filtered);
    if (!check) check = check_statistics(facts, parameters, filtered);
    // Contact is part of both ends that are compared, and so are a whole step's forces.
    if (!check && !options.keeps_contacts && !options.integrates) check = check_never_worse(facts, options, filtered);
    if (options.keeps_contacts) return check ? check : check_outside(cloth, facts, parameters, filtered);
    if (options.integrates) return check;
    // The bounds below are those of areas with the masses as given.
    if (options.limits_stretch) return check ? check : check_idle(cloth, filtered);
    if (!check) check = check_bound(cloth, facts, options, parameters, filtered);
    if (!check) check = check_momentum(cloth, facts, options, parameters, filtered, filter);
    if (!check) check = check_idle(cloth, filtered);
    return check;
}

std::optional<Violation> disagreement(const MovingCloth& cloth, const Options& options, const Parameters& parameters,
                                      const Filtered& device, const Filtered& reference) {
    if (refused_by_reference(cloth) || options.limits_stretch || options.integrates) return {};
    const CallFacts facts(cloth, options, parameters, device, epsilon);
    // Where the linearised areas are near the true ones and the matrix is far from singular: each of the two solves is
    // off by κ · tolerance in the scaled norm, κ ≤ (3 v + α − 1)/(α − 1), the device's matrix by its stored gradients.
    const bool well_posed =
        facts.ordinary_numbers && options.matrix == Matrix::consistent && facts.smallest_alpha >= 1.2 &&
        parameters.sub_steps == 1 && parameters.target_area_change == 0.0f && parameters.tolerance <= 1e-4f &&
        parameters.max_iterations >= 20 && std::isfinite(facts.scaled_excess) && facts.max_before < 0.5 &&
        facts.max_change_error < 1e-3 && device.stats.status == Status::ok && reference.stats.status == Status::ok;
    if (!well_posed) return {};
    const CallFacts expected(cloth, options, parameters, reference, epsilon);
    const double kappa = (3.0 * facts.greatest_valence + facts.smallest_alpha - 1.0) / (facts.smallest_alpha - 1.0);
    const double relative = 2.0 * kappa * (static_cast<double>(parameters.tolerance) + stored_product_tolerance);
    // Δ(A/A⁰) in the norm over triangles, of what the solve was to take away.
    const double scale = facts.rms_before * std::sqrt(static_cast<double>(facts.before.size()));
    double off = 0.0;
    for (std::size_t a = 0; a < facts.after.size(); ++a)
        off = std::max(off, std::abs(facts.after[a] - expected.after[a]));
    const double allowed = relative * scale + facts.max_change_error + expected.max_change_error;
    if (off > allowed)
        return broken("device and reference leave different areas", {{"off", off}, {"allowed", allowed}});
    return {};
}

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>

#include <cstdint>

namespace apsl {

/// How a filter call ended.
enum class Status : std::int32_t {
    ok = 0,             ///< every solve met its tolerance
    not_converged = 1,  ///< at least one solve used all its iterations; the best state reached stands
    /// The greatest or the RMS area change rose above what it was at x̃ + Δt ṽ; with a stretch ceiling the greater of
    /// area change and excess counts, and the squares of both. The state with the lower capped RMS
    /// stands, in which each triangle counts by its rest area and with at most 100 %. Where that is the first state,
    /// the velocities are as they were given. Where it is the second, `offender` names a triangle that ended worse.
    worsened = 2,
    diverged = 3,  ///< not finite, going in or on the way: positions and velocities are as they were given
    off = 4,       ///< Parameters::enabled was false: nothing was looked at
};

/// What Stats::offender_index counts.
enum class Offender : std::int32_t {
    none = 0,    ///< nothing
    vertex = 1,  ///< its position, velocity or x̃ + Δt ṽ is not finite, or its inverse mass is not or is negative
    /// With status diverged: its rest area is negative or, like its α or the area it came to, not finite. With status
    /// worsened: it has the greatest area change, and that rose.
    triangle = 2,
};

/// What one filter call did to one cloth. The device writes this layout itself (kernels/layout.h).
struct Stats {
    std::int32_t sub_steps;   ///< solves done
    std::int32_t iterations;  ///< over all of them; by Chebyshev products with the matrix
    /// Greatest ‖r‖ / ‖b‖ at the end of a solve, norm as in Parameters::tolerance; 0 by Chebyshev, which measures none.
    float residual;
    float max_area_change;          ///< max |A − A⁰| / A⁰ of the state that stands
    float rms_area_change;          ///< root of the mean of its squares, weighted with A⁰, as mass is
    float initial_max_area_change;  ///< the greatest at x̃ + Δt ṽ, before the first sub-step
    float initial_rms_area_change;  ///< and the weighted RMS there
    Status status;                  ///< how the call ended for this cloth
    Offender offender;              ///< other than none only where status is diverged or worsened
    std::uint32_t offender_index;   ///< the first one, within its cloth
    /// Vertices that weighed more in the last sub-step than given, because they are too light for the tension around
    /// them (docs/formulation.md, Effective masses).
    std::uint32_t raised_vertices;
    float greatest_mass_ratio;  ///< their greatest mass over the one given; 1 where none was raised
    /// Greatest principal stretch of the state that stands; this and the next five are 0 without
    /// Options::limits_stretch.
    float max_stretch;
    float max_stretch_excess;          ///< greatest max(0, principal stretch − ceiling)
    float rms_stretch_excess;          ///< root of the mean of its squares, weighted with A⁰
    float initial_max_stretch_excess;  ///< the greatest at x̃ + Δt ṽ
    float initial_rms_stretch_excess;  ///< and the weighted RMS there
    std::uint32_t stretch_rows;        ///< triangles that the ceiling held in the last sub-step
    /// The share of the cloth's kinetic energy, against what drives it, that the bound on energy left
    /// (docs/formulation.md, Energy); 1 where it took none, and without Options::integrates.
    float energy_kept;
};
static_assert(sizeof(Stats) == 76);

}  // namespace apsl

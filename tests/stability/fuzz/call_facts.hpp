// SPDX-License-Identifier: MIT
#pragma once

#include "stability/fuzz/fuzzed_filter.hpp"

#include <apsl/parameters.hpp>

#include <vector>

namespace apsl::test {

/// What is known in double precision of one cloth before and after a call: what properties are judged by.
struct CallFacts {
    CallFacts(const MovingCloth& cloth, const Options& options, const Parameters& parameters, const Filtered& after,
              double epsilon);

    bool input_is_finite;
    /// A number that is not finite at a triangle with rest area: the call cannot but end as diverged.
    bool must_diverge;
    /// Nothing that 32 bits cannot square: coordinates at the end of the step and edges of ordinary size, or zero.
    bool ordinary_numbers;

    double smallest_alpha;  ///< over triangles and sub-steps
    double
        position_error;  ///< m, what rounding may have come to in a coordinate: the size of the numbers times epsilon
    double greatest_position;  ///< m, max |x|, |x + Δt v| before and after
    std::vector<double> end;   ///< x + Δt v after, or where a whole step ends, m, [3V]
    /// Area changes |A − A⁰| / A⁰ at x + Δt v, [T], 0 where A⁰ ≤ 0, and how far off rounding may put each.
    std::vector<double> before, after, change_error;
    double max_before, max_after, rms_before, rms_after, max_change_error;
    double capped_rms_before, capped_rms_after;  ///< each triangle's counted as at most 1
    /// √Σ b²/D at x + Δt v before, over triangles that can move, b = A − A⁰ with its rounding; infinite where rounding
    /// leaves nothing of a D.
    double scaled_excess;
    double greatest_inverse_mass;  ///< 1/kg
    double greatest_valence;       ///< most triangles at a vertex

    static double rms(const std::vector<double>& changes, const std::vector<double>& rest_areas);
};

}  // namespace apsl::test

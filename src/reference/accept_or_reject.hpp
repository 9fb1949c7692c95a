// SPDX-License-Identifier: MIT
#pragma once

#include "reference/area_change.hpp"
#include "reference/stretch_limiting.hpp"

#include "../../kernels/constants.h"

#include <algorithm>
#include <cmath>

// Accepts or rejects the result of a call.
namespace apsl::reference {

/// The areas and, with a ceiling, the stretches of a state.
struct Standing {
    AreaChange areas;
    StretchExcess stretches;

    bool finite() const { return areas.finite && stretches.finite; }
    /// What is judged: the greater of area change and excess, and the squares of both.
    double max() const { return std::max(areas.max, stretches.max); }
    double rms() const { return std::hypot(areas.rms, stretches.rms); }
    double capped_rms() const { return std::hypot(areas.capped_rms, stretches.capped_rms); }
};

struct Verdict {
    bool worse;  ///< the result is dropped
    bool rose;   ///< the status is worsened
    bool names;  ///< the result stands, and the triangle with the greatest area change is named
};

/// `initial`: at x̃ + Δt ṽ. The capped RMS decides, so that a single triangle does not cost the others their correction.
inline Verdict judge(const Standing& initial, const Standing& change, bool limits_stretch, bool acts_in_parts) {
    const double passed = acts_in_parts ? double{APSLK_LET_PASS_IN_PARTS} : 0.0;
    const double initial_rms = std::max(initial.rms(), passed),
                 initial_capped_rms = std::max(initial.capped_rms(), passed);
    const bool rose = change.max() > std::max(initial.max(), passed) || change.rms() > initial_rms ||
                      change.capped_rms() > initial_capped_rms;
    const bool at_rest = initial.max() <= double{APSLK_AT_REST};
    const bool lets_pass = limits_stretch && change.areas.rms < initial.areas.rms;
    const double let_pass = lets_pass ? double{APSLK_GROWTH_LET_PASS} : 1.0;
    bool worse = rose && (at_rest || change.capped_rms() >= let_pass * initial_capped_rms);
    // Where tension goes unstable all of a cloth explodes, and the cap would hide it.
    if (limits_stretch) worse = worse || change.rms() > let_pass * initial_rms;
    return {worse, rose && !at_rest, rose && !worse && change.max() > initial.max()};
}

}  // namespace apsl::reference

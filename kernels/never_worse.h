// SPDX-License-Identifier: MIT
// What stands at the end of a call: what it did, or nothing. Reference: apsl::reference, is_worse.
#ifndef APSL_NEVER_WORSE_H
#define APSL_NEVER_WORSE_H

#include "layout.h"

// Greatest and RMS area change left behind go into `stats`; true where the call must leave the velocities as they were.
// Between a greater maximum and a greater RMS, the RMS decides: it is what the solves reduce.
APSL_INLINE bool is_worse(__global apsl_stats* stats, float max_area_change, float rms_area_change) {
    const float initial_max = stats->initial_max_area_change, initial_rms = stats->initial_rms_area_change;
    const bool rose = max_area_change > initial_max || rms_area_change > initial_rms;
    const bool at_rest = initial_max <= APSL_AT_REST;
    const bool worse = rose && (at_rest || rms_area_change >= initial_rms);
    stats->max_area_change = worse ? initial_max : max_area_change;
    stats->rms_area_change = worse ? initial_rms : rms_area_change;
    if (rose && !at_rest) stats->status = APSL_STATUS_WORSENED;
    return worse;
}

#endif

// SPDX-License-Identifier: MIT
// Accepts or rejects the result of a call. Reference: apsl::reference, accept_or_reject.
#ifndef APSLK_ACCEPT_OR_REJECT_H
#define APSLK_ACCEPT_OR_REJECT_H

#include "acts_in_parts.h"
#include "layout.h"
#include "limits_stretch.h"

// |A − A⁰| / A⁰ over the triangles of a cloth.
typedef struct {
    float max;
    float rms;         // weighted with A⁰
    float capped_rms;  // the same with each triangle's counted as at most 1
    float measured;    // Σ A⁰, m²
#if APSLK_LIMITS_STRETCH
    float max_stretch;
    float max_excess;  // of stretch over the ceiling; capped_rms has it too
    float rms_excess;  // weighted with A⁰
#endif
} apslk_area_change;

typedef struct {
    bool worse;  // the velocities stay as given
    bool rose;   // the status is worsened
    bool names;  // the result stands, and the triangle with the greatest area change is named
} apslk_verdict;

// A greatest area change that rounding makes in a cloth at rest: positions up to `extent` from the origin are off by
// their resolution, and `triangle_count` triangles share a rest area of `measured`.
APSLK_INLINE float greatest_change_at_rest(float extent, float measured, uint triangle_count) {
    const float rounding =
        measured > 0.0f ? APSLK_POSITION_RESOLUTION * extent * sqrt((float)triangle_count / measured) : 0.0f;
    return isfinite(rounding) ? fmax(rounding, APSLK_AT_REST) : APSLK_AT_REST;
}

// What is judged: with a stretch ceiling the greater of area change and excess, and the squares of both.
APSLK_INLINE float judged_max(apslk_area_change change) {
#if APSLK_LIMITS_STRETCH
    change.max = fmax(change.max, change.max_excess);
#endif
    return change.max;
}

APSLK_INLINE float judged_rms(apslk_area_change change) {
#if APSLK_LIMITS_STRETCH
    change.rms = length((float2)(change.rms, change.rms_excess));
#endif
    return change.rms;
}

// What is judged at x̃ + Δt ṽ, or what counts as no worse there.
APSLK_INLINE float let_pass_in_parts(float initial) {
    return APSLK_ACTS_IN_PARTS ? fmax(initial, APSLK_LET_PASS_IN_PARTS) : initial;
}

// The capped RMS decides, so that a single triangle does not cost the others their correction.
APSLK_INLINE apslk_verdict judge(apslk_area_change initial, apslk_area_change change, float change_at_rest) {
    const float initial_rms = let_pass_in_parts(judged_rms(initial)),
                initial_capped_rms = let_pass_in_parts(initial.capped_rms);
    const bool rose = judged_max(change) > let_pass_in_parts(judged_max(initial)) || judged_rms(change) > initial_rms ||
                      change.capped_rms > initial_capped_rms;
    const bool at_rest = judged_max(initial) <= change_at_rest;
    apslk_verdict verdict;
    const float let_pass = APSLK_LIMITS_STRETCH && change.rms < initial.rms ? APSLK_GROWTH_LET_PASS : 1.0f;
    verdict.worse = rose && (at_rest || change.capped_rms >= let_pass * initial_capped_rms);
#if APSLK_LIMITS_STRETCH
    // Where tension goes unstable all of a cloth explodes, and the cap would hide it.
    verdict.worse = verdict.worse || judged_rms(change) > let_pass * initial_rms;
#endif
    verdict.rose = rose && !at_rest;
    verdict.names = rose && !verdict.worse && judged_max(change) > judged_max(initial);
    return verdict;
}

// The area change at x̃ + Δt ṽ, kept for the end of the call; none where it is not finite.
APSLK_INLINE void store_initial(__global apslk_solve_state* state, __global apslk_stats* stats,
                                apslk_area_change change, bool finite) {
    stats->initial_max_area_change = finite ? change.max : 0.0f;
    stats->initial_rms_area_change = finite ? change.rms : 0.0f;
#if APSLK_LIMITS_STRETCH
    stats->initial_max_stretch_excess = finite ? change.max_excess : 0.0f;
    stats->initial_rms_stretch_excess = finite ? change.rms_excess : 0.0f;
    stats->max_stretch = finite ? change.max_stretch : 0.0f;
#endif
    state->initial_capped_rms = finite ? change.capped_rms : 0.0f;
}

APSLK_INLINE apslk_area_change stored_initial(__global const apslk_solve_state* state,
                                              __global const apslk_stats* stats) {
    apslk_area_change initial;
    initial.max = stats->initial_max_area_change;
    initial.rms = stats->initial_rms_area_change;
    initial.capped_rms = state->initial_capped_rms;
    initial.measured = 0.0f;  // not kept
#if APSLK_LIMITS_STRETCH
    initial.max_stretch = stats->max_stretch;
    initial.max_excess = stats->initial_max_stretch_excess;
    initial.rms_excess = stats->initial_rms_stretch_excess;
#endif
    return initial;
}

// The statistics of the state that stands.
APSLK_INLINE void store_area_change(__global apslk_stats* stats, apslk_area_change standing) {
    stats->max_area_change = standing.max;
    stats->rms_area_change = standing.rms;
#if APSLK_LIMITS_STRETCH
    stats->max_stretch = standing.max_stretch;
    stats->max_stretch_excess = standing.max_excess;
    stats->rms_stretch_excess = standing.rms_excess;
#endif
}

#endif

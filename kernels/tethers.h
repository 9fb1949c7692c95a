// SPDX-License-Identifier: MIT
// What a vertex hangs by, and how it is kept within reach (docs/formulation.md, Tethers). Reference: apsl::reference,
// tethers.
#ifndef APSLK_TETHERS_H
#define APSLK_TETHERS_H

#include "acts_in_parts.h"
#include "caller_vectors.h"
#include "layout.h"

// What the vertices of a cloth hang by: Buffers::tether_anchors, tether_lengths, positions and velocities.
typedef struct {
    __global const uint* anchors;
    __global const float* lengths;
    __global const float *positions, *velocities;
} apslk_tethers;

// Arguments of kernels that keep vertices within reach, which they have only where there are tethers.
#if APSLK_TETHERS
#define APSLK_TETHERS_ARGUMENT                                                                               \
    , __global const uint *tether_anchors, ulong tether_anchor_offset, __global const float *tether_lengths, \
        ulong tether_length_offset, __global const float *anchor_positions, ulong anchor_position_offset,    \
        __global const float *anchor_velocities, ulong anchor_velocity_offset
#define APSLK_TETHERS_GIVEN                                                        \
    {tether_anchors + tether_anchor_offset, tether_lengths + tether_length_offset, \
     anchor_positions + anchor_position_offset, anchor_velocities + anchor_velocity_offset}
#else
#define APSLK_TETHERS_ARGUMENT
#define APSLK_TETHERS_GIVEN {0, 0, 0, 0}
#endif

// On to the next part of a step.
typedef struct {
    float share;  // of the step
    float time;   // s, from the start of the step to the end of the part
} apslk_move;

// Δt times the velocity of a vertex at x: as given, or one that leads no further than its tethers reach. An anchor goes
// straight on with the velocity that it has at the start of the step, as a pinned vertex does; one outside of the cloth
// holds nothing.
APSLK_INLINE float3 within_reach(float3 x, float3 motion, apslk_move move, apslk_tethers tethers, apslk_cloth cloth,
                                 uint vertex) {
#if APSLK_TETHERS
    float3 end = fma((float3)(move.share), motion, x);
    bool held = false;
    for (uint k = 0; k < APSLK_TETHERS; ++k) {
        const ulong t = (ulong)vertex * APSLK_TETHERS + k;
        const uint anchor = tethers.anchors[t];
        const float length = tethers.lengths[t];
        if (!(length > 0.0f) || anchor - cloth.vertex_begin >= cloth.vertex_count) continue;
        const float3 at = predicted_position(load_position(tethers.positions, anchor),
                                             load_velocity(tethers.velocities, anchor), move.time);
        const float3 from = end - at;
        const float squared = dot(from, from);
        if (squared > length * length) {
            end = at + length / sqrt(squared) * from;
            held = true;
        }
    }
    return held ? (end - x) / move.share : motion;
#else
    (void)x;
    (void)move;
    (void)tethers;
    (void)cloth;
    (void)vertex;
    return motion;
#endif
}

#endif

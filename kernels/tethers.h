// SPDX-License-Identifier: MIT
// What a vertex hangs by, and how it is kept within reach (docs/formulation.md, Tethers). Reference: apsl::reference,
// tethers.
#ifndef APSLK_TETHERS_H
#define APSLK_TETHERS_H

#include "acts_in_parts.h"
#include "caller_vectors.h"
#include "layout.h"

// What the vertices of a cloth hang by: Buffers::tether_anchors, tether_lengths, positions, velocities and
// inverse_masses.
typedef struct {
    __global const uint* anchors;
    __global const float* lengths;
    __global const float *positions, *velocities, *inverse_masses;
} apslk_tethers;

#define APSLK_NO_TETHERS {0, 0, 0, 0, 0}

// Arguments of kernels that keep vertices within reach, which they have only where there are tethers.
#if APSLK_TETHERS
#define APSLK_TETHERS_ARGUMENT                                                                               \
    , __global const uint *tether_anchors, ulong tether_anchor_offset, __global const float *tether_lengths, \
        ulong tether_length_offset, __global const float *anchor_positions, ulong anchor_position_offset,    \
        __global const float *anchor_velocities, ulong anchor_velocity_offset,                               \
        __global const float *anchor_inverse_masses, ulong anchor_inverse_mass_offset
#define APSLK_TETHERS_GIVEN                                                                 \
    {tether_anchors + tether_anchor_offset, tether_lengths + tether_length_offset,          \
     anchor_positions + anchor_position_offset, anchor_velocities + anchor_velocity_offset, \
     anchor_inverse_masses + anchor_inverse_mass_offset}
#else
#define APSLK_TETHERS_ARGUMENT
#define APSLK_TETHERS_GIVEN APSLK_NO_TETHERS
#endif

// On to the next part of a step.
typedef struct {
    float share;      // of the step
    float time;       // s, from the start of the step to the end of the part
    float time_step;  // s
} apslk_move;

// Where anchors are at the end of a part: they go straight on with the velocities that they have at the start of the
// step, as pinned vertices do.
APSLK_INLINE float3 anchor_at(apslk_tethers tethers, uint anchor, float time) {
    return predicted_position(load_position(tethers.positions, anchor), load_velocity(tethers.velocities, anchor),
                              time);
}

#if APSLK_TETHERS
// How much longer the tethers of a vertex are than given, at least 1: where anchors are further apart than two tethers
// together reach, nothing could be within reach of both.
APSLK_INLINE float tether_stretch(const float3* at, const float* lengths) {
    float stretch = 1.0f;
    for (uint k = 1; k < APSLK_TETHERS; ++k)
        for (uint j = 0; j < k; ++j) {
            if (!(lengths[j] > 0.0f && lengths[k] > 0.0f)) continue;
            const float3 apart = at[k] - at[j];
            const float squared = dot(apart, apart), together = lengths[j] + lengths[k];
            if (squared > together * together) stretch = fmax(stretch, sqrt(squared) / together);
        }
    return stretch;
}
#endif

// Δt times the velocity of a vertex at x, without what would lead it out of reach of its anchors in this part: a tether
// takes speed away from its anchor, moves nothing and pulls nothing back. An anchor that is not pinned, or outside of
// the cloth, holds nothing.
APSLK_INLINE float3 within_reach(float3 x, float3 motion, apslk_move move, apslk_tethers tethers, apslk_cloth cloth,
                                 uint vertex) {
#if APSLK_TETHERS
    const ulong first = (ulong)vertex * APSLK_TETHERS;
    float3 at[APSLK_TETHERS];
    float lengths[APSLK_TETHERS];
    for (uint k = 0; k < APSLK_TETHERS; ++k) {
        const uint anchor = tethers.anchors[first + k];
        const bool holds = anchor - cloth.vertex_begin < cloth.vertex_count &&
                           tethers.inverse_masses[(ulong)anchor * APSLK_INVERSE_MASS_STRIDE] == 0.0f;
        lengths[k] = holds ? tethers.lengths[first + k] : 0.0f;
        at[k] = holds ? anchor_at(tethers, anchor, move.time) : (float3)(0.0f);
    }
    const float stretch = tether_stretch(at, lengths);
    for (uint k = 0; k < APSLK_TETHERS; ++k) {
        const float reach = stretch * lengths[k];
        const float3 from = fma((float3)(move.share), motion, x) - at[k];
        const float squared = dot(from, from);
        if (!(reach > 0.0f && squared > reach * reach)) continue;
        const float distance = sqrt(squared);
        const float3 away = from / distance;
        const float3 anchor_motion = move.time_step * load_velocity(tethers.velocities, tethers.anchors[first + k]);
        const float outwards = fmax(dot(motion - anchor_motion, away), 0.0f);
        motion -= fmin((distance - reach) / move.share, outwards) * away;
    }
#else
    (void)x;
    (void)move;
    (void)tethers;
    (void)cloth;
    (void)vertex;
#endif
    return motion;
}

#endif

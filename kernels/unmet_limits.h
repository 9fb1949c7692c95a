// SPDX-License-Identifier: MIT
// Vertices at triangles outside their limits (measure_area_change.cl). Reference: apsl::reference, unmet_vertices.
#ifndef APSLK_UNMET_LIMITS_H
#define APSLK_UNMET_LIMITS_H

#include "layout.h"

// Whether a triangle at vertex i of the limiter's order is outside its limits.
APSLK_INLINE bool is_unmet(__global const uint* corner_offsets, __global const uint* corners,
                           __global const float* unmet, uint i) {
    bool found = false;
    const uint end = corner_offsets[i + 1];
    for (uint n = corner_offsets[i]; n < end; ++n) found = found || unmet[APSLK_CORNER_TRIANGLE(corners[n])] > 0.0f;
    return found;
}

#endif

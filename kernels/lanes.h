// SPDX-License-Identifier: MIT
// Arithmetic on several triangles at once. One work-item a group (a CPU) takes eight, so that geometry fills its vector
// registers; otherwise each work-item takes one, and the hardware does the rest. The formulas are written once, on
// `lanes`, which is float8 or float.
#ifndef APSLK_LANES_H
#define APSLK_LANES_H

#include "work_group.h"

#if APSLK_WORK_GROUP_SIZE == 1
#define APSLK_LANES 8
typedef float8 lanes;
typedef int8 lanes_int;
#else
#define APSLK_LANES 1
typedef float lanes;
typedef int lanes_int;
#endif

typedef struct {
    lanes x, y, z, w;
} lanes4;

#if APSLK_LANES == 8

// values[index[0]], …, the vertices at corner `corner` of eight triangles: eight 16-byte loads and a transposition.
APSLK_INLINE lanes4 load_corner_vertices(__global const uint* triangles, __global const float4* values, uint first,
                                         uint corner) {
    __global const uint* index = triangles + 3u * first + corner;
    const float8 a = (float8)(values[index[0]], values[index[12]]), b = (float8)(values[index[3]], values[index[15]]);
    const float8 c = (float8)(values[index[6]], values[index[18]]), d = (float8)(values[index[9]], values[index[21]]);
    const float8 ab_low = (float8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5);
    const float8 ab_high = (float8)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7);
    const float8 cd_low = (float8)(c.s0, d.s0, c.s1, d.s1, c.s4, d.s4, c.s5, d.s5);
    const float8 cd_high = (float8)(c.s2, d.s2, c.s3, d.s3, c.s6, d.s6, c.s7, d.s7);
    lanes4 v;
    v.x = (float8)(ab_low.s01, cd_low.s01, ab_low.s45, cd_low.s45);
    v.y = (float8)(ab_low.s23, cd_low.s23, ab_low.s67, cd_low.s67);
    v.z = (float8)(ab_high.s01, cd_high.s01, ab_high.s45, cd_high.s45);
    v.w = (float8)(ab_high.s23, cd_high.s23, ab_high.s67, cd_high.s67);
    return v;
}

// One value of each vertex in place of four.
APSLK_INLINE lanes load_corner_values(__global const uint* triangles, __global const float* values, uint first,
                                      uint corner) {
    __global const uint* index = triangles + 3u * first + corner;
    return (float8)(values[index[0]], values[index[3]], values[index[6]], values[index[9]], values[index[12]],
                    values[index[15]], values[index[18]], values[index[21]]);
}

APSLK_INLINE lanes load_lanes(__global const float* values, uint first) {
    return vload8(0, values + first);
}

APSLK_INLINE void store_lanes(lanes value, __global float* values, uint first) {
    vstore8(value, 0, values + first);
}

// The lanes at place `n` of an array of this work-item.
APSLK_INLINE lanes private_lanes(const float* values, uint n) {
    return vload8(n, values);
}

APSLK_INLINE void store_private_lanes(lanes value, float* values) {
    vstore8(value, 0, values);
}

APSLK_INLINE float sum_of_lanes(lanes v) {
    const float4 a = v.lo + v.hi;
    const float2 b = a.lo + a.hi;
    return b.x + b.y;
}

APSLK_INLINE float max_of_lanes(lanes v) {
    const float4 a = fmax(v.lo, v.hi);
    const float2 b = fmax(a.lo, a.hi);
    return fmax(b.x, b.y);
}

// Eight words for each of eight triangles, word by word, to 32 bytes a triangle.
APSLK_INLINE void store_records(const lanes_int words[8], __global int4* records, uint first) {
    __global int4* out = records + 2u * first;
    for (uint half_record = 0; half_record < 2; ++half_record) {
        const int8 a = words[4 * half_record], b = words[4 * half_record + 1];
        const int8 c = words[4 * half_record + 2], d = words[4 * half_record + 3];
        const int8 ab_low = (int8)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5);
        const int8 ab_high = (int8)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7);
        const int8 cd_low = (int8)(c.s0, d.s0, c.s1, d.s1, c.s4, d.s4, c.s5, d.s5);
        const int8 cd_high = (int8)(c.s2, d.s2, c.s3, d.s3, c.s6, d.s6, c.s7, d.s7);
        out[half_record + 0] = (int4)(ab_low.s01, cd_low.s01);
        out[half_record + 2] = (int4)(ab_low.s23, cd_low.s23);
        out[half_record + 4] = (int4)(ab_high.s01, cd_high.s01);
        out[half_record + 6] = (int4)(ab_high.s23, cd_high.s23);
        out[half_record + 8] = (int4)(ab_low.s45, cd_low.s45);
        out[half_record + 10] = (int4)(ab_low.s67, cd_low.s67);
        out[half_record + 12] = (int4)(ab_high.s45, cd_high.s45);
        out[half_record + 14] = (int4)(ab_high.s67, cd_high.s67);
    }
}

APSLK_INLINE lanes_int to_int(lanes v) {
    return convert_int8(v);
}

APSLK_INLINE lanes_int bits_of(lanes v) {
    return as_int8(v);
}

#else

APSLK_INLINE lanes4 load_corner_vertices(__global const uint* triangles, __global const float4* values, uint first,
                                         uint corner) {
    const float4 value = values[triangles[3u * first + corner]];
    lanes4 v;
    v.x = value.x;
    v.y = value.y;
    v.z = value.z;
    v.w = value.w;
    return v;
}

APSLK_INLINE lanes load_corner_values(__global const uint* triangles, __global const float* values, uint first,
                                      uint corner) {
    return values[triangles[3u * first + corner]];
}

APSLK_INLINE lanes load_lanes(__global const float* values, uint first) {
    return values[first];
}

APSLK_INLINE void store_lanes(lanes value, __global float* values, uint first) {
    values[first] = value;
}

APSLK_INLINE lanes private_lanes(const float* values, uint n) {
    return values[n];
}

APSLK_INLINE void store_private_lanes(lanes value, float* values) {
    values[0] = value;
}

APSLK_INLINE float sum_of_lanes(lanes v) {
    return v;
}

APSLK_INLINE float max_of_lanes(lanes v) {
    return v;
}

APSLK_INLINE void store_records(const lanes_int words[8], __global int4* records, uint first) {
    records[2u * first] = (int4)(words[0], words[1], words[2], words[3]);
    records[2u * first + 1] = (int4)(words[4], words[5], words[6], words[7]);
}

APSLK_INLINE lanes_int to_int(lanes v) {
    return (int)v;
}

APSLK_INLINE lanes_int bits_of(lanes v) {
    return as_int(v);
}

#endif

APSLK_INLINE lanes4 minus(lanes4 a, lanes4 b) {
    lanes4 c;
    c.x = a.x - b.x;
    c.y = a.y - b.y;
    c.z = a.z - b.z;
    c.w = 0.0f;
    return c;
}

APSLK_INLINE lanes4 cross_product(lanes4 a, lanes4 b) {
    lanes4 c;
    c.x = a.y * b.z - a.z * b.y;
    c.y = a.z * b.x - a.x * b.z;
    c.z = a.x * b.y - a.y * b.x;
    c.w = 0.0f;
    return c;
}

APSLK_INLINE lanes squared_length(lanes4 a) {
    return a.x * a.x + a.y * a.y + a.z * a.z;
}

#endif

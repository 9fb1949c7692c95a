// SPDX-License-Identifier: MIT
// How a launch is divided, and how its results are summed, always in the same order: same input, same bytes.
//
// A launch has get_num_groups(0) work-groups for every cloth, and the cloths along dimension 1. Each group owns one
// contiguous chunk; its work-items stride through it. With one work-item a group (what suits a CPU) that is a plain
// loop; with many it is coalesced. Nothing depends on how many work-items run in lockstep.
#ifndef APSLK_WORK_GROUP_H
#define APSLK_WORK_GROUP_H

#include "layout.h"

#ifndef APSLK_WORK_GROUP_SIZE
#define APSLK_WORK_GROUP_SIZE 64
#endif

#define APSLK_KERNEL __kernel __attribute__((reqd_work_group_size(APSLK_WORK_GROUP_SIZE, 1, 1)))

typedef struct {
    uint first, end;  // this work-item takes first, first + APSLK_WORK_GROUP_SIZE, … below end
} apslk_range;

// In a kernel that is launched with one work-group a cloth: the compiler then knows every share, and holds fewer
// values. On AMD alone, where registers are what limits: Oclgrind has no such intrinsic.
APSLK_INLINE void assume_one_group(void) {
#ifdef __AMDGCN__
    __builtin_assume(get_num_groups(0) == 1);
    __builtin_assume(get_group_id(0) == 0);
#endif
}

// This work-item's share of `count` elements, or nothing where the launch has nothing to do. Chunks begin at multiples
// of 16 elements. An empty range, not an early return: barriers follow.
APSLK_INLINE apslk_range share_of(uint count, bool active) {
    const uint groups = (uint)get_num_groups(0);
    const uint chunk = ((count + groups - 1u) / groups + 15u) & ~15u;
    const uint begin = min((uint)get_group_id(0) * chunk, count);
    apslk_range range;
    range.end = active ? min(begin + chunk, count) : 0u;
    range.first = begin + (uint)get_local_id(0);
    return range;
}

// Local memory written by the group's work-items before, readable by all of them after.
APSLK_INLINE void group_barrier(void) {
#if APSLK_WORK_GROUP_SIZE > 1
    barrier(CLK_LOCAL_MEM_FENCE);
#endif
}

// Likewise for local and global memory.
APSLK_INLINE void group_memory_barrier(void) {
#if APSLK_WORK_GROUP_SIZE > 1
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
#endif
}

#if APSLK_WORK_GROUP_SIZE > 1
#define APSLK_SCRATCH __local float scratch[APSLK_WORK_GROUP_SIZE]
#else
#define APSLK_SCRATCH __local float scratch[1]
#endif

// Sum over the work-group, given to every work-item. Halving, over a power of two fixed at compile time. The result is
// read once, as volatile: pocl 7.1 reads it again where it is used, after other sums have been there.
APSLK_INLINE float group_sum(float value, __local float* scratch) {
#if APSLK_WORK_GROUP_SIZE > 1
    const uint l = (uint)get_local_id(0);
    scratch[l] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint half_size = APSLK_WORK_GROUP_SIZE / 2; half_size > 0; half_size >>= 1) {
        if (l < half_size) scratch[l] += scratch[l + half_size];
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    value = *(volatile __local float*)scratch;
    barrier(CLK_LOCAL_MEM_FENCE);
#else
    (void)scratch;
#endif
    return value;
}

// Greatest over the work-group, given to every work-item.
APSLK_INLINE float group_max(float value, __local float* scratch) {
#if APSLK_WORK_GROUP_SIZE > 1
    const uint l = (uint)get_local_id(0);
    scratch[l] = value;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint half_size = APSLK_WORK_GROUP_SIZE / 2; half_size > 0; half_size >>= 1) {
        if (l < half_size) scratch[l] = fmax(scratch[l], scratch[l + half_size]);
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    value = *(volatile __local float*)scratch;
    barrier(CLK_LOCAL_MEM_FENCE);
#else
    (void)scratch;
#endif
    return value;
}

// Numbers of a vector of triangles that a work-item takes at once. On a CPU four, side by side; otherwise one, so that
// a cloth of few triangles leaves no lane without work.
#if APSLK_WORK_GROUP_SIZE == 1
#define APSLK_NUMBERS 4u
typedef float4 numbers;
APSLK_INLINE float sum_of_numbers(numbers v) {
    return v.x + v.y + v.z + v.w;
}
#else
#define APSLK_NUMBERS 1u
typedef float numbers;
APSLK_INLINE float sum_of_numbers(numbers v) {
    return v;
}
#endif

// The partial results of one kind, one float for each of `groups` groups, of the cloth of this work-group.
APSLK_INLINE __global float* partials_of(__global float* partials, uint kind, uint groups) {
    return partials + ((uint)get_group_id(1) * APSLK_PARTIAL_KINDS + kind) * groups;
}

// Sum of a kind's partial results. Every group does it anew: cheaper than a launch in between. All work-items go round
// equally often: where they need not, pocl 6's LLVM 18 crashes over some kernels in groups of 2.
APSLK_INLINE float sum_partials(__global float* partials, uint kind, uint groups, __local float* scratch) {
    __global const float* p = partials_of(partials, kind, groups);
    float sum = 0.0f;
    for (uint first = 0; first < groups; first += APSLK_WORK_GROUP_SIZE) {
        const uint g = first + (uint)get_local_id(0);
        if (g < groups) sum += p[g];
    }
    return group_sum(sum, scratch);
}

APSLK_INLINE float max_partials(__global float* partials, uint kind, uint groups, __local float* scratch) {
    __global const float* p = partials_of(partials, kind, groups);
    float greatest = -FLT_MAX;
    for (uint first = 0; first < groups; first += APSLK_WORK_GROUP_SIZE) {
        const uint g = first + (uint)get_local_id(0);
        if (g < groups) greatest = fmax(greatest, p[g]);
    }
    return group_max(greatest, scratch);
}

// Stores this group's partial result.
APSLK_INLINE void store_partial(__global float* partials, uint kind, float value) {
    if (get_local_id(0) == 0) partials_of(partials, kind, (uint)get_num_groups(0))[get_group_id(0)] = value;
}

#endif

// SPDX-License-Identifier: MIT
// Bending in a small step, between what starts the step's parts and the next solve (docs/formulation.md, Bending).
// bend_hinges linearises every hinge; bend_vertices then evaluates the polynomial, a launch for each of its degrees,
// and adds to velocities and positions. Reference: apsl::reference, bending. bend_hinges moves 16 B indices, 4 B order,
// 8 B rest state, 4 × (40 B, mostly from cache) read, 36 B written a hinge; bend_vertices 80 B read and 64 B written a
// vertex, and 40 B read (later 104 B), mostly from cache, for each of its 12 hinges.
#include "bending_polynomial.h"
#include "free_motion.h"
#include "hinges.h"
#include "layout.h"
#include "work_group.h"

// Whether a cloth bends in evaluation `iteration` of part `part` of its small steps.
APSLK_INLINE bool bends_in(apslk_parameters parameters, apslk_solve_state state, int part, int iteration) {
    return !state.stopped && part < parameters.small_steps && parameters.bending > 0.0f &&
           iteration < parameters.bending_iterations;
}

// Where a vertex was at the start of the part, and a little ahead by the velocity that it had there. `moved` and
// `motion` are those after acceleration, damping and the move.
APSLK_INLINE float3 ahead_of_start(float4 moved, float4 motion, float time_step, float duration, apslk_free_part free,
                                   uint place) {
    const float3 velocity = motion.xyz / time_step;
    const float3 before = motion.w > 0.0f ? velocity / free.kept - gain_of_free_part(free, place) : velocity;
    return moved.xyz + duration * (APSLK_BENDING_LEAD * before - velocity);
}

// Gradients times √k, and moments √k (θ − θ⁰). Hinges of cloth c: hinge_offsets[c] to hinge_offsets[c + 1]. In the
// first and in the last part also the energy Σ ½ k (θ − θ⁰)² that they hold.
APSLK_KERNEL void bend_hinges(__global const apslk_parameters* parameters, __global const apslk_solve_state* states,
                              __global float* partials, __global const uint* hinge_offsets,
                              __global const uint* hinge_order, __global const uint4* hinges,
                              __global const uint* hinge_corner_offsets, __global const float4* moved,
                              __global const float4* motion, __global apslk_hinge_gradients* gradients,
                              __global float* moments, __global const float* rest_hinges, ulong rest_hinge_offset,
                              int part APSLK_ACCELERATIONS_ARGUMENT) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const uint first_hinge = hinge_offsets[c];
    const apslk_range range = share_of(hinge_offsets[c + 1] - first_hinge, bends_in(parameters[c], states[c], part, 0));
    const float time_step = parameters[c].time_step, duration = time_step / (float)max(parameters[c].small_steps, 1);
    const apslk_free_part free = free_part(parameters + c, APSLK_ACCELERATIONS);
    const float reach = bending_step(parameters[c].bending_iterations, 0).reach;
    float energy = 0.0f;
    for (uint h = range.first; h < range.end; h += APSLK_WORK_GROUP_SIZE) {
        const uint r = first_hinge + h;
        const uint4 v = hinges[r];
        const uint vertices[4] = {v.x, v.y, v.z, v.w};
        float3 x[4];
        float weights[4];
        for (uint n = 0; n < 4; ++n) {
            const uint i = vertices[n];
            const float4 step = motion[i];
            x[n] = ahead_of_start(moved[i], step, time_step, duration, free, i);
            weights[n] = step.w * (float)(hinge_corner_offsets[i + 1] - hinge_corner_offsets[i]);
        }
        const apslk_hinge_geometry hinge = hinge_geometry(x[0], x[1], x[2], x[3]);
        float greatest = 0.0f, sum = 0.0f;
        for (uint n = 0; n < 4; ++n) {
            const float size = length(hinge_gradient(hinge.gradients, n));
            greatest = fmax(greatest, weights[n] * size);
            sum += size;
        }
        const float2 rest = vload2(hinge_order[r], rest_hinges + rest_hinge_offset);
        const float asked = parameters[c].bending * rest.y, unit = duration * duration * greatest * sum;
        const float root = sqrt(asked * unit > reach ? reach / unit : asked);
        gradients[r].at_first = (float4)(root * hinge.gradients.at_first.xyz, hinge.gradients.at_first.w);
        gradients[r].at_second = (float4)(root * hinge.gradients.at_second.xyz, hinge.gradients.at_second.w);
        // Not remainder(), nor hypot() elsewhere: AMD's newer device libraries compute them in double precision.
        const float turn = 2.0f * M_PI_F, bent = hinge.angle - rest.x;
        const float moment = root * (bent - turn * rint(bent / turn));
        moments[r] = moment;
        energy += 0.5f * moment * moment;
    }
    const float held = group_sum(energy, scratch);
    if (part == 0)
        store_partial(partials, APSLK_PARTIAL_BENDING_ENERGY, held);
    else if (part + 1 == parameters[c].small_steps)
        store_partial(partials, APSLK_PARTIAL_BENDING_LEFT, held);
}

// A hinge's gradients times the steps of its vertices.
APSLK_INLINE float hinge_product(apslk_hinge_gradients gradients, uint4 v, __global const float4* steps) {
    return dot(hinge_gradient(gradients, 0u), steps[v.x].xyz) + dot(hinge_gradient(gradients, 1u), steps[v.y].xyz) +
           dot(hinge_gradient(gradients, 2u), steps[v.z].xyz) + dot(hinge_gradient(gradients, 3u), steps[v.w].xyz);
}

// `steps`: of the iteration before; `next_steps` of this one.
APSLK_KERNEL void bend_vertices(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                __global const apslk_solve_state* states, __global const uint4* hinges,
                                __global const uint* hinge_corner_offsets, __global const uint* hinge_corners,
                                __global const apslk_hinge_gradients* gradients, __global const float* moments,
                                __global float4* residuals, __global const float4* steps, __global float4* next_steps,
                                __global float4* moved, __global float4* motion, int part, int iteration) {
    const uint c = (uint)get_group_id(1);
    const apslk_cloth cloth = cloths[c];
    const apslk_range range = share_of(cloth.vertex_count, bends_in(parameters[c], states[c], part, iteration));
    const float time_step = parameters[c].time_step, duration = time_step / (float)max(parameters[c].small_steps, 1);
    const apslk_bending_step polynomial = bending_step(parameters[c].bending_iterations, iteration);
    const bool goes_on = iteration + 1 < parameters[c].bending_iterations;
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint i = cloth.vertex_begin + v;
        const float inverse_mass = motion[i].w;
        float3 sum = (float3)(0.0f);
        const uint end = inverse_mass > 0.0f ? hinge_corner_offsets[i + 1] : 0u;
        for (uint n = hinge_corner_offsets[i]; n < end; ++n) {
            const uint corner = hinge_corners[n], r = APSLK_HINGE(corner);
            const apslk_hinge_gradients hinge = gradients[r];
            const float factor = iteration == 0 ? moments[r] : hinge_product(hinge, hinges[r], steps);
            sum += factor * hinge_gradient(hinge, APSLK_HINGE_NUMBER(corner));
        }
        float3 residual, step;
        if (iteration == 0) {
            residual = -polynomial.scale * duration * inverse_mass * sum;
            step = polynomial.gain * residual;
        } else {
            residual = residuals[i].xyz - duration * duration * inverse_mass * sum;
            step = polynomial.momentum * steps[i].xyz + polynomial.gain * residual;
        }
        if (goes_on) {
            residuals[i] = (float4)(residual, 0.0f);
            next_steps[i] = (float4)(step, 0.0f);
        }
        if (inverse_mass > 0.0f) {
            moved[i].xyz += duration * step;
            motion[i].xyz += time_step * step;
        }
    }
}

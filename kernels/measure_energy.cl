// SPDX-License-Identifier: MIT
// The kinetic energy of a whole step, that of acceleration and damping alone and that of its last small step, both
// twice and in the frame of what drives the cloth. Reference: apsl::reference, energy_bound. Moves 4 B order, 12 B
// position, 12 B velocity, 16 B end, 16 B motion a vertex (strides of 3), with contacts 32 B more, with accelerations
// 16 B.
#include "caller_vectors.h"
#include "energy_bound.h"
#include "free_motion.h"
#include "layout.h"
#include "work_group.h"

APSLK_KERNEL void measure_energy(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                 __global apslk_solve_state* states, __global float* partials,
                                 __global const uint* vertex_order, __global const float4* moved,
                                 __global const float4* motion, __global const float* positions, ulong position_offset,
                                 __global const float* velocities, ulong velocity_offset,
                                 __global const float* contacts, ulong contact_offset APSLK_ACCELERATIONS_ARGUMENT) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apslk_drive drive = find_drive(partials, (uint)get_num_groups(0), scratch);
    const apslk_free_step free = free_step(parameters + c, APSLK_ACCELERATIONS);
    const float time_step = parameters[c].time_step;
    const apslk_cloth cloth = cloths[c];
    const apslk_range range = share_of(cloth.vertex_count, parameters[c].enabled);
    float before = 0.0f, left = 0.0f, gained = 0.0f, alone = 0.0f, along = 0.0f, pulling = 0.0f;
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, vertex = vertex_order[place];
        const float4 step = motion[place];
        if (!(step.w > 0.0f)) continue;
        const float3 given = load_velocity(velocities + velocity_offset, vertex);
        const float3 start = load_position(positions + position_offset, vertex);
        const float3 unlimited = after_free_step(free, place, given, step.w);
        const float3 own = unlimited - drive.velocity;
        const float3 limited = step.xyz / time_step - drive.velocity;
        const float free_energy = dot(own, own) / step.w, energy = dot(limited, limited) / step.w;
        // What acceleration gives on the way that the vertex went, not on that of the free step.
        const float3 change = (moved[place].xyz - start) / time_step;
        const float followed = dot(gain_of_free_step(free, place), 2.0f * change - (given + unlimited));
        before += free_energy + followed / step.w;
        left += energy;
        gained += fmax(energy - free_energy, 0.0f);
        const float3 mean = mean_of_free_step(free, place, given, step.w);
        if (comes_near(predicted_position(start, mean, time_step), unlimited, time_step, contacts + contact_offset,
                       vertex)) {
            bool pulls;
            const float added =
                added_by_body(unlimited, drive.velocity, contacts + contact_offset, vertex, &pulls) / step.w;
            alone += pulls ? 0.0f : added;
            along += pulls ? added : 0.0f;
            pulling += pulls ? 1.0f / step.w : 0.0f;
        }
    }
    store_partial(partials, APSLK_PARTIAL_FREE_ENERGY, group_sum(before, scratch));
    store_partial(partials, APSLK_PARTIAL_LEFT_ENERGY, group_sum(left, scratch));
    store_partial(partials, APSLK_PARTIAL_GAINED_ENERGY, group_sum(gained, scratch));
    store_partial(partials, APSLK_PARTIAL_ADDED_ALONE, group_sum(alone, scratch));
    store_partial(partials, APSLK_PARTIAL_ADDED_ALONG, group_sum(along, scratch));
    store_partial(partials, APSLK_PARTIAL_PULLING, group_sum(pulling, scratch));
    if (get_group_id(0) == 0 && get_local_id(0) == 0) {
        vstore3(drive.velocity, 0, states[c].drive);
        states[c].pins = drive.pins;
        states[c].mass = drive.mass;
        states[c].flies = drive.flies;
    }
}

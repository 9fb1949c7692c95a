// SPDX-License-Identifier: MIT
// The kinetic energy of a whole step, that of acceleration and damping alone and that of its last small step, both
// twice and in the frame of what drives the cloth. The w of `total_correction` becomes 1 for a vertex at a triangle
// outside its limits and 0 for any other. Reference: apsl::reference, energy_bound. Moves 4 B order, 12 B velocity, 16
// B motion, 24 B corners, 24 B of triangles read, 16 B written a vertex (strides of 3), with contacts 32 B more, with
// accelerations 16 B.
#include "caller_vectors.h"
#include "energy_bound.h"
#include "free_motion.h"
#include "layout.h"
#include "unmet_limits.h"
#include "work_group.h"

APSLK_KERNEL void measure_energy(__global const apslk_cloth* cloths, __global const apslk_parameters* parameters,
                                 __global apslk_solve_state* states, __global float* partials,
                                 __global const uint* vertex_order, __global const uint* corner_offsets,
                                 __global const uint* corners, __global const float* unmet,
                                 __global const float4* motion, __global float4* total_correction,
                                 __global const float* velocities, ulong velocity_offset,
                                 __global const float* contacts, ulong contact_offset APSLK_ACCELERATIONS_ARGUMENT) {
    APSLK_SCRATCH;
    const uint c = (uint)get_group_id(1);
    const apslk_drive drive = find_drive(partials, (uint)get_num_groups(0), scratch);
    const apslk_free_step free = free_step(parameters + c, APSLK_ACCELERATIONS);
    const apslk_cloth cloth = cloths[c];
    const apslk_range range = share_of(cloth.vertex_count, parameters[c].enabled);
    float before = 0.0f, left_unmet = 0.0f, left_met = 0.0f, added = 0.0f;
    for (uint v = range.first; v < range.end; v += APSLK_WORK_GROUP_SIZE) {
        const uint place = cloth.vertex_begin + v, vertex = vertex_order[place];
        const float4 step = motion[place];
        if (!(step.w > 0.0f)) continue;
        const float3 given = load_velocity(velocities + velocity_offset, vertex);
        const float3 unlimited = after_free_step(free, place, given, step.w);
        const float3 own = unlimited - drive.velocity;
        const float3 limited = step.xyz / parameters[c].time_step - drive.velocity;
        before += dot(own, own) / step.w;
        const float left = dot(limited, limited) / step.w;
        const bool slowed_first = is_unmet(corner_offsets, corners, unmet, place);
        left_unmet += slowed_first ? left : 0.0f;
        left_met += slowed_first ? 0.0f : left;
        total_correction[place] = (float4)(0.0f, 0.0f, 0.0f, slowed_first ? 1.0f : 0.0f);
        added += added_by_body(unlimited, drive.velocity, contacts + contact_offset, vertex) / step.w;
    }
    store_partial(partials, APSLK_PARTIAL_FREE_ENERGY, group_sum(before, scratch));
    store_partial(partials, APSLK_PARTIAL_UNMET_ENERGY, group_sum(left_unmet, scratch));
    store_partial(partials, APSLK_PARTIAL_MET_ENERGY, group_sum(left_met, scratch));
    store_partial(partials, APSLK_PARTIAL_ADDED_BY_BODIES, group_sum(added, scratch));
    if (get_group_id(0) == 0 && get_local_id(0) == 0) {
        vstore3(drive.velocity, 0, states[c].drive);
        states[c].pins = drive.pins;
        states[c].mass = drive.mass;
        states[c].flies = drive.flies;
    }
}

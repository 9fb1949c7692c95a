// SPDX-License-Identifier: MIT
//
// What each vertex is held off in a step: pipeline/contacts.hpp says how the plane is chosen, contacts() there is the
// reference. Reads 28 B a vertex and the colliders, writes 32 B a vertex.

// During a step, as ContactCollider on the host.
typedef struct {
    float place[3];  // m, at the end of the step: an end of a capsule's axis, a sphere's centre, a point of a plane
    float reach;     // m, from there or the axis to where cloth is held: radius and thickness
    float axis[3];   // m, to the other end of the axis, zeros for a sphere; of a plane its unit normal
    uint is_plane;
    float turning[9];  // 1/s, row by row: what is at p at the end of the step has come there with turning p + drift
    float drift[3];    // m/s
    float friction;
    uint padding[3];
} contact_collider;

// SAME_SIDE, TOUCHING, MOST_TRACED, START_DEPTH and TIME_TO_LEAVE are the reference's, given by
// run/opencl_contacts.cpp.

static inline __attribute__((always_inline)) float3 xyz(global const float* numbers) {
    return (float3)(numbers[0], numbers[1], numbers[2]);
}

// A unit vector across `axis` (unit or zero) for a place on the axis itself.
static inline __attribute__((always_inline)) float3 any_way_out(const float3 axis, const float3 back) {
    const float3 candidates[3] = {back, (float3)(0.0f, 1.0f, 0.0f), (float3)(1.0f, 0.0f, 0.0f)};
    for (int n = 0; n < 3; ++n) {
        const float3 across = candidates[n] - dot(axis, candidates[n]) * axis;
        if (length(across) > 1e-4f * length(candidates[n])) return normalize(across);
    }
    return (float3)(1.0f, 0.0f, 0.0f);
}

// Unit normal and, in w, the distance in m, negative inside.
static inline __attribute__((always_inline)) float4 surface_at(global const contact_collider* collider,
                                                               const float3 place, const float3 start) {
    const float3 base = xyz(collider->place), axis = xyz(collider->axis);
    if (collider->is_plane) return (float4)(axis, dot(axis, place - base) - collider->reach);
    const float squared_length = dot(axis, axis);
    const float along = squared_length > 0.0f ? clamp(dot(axis, place - base) / squared_length, 0.0f, 1.0f) : 0.0f;
    const float3 closest = base + along * axis;
    const float3 offset = place - closest;
    const float away = length(offset);
    const float3 unit_axis = squared_length > 0.0f ? axis * rsqrt(squared_length) : (float3)(0.0f);
    const float3 normal = away > 0.0f ? offset / away : any_way_out(unit_axis, start - closest);
    return (float4)(normal, away - collider->reach);
}

static inline __attribute__((always_inline)) float3 velocity_at(global const contact_collider* collider,
                                                                const float3 place) {
    return (float3)(dot(xyz(collider->turning), place), dot(xyz(collider->turning + 3), place),
                    dot(xyz(collider->turning + 6), place)) +
           xyz(collider->drift);
}

// Where to lay the plane. `start`: where the step begins, carried along with the collider.
static inline __attribute__((always_inline)) float3 place_of_contact(global const contact_collider* collider,
                                                                     const float3 start, const float3 end) {
    const float4 at_start = surface_at(collider, start, start), at_end = surface_at(collider, end, start);
    if (dot(at_start.xyz, at_end.xyz) >= SAME_SIDE) return end;
    const float3 way = end - start;
    float3 nearest = start;
    float least = at_start.w, distance_now = at_start.w, share = 0.0f;
    for (int n = 0; n < MOST_TRACED && least > TOUCHING && share < 1.0f; ++n) {
        share += distance_now / length(way);
        const float3 place = share < 1.0f ? start + share * way : end;
        distance_now = surface_at(collider, place, start).w;
        if (distance_now < least) {
            least = distance_now;
            nearest = place;
        }
    }
    return nearest;
}

// `contacts`: unit normal, offset, velocity, friction; 8 floats a vertex. Free flight ends at x + flight_seconds v +
// (shift_x, shift_y, shift_z).
kernel void fill_contacts(const uint vertex_count, const uint collider_count, const float time_step,
                          const float flight_seconds, const float shift_x, const float shift_y, const float shift_z,
                          global const contact_collider* colliders, global const float* inverse_masses,
                          global const float* positions, global const float* velocities, global float* contacts) {
    const uint v = get_global_id(0);
    if (v >= vertex_count) return;
    const float3 position = vload3(v, positions);
    const float3 end = position + flight_seconds * vload3(v, velocities) + (float3)(shift_x, shift_y, shift_z);
    float least_gap = INFINITY;
    float8 record = (float8)(0.0f);
    for (uint n = 0; n < collider_count && inverse_masses[v] > 0.0f; ++n) {
        global const contact_collider* collider = colliders + n;
        const float3 start = position + time_step * velocity_at(collider, position);
        const float3 place = place_of_contact(collider, start, end);
        const float4 met = surface_at(collider, place, start);
        const float3 normal = met.xyz;
        const float depth = -surface_at(collider, start, start).w;
        const float allowed = depth > START_DEPTH ? depth * (1.0f - fmin(1.0f, time_step / TIME_TO_LEAVE)) : 0.0f;
        const float offset = dot(normal, place) - met.w - allowed;
        const float gap = dot(normal, end) - offset;
        if (gap < least_gap) {
            least_gap = gap;
            float3 velocity = velocity_at(collider, place - met.w * normal);
            const float led_out = fmax(depth, 0.0f) - allowed;
            const float rise = (offset - led_out - dot(normal, position)) / time_step - dot(normal, velocity);
            velocity += fmax(rise, 0.0f) * normal;
            record = (float8)(normal, offset, velocity, collider->friction);
        }
    }
    vstore8(record, v, contacts);
}

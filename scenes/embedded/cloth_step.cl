// SPDX-License-Identifier: MIT
//
// What moves the cloth before and after apsl limits its strain. Until `advance`, positions are those of the start of
// the step and everything happens to the velocities, which the limiter reads as x + Δt v. Inverse mass 0 is a pin.

typedef struct {
    uint other;         // the vertex at the other end
    float rest_length;  // m
    float stiffness;    // share of the error that one pass takes back; over a vertex's springs the sum stays below 2
} Spring;

// v ← (v + Δt g) · damping
kernel void predict(const uint vertex_count, const float time_step, const float gravity, const float damping,
                    global const float* inverse_masses, global float* velocities) {
    const uint v = get_global_id(0);
    if (v >= vertex_count) return;
    const float3 velocity = (vload3(v, velocities) + time_step * (float3)(0.0f, gravity, 0.0f)) * damping;
    vstore3(inverse_masses[v] > 0.0f ? velocity : (float3)(0.0f), v, velocities);
}

// One Jacobi pass of position based dynamics (Müller et al. 2007, Section 3.3) over stretch and bending springs alike,
// on x + Δt v. Each vertex gathers from its springs: no atomics, so the same bytes every time.
kernel void relax_springs(const uint vertex_count, const float time_step, global const uint* offsets,
                          global const Spring* springs, global const float* inverse_masses,
                          global const float* positions, global const float* velocities, global float* relaxed) {
    const uint v = get_global_id(0);
    if (v >= vertex_count) return;
    const float3 velocity = vload3(v, velocities);
    const float3 here = vload3(v, positions) + time_step * velocity;
    const float weight = inverse_masses[v];
    float3 correction = (float3)(0.0f);
    for (uint n = offsets[v]; weight > 0.0f && n < offsets[v + 1]; ++n) {
        const Spring spring = springs[n];
        const float3 along = vload3(spring.other, positions) + time_step * vload3(spring.other, velocities) - here;
        const float excess = 1.0f - spring.rest_length / fmax(length(along), 1e-9f);
        correction += spring.stiffness * weight / (weight + inverse_masses[spring.other]) * excess * along;
    }
    vstore3(velocity + correction / time_step, v, relaxed);
}

// x ← x + Δt v, out of the sphere (centre, radius), with Coulomb friction on it.
kernel void advance(const uint vertex_count, const float time_step, const float4 sphere, const float friction,
                    global const float* inverse_masses, global float* positions, global float* velocities) {
    const uint v = get_global_id(0);
    if (v >= vertex_count || inverse_masses[v] == 0.0f) return;
    float3 velocity = vload3(v, velocities);
    float3 position = vload3(v, positions) + time_step * velocity;
    const float3 from_center = position - sphere.xyz;
    const float distance_now = length(from_center);
    if (distance_now < sphere.w) {
        const float3 normal = from_center / fmax(distance_now, 1e-9f);
        const float approach = fmin(dot(velocity, normal), 0.0f);
        const float3 sliding = velocity - dot(velocity, normal) * normal;
        const float grip = fmin(-friction * approach / fmax(length(sliding), 1e-9f), 1.0f);
        velocity -= approach * normal + grip * sliding;
        position = sphere.xyz + sphere.w * normal;
    }
    vstore3(position, v, positions);
    vstore3(velocity, v, velocities);
}

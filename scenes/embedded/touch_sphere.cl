// SPDX-License-Identifier: MIT

// What each vertex may touch in a step, as apsl's Buffers::contacts has it: of a moving sphere the tangent plane
// beneath the place that the vertex flies to. start, end: the sphere's centre when the step begins and ends, m.
kernel void touch_sphere(const float4 start, const float4 end, const float reach, const float friction,
                         const float time_step, const uint vertex_count, global const float* positions,
                         global const float* velocities, global float* contacts) {
    const uint v = get_global_id(0);
    if (v >= vertex_count) return;
    const float3 flight_end = vload3(v, positions) + time_step * vload3(v, velocities);
    const float3 normal = normalize(flight_end - end.xyz);  // at the centre itself zeros: nothing to touch
    const float3 velocity = (end.xyz - start.xyz) / time_step;
    vstore8((float8)(normal, dot(normal, end.xyz) + reach, velocity, friction), v, contacts);
}

// SPDX-License-Identifier: MIT
//
// Pinned vertices to where their motion has them at the start of a step, with the velocity that takes them to its end
// (pipeline/pins.hpp). `states`: position in m and velocity in m/s of each of `vertices`, 6 floats. Reads 28 B and
// writes 24 B a pinned vertex.
kernel void place_pins(const uint count, global const uint* vertices, global const float* states,
                       global float* positions, global float* velocities) {
    const uint n = get_global_id(0);
    if (n >= count) return;
    vstore3(vload3(2 * n, states), vertices[n], positions);
    vstore3(vload3(2 * n + 1, states), vertices[n], velocities);
}

// SPDX-License-Identifier: MIT
// Thirty-two values alive at once in sixteen registers.
__kernel __attribute__((amdgpu_num_vgpr(16))) void spill(__global float* values, __global const int* order) {
    float copies[32];
    for (int i = 0; i < 32; ++i) copies[i] = values[i * get_global_id(0)];
    barrier(CLK_GLOBAL_MEM_FENCE);
    for (int i = 0; i < 32; ++i) values[order[i]] = copies[i] * copies[31 - i];
}

// SPDX-License-Identifier: MIT
// 80,000 bytes of local memory.
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void local_memory(__global float* values) {
    __local float copies[20000];
    copies[get_local_id(0)] = values[get_global_id(0)];
    barrier(CLK_LOCAL_MEM_FENCE);
    values[get_global_id(0)] = copies[(get_local_id(0) * 17u) % 20000u];
}

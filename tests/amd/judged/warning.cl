// SPDX-License-Identifier: MIT
// A parameter nobody reads.
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void warning(__global float* values, float unused) {
    values[get_global_id(0)] = 1.0f;
}

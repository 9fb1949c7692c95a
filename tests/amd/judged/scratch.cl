// SPDX-License-Identifier: MIT
// A private array too large for registers, indexed by what is known at run time only.
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void scratch(__global float* values,
                                                                      __global const int* order) {
    float copies[256];
    for (int i = 0; i < 256; ++i) copies[i] = values[i];
    for (int i = 0; i < 256; ++i) copies[order[i] & 255] += copies[i];
    values[get_global_id(0)] = copies[order[0] & 255];
}

// SPDX-License-Identifier: MIT
// A load through an address of which the compiler cannot tell whether it is global or local.
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void flat_access(__global const ulong* addresses,
                                                                          __global float* values) {
    values[0] = *(__attribute__((address_space(0))) float*)addresses[1];
}

// SPDX-License-Identifier: MIT
// A division that one missing f makes a double-precision one.
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void double_arithmetic(__global float* values) {
    values[get_global_id(0)] = (float)(values[get_global_id(0)] / 3.1);
}

// SPDX-License-Identifier: MIT
// A function that nothing defines, as a built-in missing from the device library would be.
float elsewhere(float value);
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void unresolved_call(__global float* values) {
    values[get_global_id(0)] = elsewhere(values[get_global_id(0)]);
}

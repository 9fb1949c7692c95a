// SPDX-License-Identifier: MIT
// Nothing wrong with this one: refused by no rule but a budget that is too small.
__kernel __attribute__((reqd_work_group_size(64, 1, 1))) void accepted(__global float* values) {
    values[get_global_id(0)] *= 2.0f;
}

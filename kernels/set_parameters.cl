// SPDX-License-Identifier: MIT
// Parameters that differ from cloth to cloth. They arrive as an argument, which the queue copies when the kernel is
// queued: nothing of the caller's has to outlive the call. Moves 128 B a cloth.
#include "layout.h"
#include "work_group.h"

APSLK_KERNEL void set_parameters(__global apslk_parameters* parameters, apslk_parameter_block block, uint first,
                                 uint count) {
    if (get_global_id(0) != 0) return;
    // Unrolled, so that the block is never indexed by a variable and stays out of memory.
    __attribute__((opencl_unroll_hint)) for (uint n = 0; n < APSLK_PARAMETER_BLOCK; ++n)
        if (n < count) parameters[first + n] = block.entry[n];
}

// SPDX-License-Identifier: MIT
// Whether triangles have a second row in every system, of their greatest principal stretch (kernels/stretch_rows.h).
// What is kept for a row (gradients, right-hand side, multiplier) then has a run for areas and one for stretches.
#ifndef APSLK_LIMITS_STRETCH_H
#define APSLK_LIMITS_STRETCH_H

#ifndef APSLK_LIMITS_STRETCH
#define APSLK_LIMITS_STRETCH 0
#endif

#endif

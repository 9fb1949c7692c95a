// SPDX-License-Identifier: MIT
// What acts in small steps beside the limits: bending, and tethers. The step without a limit that a result is compared
// with has neither. Reference: apsl::reference, strain_limiter.
#ifndef APSLK_ACTS_IN_PARTS_H
#define APSLK_ACTS_IN_PARTS_H

// Whether hinges resist bending.
#ifndef APSLK_BENDS
#define APSLK_BENDS 0
#endif
// Tethers a vertex.
#ifndef APSLK_TETHERS
#define APSLK_TETHERS 0
#endif

#define APSLK_ACTS_IN_PARTS (APSLK_BENDS || APSLK_TETHERS)

#endif

// SPDX-License-Identifier: MIT
// Whether hinges resist bending (docs/formulation.md, Bending).
#ifndef APSLK_BENDS_H
#define APSLK_BENDS_H

#ifndef APSLK_BENDS
#define APSLK_BENDS 0
#endif

#endif

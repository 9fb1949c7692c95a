// SPDX-License-Identifier: MIT
#pragma once

#include "support/device_cloth.hpp"

namespace apsl::test {

/// A cloth of 5×5, for tests that look at what a call takes and not at what it makes of it.
inline const MovingCloth& cloth() {
    static const MovingCloth made = moving_cloth(grid(5, 5, 1.0, 1.0, Diagonals::alternating), 1);
    return made;
}

/// Of that cloth.
inline StrainLimiter limiter(const Options& options = {}, const BufferView& scratch = {}) {
    return {device().context, device().id, cloth().topology, options, {}, scratch};
}

}  // namespace apsl::test

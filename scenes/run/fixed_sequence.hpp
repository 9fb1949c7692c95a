// SPDX-License-Identifier: MIT
#pragma once

#include <random>

namespace apsl::scenes {

/// Numbers that look random and are the same in every run.
/// The standard fixes the sequence of mt19937 but not what its distributions make of it, so the scaling is ours: the
/// same scene gives the same mesh with every standard library.
class FixedSequence {
public:
    /// In [−1, 1).
    double symmetric() { return static_cast<double>(generator_()) * 0x1p-31 - 1.0; }
    bool coin() { return (generator_() & 0x80000000u) != 0; }

private:
    std::mt19937 generator_{20150923u};
};

}  // namespace apsl::scenes

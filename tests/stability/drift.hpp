// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace apsl::test {

/// What a stretch of a long run showed.
struct Stretch {
    int last_frame = 0;
    double kinetic_energy = 0.0;   ///< J, mean over its frames
    double total_energy = 0.0;     ///< J, kinetic and potential, mean over its frames
    double max_area_change = 0.0;  ///< greatest of its frames
    double rms_area_change = 0.0;  ///< greatest of its frames
    std::size_t resident_bytes = 0;
};

/// What counts as drift, beyond what the first stretch after settling shows.
struct DriftLimits {
    double energy = 0.0;       ///< J: how much higher the kinetic or the total energy of a later stretch may be
    double area_change = 0.0;  ///< likewise, of the greatest area change
    std::size_t bytes = 0;     ///< likewise, of the memory
};

/// One line for each quantity that grew past its limit; empty where none did. Stretches before `settled` do not count.
/// Throws std::invalid_argument where fewer than two are left.
std::vector<std::string> drift(const std::vector<Stretch>& stretches, std::size_t settled, const DriftLimits& limits);

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
#pragma once

#include "run/scene.hpp"

#include <cstdint>

namespace apsl::scenes {

/// 1.2f as 1.2: the number with the fewest digits that is the same 32-bit float.
double shortest(float value);

/// Sets steps_per_frame of a scene's JSON, and time_step so that a frame keeps its length.
template <class Json>
void set_steps_per_frame(Json& document, std::int64_t steps) {
    const Scene standard;
    const auto before = document.value("steps_per_frame", std::int64_t{standard.steps_per_frame});
    if (steps == before) return;
    document["time_step"] =
        document.value("time_step", standard.time_step) * static_cast<double>(before) / static_cast<double>(steps);
    document["steps_per_frame"] = steps;
}

}  // namespace apsl::scenes

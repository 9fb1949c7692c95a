// SPDX-License-Identifier: MIT
#include "run/scene_document.hpp"

#include <charconv>

namespace apsl::scenes {

double shortest(float value) {
    char text[32];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    double number = 0.0;
    std::from_chars(text, end, number);
    return number;
}

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>

namespace apsl {

/// By the bits of the exponent. std::isfinite is true for every number where a program is compiled with -ffast-math,
/// and its copy may be the one that the linker keeps for all.
inline bool is_finite(float number) {
    constexpr std::uint32_t exponent = 0x7f800000;
    return (std::bit_cast<std::uint32_t>(number) & exponent) != exponent;
}
inline bool is_finite(double number) {
    constexpr std::uint64_t exponent = 0x7ff0000000000000;
    return (std::bit_cast<std::uint64_t>(number) & exponent) != exponent;
}

}  // namespace apsl

// SPDX-License-Identifier: MIT
#pragma once

#include "device.hpp"

#include <cstddef>

namespace apsl::bench {

/// What the device's memory gives: a triad a = b + s·c over float4, read and write counted, B/s. The best of several
/// launches and launch styles, the filter's own among them, so that a share of it is never flattered.
/// `array_bytes`: of each of the three arrays, well above the caches.
double copy_bandwidth(const Device& device, std::size_t array_bytes);

}  // namespace apsl::bench

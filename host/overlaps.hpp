// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace apsl::host {

/// Floats that a call reads or writes: `count` elements, `stride` floats from one to the next, each of `components`
/// floats that lie `component_stride` apart.
struct FloatsInUse {
    const char* name;
    BufferView view;
    bool written;
    std::size_t count;  ///< at least 1
    std::uint32_t stride = 1;
    std::uint32_t components = 1;
    std::uint32_t component_stride = 1;

    /// From the first float to the last.
    std::size_t extent() const { return (count - 1) * stride + std::size_t{components - 1} * component_stride + 1; }
};

/// Throws Error(invalid_argument) that names the first two with a float in common that one of them writes. Elements of
/// both may alternate in one buffer. A buffer and its sub-buffers are one memory.
void check_apart(std::span<const FloatsInUse> in_use);

}  // namespace apsl::host

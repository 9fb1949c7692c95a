// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace apsl::host {

/// Floats that a call reads or writes: `count` elements, `stride` floats from one to the next, each of `components`
/// floats that lie `component_stride` apart.
struct FloatsInUse {
    const char* name = nullptr;
    BufferView view;
    bool written = false;
    std::size_t count = 1;  ///< at least 1
    std::uint32_t stride = 1;
    std::uint32_t components = 1;
    std::uint32_t component_stride = 1;

    /// From the first float to the last.
    std::size_t extent() const { return (count - 1) * stride + std::size_t{components - 1} * component_stride + 1; }
};

/// All that one call reads and writes. It is held in place: a call allocates nothing.
class MemoryInUse {
public:
    /// Throws Error(invalid_argument) where a float is that of an earlier one too and one of both writes it. Elements
    /// of both may alternate in one buffer. A buffer and its sub-buffers are one memory.
    void add(const FloatsInUse& floats);

private:
    /// A memory object that is no other's part, and where in it something begins, in floats.
    struct Place {
        cl_mem buffer;
        std::int64_t first;
    };
    struct Placed {
        FloatsInUse floats;
        Place place;
    };

    static Place place_of(const BufferView& view);

    std::array<Placed, 13> placed_{};  ///< as many as Buffers has, and the limiter's own
    std::size_t count_ = 0;
};

}  // namespace apsl::host

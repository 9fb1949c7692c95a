// SPDX-License-Identifier: MIT
#pragma once

#include "overlaps.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstddef>
#include <optional>

namespace apsl::host {

/// What a limiter's caller must have room for.
struct CallerCounts {
    std::size_t vertices = 0;
    std::size_t triangles = 0;  ///< rest areas
    std::size_t hinges = 0;     ///< 0 where nothing bends
};

/// Throws Error(invalid_argument) naming the first buffer that a call cannot use, or two that overlap. `scratch`: the
/// limiter's own, where that is the caller's memory.
void check_buffers(const Buffers& buffers, const Options& options, const CallerCounts& counts, cl_context context,
                   const std::optional<FloatsInUse>& scratch);

/// The same of what `target` is computed into from rest positions.
void check_rest_buffers(const BufferView& rest_positions, const FloatsInUse& target, const Options& options,
                        const CallerCounts& counts, cl_context context, const std::optional<FloatsInUse>& scratch);

/// What a call corrects: velocities, or the positions where there are none.
const BufferView& corrected(const Buffers& buffers);

/// `optional`, one of `buffers`, where it is given; else another: a kernel needs some buffer there even where it reads
/// none.
const BufferView& or_any(const BufferView& optional, const Buffers& buffers);

}  // namespace apsl::host

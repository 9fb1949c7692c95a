// SPDX-License-Identifier: MIT
#include "overlaps.hpp"

#include "invalid.hpp"
#include "opencl_info.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace apsl::host {
namespace {

using Whole = std::int64_t;

Whole divided_down(Whole number, Whole by) {
    return number / by - (number % by < 0 ? 1 : 0);
}

// x with a x ≡ 1 modulo m, by Euclid's algorithm; a and m have no common divisor.
Whole inverse_modulo(Whole a, Whole m) {
    Whole x = 0, next_x = 1, remainder = m, next = a % m;
    while (next != 0) {
        const Whole quotient = remainder / next;
        x = std::exchange(next_x, x - quotient * next_x);
        remainder = std::exchange(next, remainder - quotient * next);
    }
    return ((x % m) + m) % m;
}

// The least i from 0 to count_a − 1 for which there is a j from 0 to count_b − 1 with stride_a i = stride_b j + apart.
std::optional<Whole> first_meeting(Whole stride_a, Whole count_a, Whole stride_b, Whole count_b, Whole apart) {
    const Whole common = std::gcd(stride_a, stride_b);
    if (apart % common != 0) return std::nullopt;
    const Whole least = std::max<Whole>(0, -divided_down(-apart, stride_a));
    const Whole greatest = std::min(count_a - 1, divided_down(apart + stride_b * (count_b - 1), stride_a));
    // Such i are one modulo this.
    const Whole period = stride_b / common;
    const Whole from_one = ((apart / common % period) + period) % period;
    const auto one = static_cast<Whole>(static_cast<std::uint64_t>(from_one) *
                                        static_cast<std::uint64_t>(inverse_modulo(stride_a / common, period)) %
                                        static_cast<std::uint64_t>(period));
    const Whole i = least + ((one - least) % period + period) % period;
    return i <= greatest ? std::optional(i) : std::nullopt;
}

// A float that both have, counted from the start of their memory.
std::optional<Whole> common_float(const FloatsInUse& a, Whole first_a, const FloatsInUse& b, Whole first_b) {
    const auto size = [](const FloatsInUse& floats) { return static_cast<Whole>(floats.extent()); };
    if (first_a + size(a) <= first_b || first_b + size(b) <= first_a) return std::nullopt;
    for (Whole p = 0; p < a.components; ++p)
        for (Whole q = 0; q < b.components; ++q) {
            const Whole start_a = first_a + p * a.component_stride;
            const Whole start_b = first_b + q * b.component_stride;
            if (const auto i = first_meeting(a.stride, static_cast<Whole>(a.count), b.stride,
                                             static_cast<Whole>(b.count), start_b - start_a))
                return start_a + *i * a.stride;
        }
    return std::nullopt;
}

}  // namespace

MemoryInUse::Place MemoryInUse::place_of(const BufferView& view) {
    const char* doing = "asking a buffer for the one that it is part of";
    const auto whole = info<cl_mem>(clGetMemObjectInfo, view.buffer, CL_MEM_ASSOCIATED_MEMOBJECT, doing);
    std::size_t bytes = view.offset;
    if (whole) bytes += info<std::size_t>(clGetMemObjectInfo, view.buffer, CL_MEM_OFFSET, doing);
    return {whole ? whole : view.buffer, static_cast<Whole>(bytes / sizeof(float))};
}

void MemoryInUse::add(const FloatsInUse& floats) {
    const Placed added{floats, place_of(floats.view)};
    for (std::size_t n = 0; n < count_; ++n) {
        const Placed& earlier = placed_[n];
        if (earlier.place.buffer != added.place.buffer || !(earlier.floats.written || floats.written)) continue;
        const auto shared = common_float(earlier.floats, earlier.place.first, floats, added.place.first);
        if (shared)
            invalid(std::string(floats.name) + " overlaps " + earlier.floats.name + ": both have byte " +
                    std::to_string(*shared * static_cast<Whole>(sizeof(float))) + " of one buffer, and " +
                    (earlier.floats.written ? earlier.floats : floats).name + " is written");
    }
    placed_.at(count_++) = added;
}

}  // namespace apsl::host

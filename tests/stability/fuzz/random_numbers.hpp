// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>

namespace apsl::test {

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers for the same seed with every compiler and library.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    /// A stream of its own for each pair of numbers.
    Random(std::uint64_t seed, std::uint64_t stream) : state_(seed ^ (stream + 1) * 0xD1342543DE82EF95u) { next(); }

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    /// In [0, count).
    std::size_t below(std::size_t count) { return static_cast<std::size_t>(next() % count); }
    /// In [first, last].
    std::uint32_t from_to(std::uint32_t first, std::uint32_t last) {
        return first + static_cast<std::uint32_t>(below(last - first + 1));
    }
    double number(double low, double high) {
        return low + (high - low) * static_cast<double>(next() >> 11) / 9007199254740992.0;
    }
    /// Its logarithm evenly spread.
    double magnitude(double low, double high) { return std::exp(number(std::log(low), std::log(high))); }
    bool chance(double probability) { return number(0.0, 1.0) < probability; }
    template <class Value>
    Value one_of(std::initializer_list<Value> values) {
        return values.begin()[below(values.size())];
    }

private:
    std::uint64_t state_;
};

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <ctime>

namespace apsl::scenes {

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

    /// s, of all threads of the program: what other work on the machine disturbs least.
    double processor_seconds() const { return static_cast<double>(std::clock() - processor_start_) / CLOCKS_PER_SEC; }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::clock_t processor_start_ = std::clock();
};

}  // namespace apsl::scenes

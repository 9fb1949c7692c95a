// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>
#include <cstddef>
#include <fstream>
#include <stdexcept>

namespace apsl::test {

/// What this process keeps in memory, bytes (Linux). Throws std::runtime_error where the system does not say.
inline std::size_t resident_bytes() {
    std::size_t total_pages = 0;
    std::size_t resident_pages = 0;
    std::ifstream file("/proc/self/statm");
    if (!(file >> total_pages >> resident_pages)) throw std::runtime_error("/proc/self/statm cannot be read");
    return resident_pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace apsl::test

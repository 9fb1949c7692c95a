// SPDX-License-Identifier: MIT
#pragma once

#include "run/input_error.hpp"

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace apsl::test {

/// What a reader may do with any bytes: return, or throw an InputError that names the file. Another exception ends the
/// fuzzer, which keeps the bytes that led to it.
template <class Reader>
void read_or_refuse(const Reader& read) {
    try {
        read();
    } catch (const scenes::InputError& error) {
        if (std::string_view(error.what()).starts_with("file:")) return;
        std::fprintf(stderr, "an error that does not name the file: %s\n", error.what());
        std::abort();
    }
}

}  // namespace apsl::test

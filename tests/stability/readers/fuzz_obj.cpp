// SPDX-License-Identifier: MIT
#include "read_or_refuse.hpp"
#include "run/read_obj.hpp"
#include "triangles_of.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    apsl::test::read_or_refuse([&] {
        apsl::test::check_triangles_of(apsl::scenes::read_obj({reinterpret_cast<const char*>(data), size}, "file"));
    });
    return 0;
}

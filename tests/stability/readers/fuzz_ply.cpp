// SPDX-License-Identifier: MIT
#include "read_or_refuse.hpp"
#include "run/read_ply.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    apsl::test::read_or_refuse([&] {
        const apsl::scenes::Mesh mesh = apsl::scenes::read_ply({reinterpret_cast<const char*>(data), size}, "file");
        for (const apsl::Triangle& triangle : mesh.triangles)
            for (const std::uint32_t vertex : triangle)
                if (vertex >= mesh.vertex_count()) std::abort();
    });
    return 0;
}

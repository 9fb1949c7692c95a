// SPDX-License-Identifier: MIT
#include "read_or_refuse.hpp"
#include "run/parse_json.hpp"
#include "run/parse_scene.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    apsl::test::read_or_refuse([&] {
        const auto document = apsl::scenes::parse_json({reinterpret_cast<const char*>(data), size}, "file");
        apsl::scenes::parse_scene(nlohmann::json(document), "file");
    });
    return 0;
}

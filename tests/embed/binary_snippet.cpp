// SPDX-License-Identifier: MIT
//
// docs/embedding.md's snippet that keeps the program binary in a file, between the markers; quoted to the letter.
#include "embed/binary_snippet.hpp"

#include <fstream>
#include <iterator>

// [snippet]
apsl::StrainLimiter start(cl_context context, cl_device_id device, const std::shared_ptr<const apsl::Topology>& cloth,
                          const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> kept{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    return {context, device, cloth, {}, std::as_bytes(std::span(kept))};  // no file, no bytes: built from source
}

// Once, when a first call has completed.
void keep_program(const apsl::StrainLimiter& limiter, const std::filesystem::path& path) {
    if (limiter.program_binary_use() == apsl::ProgramBinaryUse::taken) return;
    const std::vector<std::byte> binary = limiter.program_binary();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));
}
// [/snippet]

// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/strain_limiter.hpp>

#include <CL/cl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace apsl::host {

/// 128-bit FNV-1a hash, low word first. Two inputs of one length that differ in a single byte never share it.
using Fingerprint = std::array<std::uint64_t, 2>;

/// What a driver's binary is good for: source, build options, the device with its driver, and the platform.
Fingerprint program_fingerprint(cl_device_id device, const std::string& source, const std::string& build_options);

/// The blob given to the caller: a header (magic, format version, program's fingerprint, size and fingerprint of what
/// follows) and the driver's bytes.
std::vector<std::byte> pack_binary(const Fingerprint& program, std::span<const std::byte> driver_binary);

/// The driver's bytes within a blob. `use` is taken where they may be shown to the driver, else why not, and
/// driver_binary is empty.
struct UnpackedBinary {
    ProgramBinaryUse use;
    std::span<const std::byte> driver_binary = {};
};
UnpackedBinary unpack_binary(std::span<const std::byte> blob, const Fingerprint& program);

}  // namespace apsl::host

// SPDX-License-Identifier: MIT
#include "program_binary.hpp"

#include "opencl_info.hpp"

#include <cstring>

namespace apsl::host {
namespace {

constexpr std::array<char, 8> magic{'a', 'p', 's', 'l', 'p', 'r', 'o', 'g'};
constexpr std::uint64_t format_version = 1;

struct Header {
    std::array<char, 8> magic;
    std::uint64_t format_version;
    Fingerprint program;
    std::uint64_t payload_size;  // bytes
    Fingerprint payload;
};
static_assert(sizeof(Header) == 56, "no padding: every byte of a header is checked");

// FNV-1a: xor with a byte, times 2^88 + 0x13b modulo 2^128 (Fowler, Noll, Vo, Eastlake: The FNV Non-Cryptographic Hash
// Algorithm).
class Hash {
public:
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) {
            constexpr std::uint64_t factor = 0x13b;
            low_ ^= std::to_integer<std::uint64_t>(byte);
            const std::uint64_t of_lower = (low_ & 0xffffffffu) * factor;
            const std::uint64_t of_upper = (low_ >> 32) * factor + (of_lower >> 32);
            high_ = high_ * factor + (of_upper >> 32) + (low_ << 24);
            low_ = (of_upper << 32) | (of_lower & 0xffffffffu);
        }
    }
    // With its length in front: "ab", "c" differs from "a", "bc".
    void add_text(const std::string& text) {
        const std::uint64_t size = text.size();
        add(std::as_bytes(std::span(&size, 1)));
        add(std::as_bytes(std::span(text)));
    }
    Fingerprint value() const { return {low_, high_}; }

private:
    std::uint64_t low_ = 0x62b821756295c58d, high_ = 0x6c62272e07bb0142;
};

Fingerprint fingerprint(std::span<const std::byte> bytes) {
    Hash hash;
    hash.add(bytes);
    return hash.value();
}

}  // namespace

Fingerprint program_fingerprint(cl_device_id device, const std::string& source, const std::string& build_options) {
    Hash hash;
    constexpr const char* asking = "asking for the names of device and platform";
    hash.add_text(source);
    hash.add_text(build_options);
    for (const cl_device_info what : {CL_DEVICE_NAME, CL_DEVICE_VENDOR, CL_DEVICE_VERSION, CL_DRIVER_VERSION})
        hash.add_text(info_text(clGetDeviceInfo, device, what, asking));
    const auto platform =
        info<cl_platform_id>(clGetDeviceInfo, device, CL_DEVICE_PLATFORM, "asking the device for its platform");
    for (const cl_platform_info what : {CL_PLATFORM_NAME, CL_PLATFORM_VERSION})
        hash.add_text(info_text(clGetPlatformInfo, platform, what, asking));
    return hash.value();
}

std::vector<std::byte> pack_binary(const Fingerprint& program, std::span<const std::byte> driver_binary) {
    const Header header{magic, format_version, program, driver_binary.size(), fingerprint(driver_binary)};
    std::vector<std::byte> blob(sizeof header + driver_binary.size());
    std::memcpy(blob.data(), &header, sizeof header);
    std::memcpy(blob.data() + sizeof header, driver_binary.data(), driver_binary.size());
    return blob;
}

UnpackedBinary unpack_binary(std::span<const std::byte> blob, const Fingerprint& program) {
    if (blob.empty()) return {ProgramBinaryUse::none_given};
    Header header;
    if (blob.size() < sizeof header) return {ProgramBinaryUse::not_a_binary};
    std::memcpy(&header, blob.data(), sizeof header);
    if (header.magic != magic || header.format_version != format_version) return {ProgramBinaryUse::not_a_binary};
    if (header.program != program) return {ProgramBinaryUse::other_program};
    const std::span<const std::byte> payload = blob.subspan(sizeof header);
    if (header.payload_size != payload.size() || header.payload != fingerprint(payload))
        return {ProgramBinaryUse::damaged};
    return {ProgramBinaryUse::taken, payload};
}

}  // namespace apsl::host

// SPDX-License-Identifier: MIT
#include "host/program_binary.hpp"

#include <catch2/catch.hpp>
#include <random>

using namespace apsl;
using namespace apsl::host;

namespace {

constexpr Fingerprint program{0x0123456789abcdef, 0xfedcba9876543210};
constexpr std::size_t header_size = 56;

std::vector<std::byte> random_bytes(std::size_t count) {
    std::mt19937 random(1);
    std::vector<std::byte> bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    return bytes;
}

}  // namespace

TEST_CASE("a program binary gives back the driver's bytes, and only for its program", "[embed]") {
    for (const std::size_t size : {std::size_t{1}, std::size_t{64}, std::size_t{4093}}) {
        const std::vector<std::byte> payload = random_bytes(size), blob = pack_binary(program, payload);
        CHECK(blob.size() == header_size + size);
        const UnpackedBinary unpacked = unpack_binary(blob, program);
        CHECK(unpacked.use == ProgramBinaryUse::taken);
        CHECK(std::vector(unpacked.driver_binary.begin(), unpacked.driver_binary.end()) == payload);
        CHECK(unpack_binary(blob, {program[0] ^ 1, program[1]}).use == ProgramBinaryUse::other_program);
        CHECK(unpack_binary(blob, {program[0], program[1] ^ 1}).use == ProgramBinaryUse::other_program);
    }
    CHECK(unpack_binary({}, program).use == ProgramBinaryUse::none_given);
}

TEST_CASE("a program binary with any one bit changed, cut short or made longer is refused", "[embed]") {
    std::vector<std::byte> blob = pack_binary(program, random_bytes(4093));
    for (std::size_t n = 0; n < blob.size(); ++n)
        for (int bit = 0; bit < 8; ++bit) {
            blob[n] ^= static_cast<std::byte>(1 << bit);
            const UnpackedBinary unpacked = unpack_binary(blob, program);
            blob[n] ^= static_cast<std::byte>(1 << bit);
            // Magic and version, the program's fingerprint, then size and fingerprint of the payload and itself.
            const ProgramBinaryUse expected = n < 16   ? ProgramBinaryUse::not_a_binary
                                              : n < 32 ? ProgramBinaryUse::other_program
                                                       : ProgramBinaryUse::damaged;
            if (unpacked.use != expected || !unpacked.driver_binary.empty()) {
                CAPTURE(n, bit);
                FAIL("a changed bit was not refused as expected");
            }
        }
    for (std::size_t size = 1; size < blob.size(); ++size)
        if (unpack_binary(std::span(blob).first(size), program).use !=
            (size < header_size ? ProgramBinaryUse::not_a_binary : ProgramBinaryUse::damaged)) {
            CAPTURE(size);
            FAIL("a binary cut short was not refused as expected");
        }
    blob.push_back(std::byte{0});
    CHECK(unpack_binary(blob, program).use == ProgramBinaryUse::damaged);
}

TEST_CASE("the fingerprint is 128-bit FNV-1a", "[embed]") {
    // Known answer of the hash's authors for "foobar"; it is the last field of the header.
    const std::string text = "foobar";
    const std::vector<std::byte> blob = pack_binary(program, std::as_bytes(std::span(text)));
    std::string hexadecimal;
    for (std::size_t n = header_size; n-- > header_size - 16;) {
        constexpr char digits[] = "0123456789abcdef";
        hexadecimal += digits[std::to_integer<unsigned>(blob[n]) >> 4];
        hexadecimal += digits[std::to_integer<unsigned>(blob[n]) & 15];
    }
    CHECK(hexadecimal == "343e1662793c64bf6f0d3597ba446f18");
}

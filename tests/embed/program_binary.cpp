// SPDX-License-Identifier: MIT
#include "embed/opencl_calls.hpp"
#include "embed/variants.hpp"
#include "embed/without_binaries.hpp"
#include "support/device_cloth.hpp"

#include <apsl/apsl.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>

using namespace apsl;
using namespace apsl::test;

namespace {

using Binary = std::vector<std::byte>;

const MovingCloth& cloth() {
    static const MovingCloth made = moving_cloth(grid(9, 9, 1.0, 1.0, Diagonals::alternating), 1);
    return made;
}

StrainLimiter limiter(const Options& options, std::span<const std::byte> binary = {}) {
    return {device().context, device().id, cloth().topology, options, binary};
}

std::vector<float> filtered(StrainLimiter& limiter, const Options& options) {
    const CallerBuffers buffers({&cloth(), 1}, options);
    const Parameters parameters{.regularization = 2.0f};  // what the printed matrix needs
    REQUIRE(filter(limiter, buffers, {&parameters, 1})[0].status == Status::ok);
    return buffers.read_velocities();
}

/// Given that binary the limiter says so, builds from source without showing the driver any of it, and is right.
void check_refused(const Binary& binary, ProgramBinaryUse why, const Options& options,
                   const std::vector<float>& expected) {
    const OpenClCalls before = opencl_calls();
    StrainLimiter rebuilt = limiter(options, binary);
    CHECK(rebuilt.program_binary_use() == why);
    CHECK(opencl_calls().binaries == before.binaries);
    CHECK(opencl_calls().builds == before.builds + 1);
    CHECK(same_bytes(filtered(rebuilt, options), expected));
}

/// What the tests of refusals begin with: a sound binary of the smallest program.
struct Kept {
    Options options{.execution = Execution::one_group};
    Binary binary;
    std::vector<float> expected;
    Kept() {
        StrainLimiter first = limiter(options);
        expected = filtered(first, options);
        binary = first.program_binary();
        REQUIRE(binary.size() > 1024);
    }
};

struct Pretending {
    explicit Pretending(const Pretence& pretence) { pretend(pretence); }
    ~Pretending() { pretend({}); }
    Pretending(const Pretending&) = delete;
    Pretending& operator=(const Pretending&) = delete;
};

}  // namespace

TEST_CASE("program binary: a limiter made from it gives the same bytes, in every variant", "[embed]") {
    if (without_binaries()) return;
    for (const Options& options : variants) {
        CAPTURE(static_cast<int>(options.matrix), static_cast<int>(options.apply), static_cast<int>(options.execution));
        StrainLimiter first = limiter(options);
        CHECK(first.program_binary_use() == ProgramBinaryUse::none_given);
        const std::vector<float> expected = filtered(first, options);
        const Binary binary = first.program_binary();
        REQUIRE_FALSE(binary.empty());

        const OpenClCalls before = opencl_calls();
        StrainLimiter second = limiter(options, binary);
        CHECK(second.program_binary_use() == ProgramBinaryUse::taken);
        CHECK(opencl_calls().binaries == before.binaries + 1);
        CHECK(opencl_calls().builds == before.builds + 1);
        CHECK(same_bytes(filtered(second, options), expected));

        // A binary is handed on from start to start.
        StrainLimiter third = limiter(options, second.program_binary());
        CHECK(third.program_binary_use() == ProgramBinaryUse::taken);
        CHECK(same_bytes(filtered(third, options), expected));
    }
}

TEST_CASE("program binary: asked for before the first call it works as well", "[embed]") {
    if (without_binaries()) return;
    const Options options{.execution = Execution::one_group};
    StrainLimiter first = limiter(options);
    const Binary binary = first.program_binary();
    StrainLimiter second = limiter(options, binary);
    CHECK(second.program_binary_use() == ProgramBinaryUse::taken);
    CHECK(same_bytes(filtered(second, options), filtered(first, options)));
}

TEST_CASE("program binary: corrupted or cut short it is refused and the program rebuilt", "[embed]") {
    if (without_binaries()) return;
    const Kept kept;
    // One byte of each field: magic, format version, both halves of the program's fingerprint, size, both halves of the
    // payload's fingerprint; then the payload's first, some middle and its last byte.
    const std::size_t size = kept.binary.size();
    for (const std::size_t n : {std::size_t{0}, std::size_t{8}, std::size_t{16}, std::size_t{24}, std::size_t{32},
                                std::size_t{40}, std::size_t{48}, std::size_t{56}, size / 3, size / 2, size - 1}) {
        CAPTURE(n);
        Binary corrupted = kept.binary;
        corrupted[n] ^= std::byte{4};
        check_refused(corrupted,
                      n < 16   ? ProgramBinaryUse::not_a_binary
                      : n < 32 ? ProgramBinaryUse::other_program
                               : ProgramBinaryUse::damaged,
                      kept.options, kept.expected);
    }
    for (const std::size_t left :
         {std::size_t{1}, std::size_t{55}, std::size_t{56}, std::size_t{64}, size / 2, size - 1}) {
        CAPTURE(left);
        check_refused({kept.binary.begin(), kept.binary.begin() + static_cast<std::ptrdiff_t>(left)},
                      left < 56 ? ProgramBinaryUse::not_a_binary : ProgramBinaryUse::damaged, kept.options,
                      kept.expected);
    }
    check_refused({}, ProgramBinaryUse::none_given, kept.options, kept.expected);
}

TEST_CASE("program binary: of other options, device or driver it is refused and the program rebuilt", "[embed]") {
    if (without_binaries()) return;
    const Kept kept;
    Options other = kept.options;
    other.velocity_stride = 4;
    check_refused(kept.binary, ProgramBinaryUse::other_program, other, kept.expected);
    other.execution = Execution::many_groups;
    {
        StrainLimiter fresh = limiter(other);
        check_refused(kept.binary, ProgramBinaryUse::other_program, other, filtered(fresh, other));
    }
    for (const cl_device_info text : {CL_DEVICE_NAME, CL_DEVICE_VENDOR, CL_DEVICE_VERSION, CL_DRIVER_VERSION}) {
        CAPTURE(text);
        const Pretending elsewhere({.other_device_text = text});
        check_refused(kept.binary, ProgramBinaryUse::other_program, kept.options, kept.expected);
    }
    for (const cl_platform_info text : {CL_PLATFORM_NAME, CL_PLATFORM_VERSION}) {
        CAPTURE(text);
        const Pretending elsewhere({.other_platform_text = text});
        check_refused(kept.binary, ProgramBinaryUse::other_program, kept.options, kept.expected);
    }
    CHECK(limiter(kept.options, kept.binary).program_binary_use() == ProgramBinaryUse::taken);
}

TEST_CASE("program binary: on a CPU that of one mesh serves others, of all sizes", "[embed]") {
    if (without_binaries()) return;
    cl_device_type type = 0;
    require_success(clGetDeviceInfo(device().id, CL_DEVICE_TYPE, sizeof type, &type, nullptr), "clGetDeviceInfo");
    if (type != CL_DEVICE_TYPE_CPU) return;
    const Kept kept;
    for (const Mesh& mesh : {right_triangle(), fan(9), grid(41, 23, 1.0, 1.0, Diagonals::random)}) {
        const StrainLimiter other(device().context, device().id, moving_cloth(mesh, 1).topology, kept.options,
                                  kept.binary);
        CHECK(other.program_binary_use() == ProgramBinaryUse::taken);
    }
}

TEST_CASE("program binary: rebuilt where the driver refuses it, empty where the driver gives none", "[embed]") {
    if (without_binaries()) return;
    const Kept kept;
    {
        const Pretending refusing({.binaries_are_invalid = true});
        StrainLimiter rebuilt = limiter(kept.options, kept.binary);
        CHECK(rebuilt.program_binary_use() == ProgramBinaryUse::refused_by_driver);
        CHECK(same_bytes(filtered(rebuilt, kept.options), kept.expected));
    }
    const Pretending without({.no_binaries = true});
    CHECK(limiter(kept.options).program_binary().empty());
}

TEST_CASE("program binary: pocl 6 with LLVM 18 is not asked for one, for it may abort the process", "[embed]") {
    const StrainLimiter asked = limiter({.execution = Execution::one_group});
    for (const char* version :
         {"OpenCL 3.0 PoCL 6.0+debian  Linux, None+Asserts, RELOC, SPIR-V, LLVM 18.1.8, SLEEF, DISTRO, POCL_DEBUG",
          "OpenCL 3.0 PoCL 6.1  Linux, Release, LLVM 19.1.7"}) {
        CAPTURE(version);
        const Pretending elsewhere({.platform_version = version});
        const int queries = opencl_calls().binary_queries;
        CHECK(asked.program_binary().empty());
        CHECK(opencl_calls().binary_queries == queries);
    }
}

TEST_CASE("program binary: other versions of pocl, and other LLVMs, are asked", "[embed]") {
    if (without_binaries()) return;
    const StrainLimiter asked = limiter({.execution = Execution::one_group});
    for (const char* version :
         {"OpenCL 3.0 PoCL 3.1+debian  Linux, None+Asserts, RELOC, SPIR, LLVM 15.0.6, SLEEF, DISTRO, POCL_DEBUG",
          "OpenCL 3.0 PoCL 6.0  Linux, Release, LLVM 17.0.6", "OpenCL 3.0 PoCL 6.0  Linux, without a compiler",
          "OpenCL 3.0 PoCL 7.1  Linux, Release, LLVM 21.1.0", "OpenCL 2.0 LLVM 18.1.8"}) {
        CAPTURE(version);
        const Pretending elsewhere({.platform_version = version});
        CHECK_FALSE(asked.program_binary().empty());
    }
}

TEST_CASE("program binary: in a context of all the platform's devices", "[embed]") {
    if (without_binaries()) return;
    cl_platform_id platform = nullptr;
    require_success(clGetDeviceInfo(device().id, CL_DEVICE_PLATFORM, sizeof platform, &platform, nullptr),
                    "clGetDeviceInfo");
    cl_uint count = 0;
    require_success(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 0, nullptr, &count), "clGetDeviceIDs");
    std::vector<cl_device_id> devices(count);
    require_success(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, count, devices.data(), nullptr), "clGetDeviceIDs");
    cl_int status = CL_SUCCESS;
    const Owned<cl_context> context(clCreateContext(nullptr, count, devices.data(), nullptr, nullptr, &status),
                                    clReleaseContext);
    require_success(status, "clCreateContext");
    CAPTURE(count);
    for (const cl_device_id id : devices) {
        const StrainLimiter first(context.get(), id, cloth().topology);
        const Binary binary = first.program_binary();
        REQUIRE_FALSE(binary.empty());
        CHECK(StrainLimiter(context.get(), id, cloth().topology, {}, binary).program_binary_use() ==
              ProgramBinaryUse::taken);
    }
}

TEST_CASE("program binary: the second start is quick", "[embed]") {
    if (without_binaries()) return;
    // A stride that no run before had, so that the driver's own cache cannot have the program.
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const std::uint32_t stride = 3 + static_cast<std::uint32_t>(now / std::chrono::milliseconds(1) % 50000);
    const Options options{.execution = Execution::one_group, .velocity_stride = stride};
    const CallerBuffers buffers({&cloth(), 1}, options);
    const Parameters parameters;
    const auto start = [&](std::span<const std::byte> given, ProgramBinaryUse use, Binary& binary) {
        const auto begin = std::chrono::steady_clock::now();
        StrainLimiter started = limiter(options, given);
        filter(started, buffers, {&parameters, 1});
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        CHECK(started.program_binary_use() == use);
        binary = started.program_binary();
        return seconds;
    };
    Binary kept, same;
    const double from_source = start({}, ProgramBinaryUse::none_given, kept);
    const double from_binary = start(kept, ProgramBinaryUse::taken, same);
    CAPTURE(stride, from_source, from_binary);
    // About a hundredth on pocl; other processes may use the cores.
    CHECK(from_binary < from_source / 4.0);
}

TEST_CASE("program binary: the C interface gives and takes it", "[embed]") {
    if (without_binaries()) return;
    const Options options{.execution = Execution::one_group};
    apsl_options c_options = apsl_default_options();
    c_options.execution = APSL_EXECUTION_ONE_GROUP;
    apsl_topology* topology = nullptr;
    REQUIRE(apsl_topology_create(cloth().topology->triangles().data()->data(), cloth().topology->triangle_count(),
                                 cloth().topology->vertex_count(), &topology) == APSL_SUCCESS);
    const apsl_topology* const cloths[] = {topology};
    apsl_limiter* first = nullptr;
    REQUIRE(apsl_limiter_create(device().context, device().id, cloths, 1, &c_options, &first) == APSL_SUCCESS);
    CHECK(apsl_limiter_program_binary_use(first) == APSL_PROGRAM_BINARY_NONE_GIVEN);

    std::size_t size = 0;
    REQUIRE(apsl_limiter_program_binary(first, nullptr, 0, &size) == APSL_SUCCESS);
    REQUIRE(size > 1024);
    Binary binary(size);
    CHECK(apsl_limiter_program_binary(first, binary.data(), size - 1, &size) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(std::strstr(apsl_last_error(), "capacity is ") != nullptr);
    CHECK(binary == Binary(size));
    REQUIRE(apsl_limiter_program_binary(first, binary.data(), size, &size) == APSL_SUCCESS);
    CHECK(size == binary.size());
    CHECK(apsl_limiter_program_binary(nullptr, nullptr, 0, &size) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_program_binary(first, nullptr, 0, nullptr) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(apsl_limiter_program_binary_use(nullptr) == APSL_PROGRAM_BINARY_NONE_GIVEN);

    apsl_limiter* second = nullptr;
    REQUIRE(apsl_limiter_create_from_binary(device().context, device().id, cloths, 1, &c_options, binary.data(), size,
                                            &second) == APSL_SUCCESS);
    CHECK(apsl_limiter_program_binary_use(second) == APSL_PROGRAM_BINARY_TAKEN);
    // The same blob as C++ has it.
    CHECK(limiter(options, binary).program_binary_use() == ProgramBinaryUse::taken);
    apsl_limiter_destroy(second);
    CHECK(apsl_limiter_create_from_binary(device().context, device().id, cloths, 1, &c_options, nullptr, size,
                                          &second) == APSL_ERROR_INVALID_ARGUMENT);
    CHECK(second == nullptr);
    apsl_limiter_destroy(first);
    apsl_topology_destroy(topology);
}

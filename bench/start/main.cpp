// SPDX-License-Identifier: MIT
//
// apsl_start_bench: one start of the limiter in a process of its own, from source or with a program binary, up to its
// second call. Prints one JSON object; bench/start/start_times.py runs it with empty and filled driver caches.
#include "../kernels/cloth.hpp"
#include "../kernels/device.hpp"
#include "opencl_time.hpp"

#include <apsl/strain_limiter.hpp>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

namespace {

using namespace apsl;
using namespace apsl::bench;

struct Arguments {
    std::string binary, keep, platform;
    std::size_t device = 0;
    std::uint32_t rows = 65;
    bool one_group = false, ask_before_call = false;
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

std::vector<char> read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

double call(StrainLimiter& limiter, const Device& device, const Buffers& buffers) {
    const auto begin = std::chrono::steady_clock::now();
    const cl_event limited = limiter.enqueue(device.queue.get(), buffers, Parameters{.sub_steps = 10});
    check(clWaitForEvents(1, &limited), "waiting for the filter");
    clReleaseEvent(limited);
    return seconds_since(begin);
}

void run(const Arguments& arguments) {
    const Device device = open_device(arguments.platform, arguments.device);
    const Cloth cloth = make_cloth({arguments.rows, arguments.rows, {}});
    const std::vector<float> velocities(cloth.positions.size());
    const host::BufferHandle x = device.upload(cloth.positions), v = device.upload(velocities),
                             w = device.upload(cloth.inverse_masses), a = device.upload(cloth.rest_areas);
    const Buffers buffers{
        .positions = {x.get()}, .velocities = {v.get()}, .inverse_masses = {w.get()}, .rest_areas = {a.get()}};
    const std::vector<char> given = arguments.binary.empty() ? std::vector<char>{} : read_file(arguments.binary);

    const OpenClTime before = opencl_time();
    auto begin = std::chrono::steady_clock::now();
    const Options options{.execution = arguments.one_group ? Execution::one_group : Execution::many_groups};
    StrainLimiter limiter(device.context.get(), device.id, cloth.topology, options, std::as_bytes(std::span(given)));
    const double construction = seconds_since(begin);
    const OpenClTime after = opencl_time();

    std::vector<std::byte> binary;
    begin = std::chrono::steady_clock::now();
    if (arguments.ask_before_call) binary = limiter.program_binary();
    const double asking_before = seconds_since(begin);
    const double first = call(limiter, device, buffers), second = call(limiter, device, buffers);
    begin = std::chrono::steady_clock::now();
    if (!arguments.keep.empty() && binary.empty()) binary = limiter.program_binary();
    const double asking = asking_before + seconds_since(begin);
    if (!arguments.keep.empty())
        std::ofstream(arguments.keep, std::ios::binary)
            .write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));

    std::cout << nlohmann::json{{"triangles", cloth.triangle_count()},
                                {"binary_taken", limiter.program_binary_use() == ProgramBinaryUse::taken},
                                {"construction_seconds", construction},
                                {"program_seconds", after.programs - before.programs},
                                {"kernel_seconds", after.kernels - before.kernels},
                                {"buffer_seconds", after.buffers - before.buffers},
                                {"first_call_seconds", first},
                                {"second_call_seconds", second},
                                {"asking_seconds", asking},
                                {"binary_bytes", binary.size()}}
              << '\n';
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures one start of the limiter: construction and first calls.");
    Arguments arguments;
    app.add_option("--rows", arguments.rows, "rows and columns of the grid's vertices")->check(CLI::Range(2, 5000));
    app.add_flag("--one-group", arguments.one_group, "in one group instead of many");
    app.add_option("--binary", arguments.binary, "file of a program binary to start from");
    app.add_option("--keep", arguments.keep, "file for the program binary");
    app.add_flag("--ask-before-call", arguments.ask_before_call, "ask for the binary before the first call");
    app.add_option("--platform", arguments.platform, "part of the OpenCL platform's name");
    app.add_option("--device", arguments.device, "number of the device on it");
    try {
        app.parse(argc, argv);
        run(arguments);
        return 0;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
        return 2;
    }
}

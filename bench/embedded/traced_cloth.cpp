// SPDX-License-Identifier: MIT
//
// The pipeline of scenes/embedded, traced: what host and device did when.
#include "embedded/cloth.hpp"
#include "embedded/device.hpp"
#include "trace.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <string_view>

namespace {

constexpr apsl::Parameters bench_parameters{
    .time_step = time_step, .regularization = 1.2f, .sub_steps = 10, .tolerance = 0.0f, .max_iterations = 3};

struct Arguments {
    std::uint32_t grid = 65, device = 0;
    int frames = 90;
    bool out_of_order = false, bench = false;
    std::string trace, kernels = CLOTH_STEP_CL;
};

void run(const Arguments& arguments) {
    Cloth cloth(choose_device(arguments.device), arguments.grid,
                (arguments.out_of_order ? CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE : 0) | CL_QUEUE_PROFILING_ENABLE,
                arguments.kernels);
    if (arguments.bench) cloth.parameters = bench_parameters;
    Trace trace;
    cloth.on_queued = [&](const char* stage, const cl::Event& last) {
        trace.add(stage, last, std::string_view(stage) == "limit_strain");
    };
    for (int frame = 0; frame < arguments.frames; ++frame) {
        trace.begin_frame(frame);
        cloth.frame();
    }
    (void)cloth.read_stats();  // waits for all
    trace.write(arguments.trace);
    if (!arguments.bench) return;
    const FrameTimes times = trace.frame_times("limit_strain");
    std::printf("%zu triangles: a frame takes %.3f ms, limit_strain %.3f ms of it (the device's clock, median frame)\n",
                cloth.mesh().topology->triangle_count(), times.frame, times.stage);
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("The pipeline of scenes/embedded, traced.");
    Arguments arguments;
    app.add_option("--trace", arguments.trace, "file to write, Chrome's trace format")->required();
    app.add_option("--grid", arguments.grid, "vertices a side")->check(CLI::Range(2, 4096))->capture_default_str();
    app.add_option("--frames", arguments.frames, "of 1/60 s")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_flag("--out-of-order", arguments.out_of_order, "on an out-of-order queue");
    app.add_option("--device", arguments.device, "its number over all platforms")->capture_default_str();
    app.add_flag("--bench", arguments.bench,
                 "limit as bench/kernels does: 10 sub-steps of exactly 3 CG iterations; print what a frame takes");
    app.add_option("--kernels", arguments.kernels, "where scenes/embedded/cloth_step.cl is")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        run(arguments);
        return 0;
    } catch (const cl::Error& error) {
        std::cerr << "error: OpenCL: " << error.what() << " failed with code " << error.err() << '\n';
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
    }
    return 1;
}

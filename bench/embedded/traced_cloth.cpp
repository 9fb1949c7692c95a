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

struct Arguments {
    std::uint32_t grid = 65, device = 0;
    int frames = 60;
    bool out_of_order = false, wait = false;
    std::string trace, kernels = TOUCH_SPHERE_CL;
};

void run(const Arguments& arguments) {
    Cloth cloth(choose_device(arguments.device), arguments.grid,
                (arguments.out_of_order ? CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE : 0) | CL_QUEUE_PROFILING_ENABLE,
                arguments.kernels);
    Trace trace;
    cloth.on_queued = [&](const char* stage, const cl::Event& last) {
        if (arguments.wait) last.wait();
        trace.add(stage, last, std::string_view(stage) == "step");
    };
    for (int frame = 0; frame < arguments.frames; ++frame) {
        trace.begin_frame(frame);
        cloth.frame();
    }
    (void)cloth.read_stats();  // waits for all
    trace.write(arguments.trace);
    const FrameTimes times = trace.frame_times("step");
    std::printf("%zu triangles: a frame takes %.3f ms, the step %.3f ms of it (the device's clock, median frame)\n",
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
    app.add_flag("--wait", arguments.wait, "for the end of each stage before the next, the wait on the host's row");
    app.add_option("--kernels", arguments.kernels, "where scenes/embedded/touch_sphere.cl is")->capture_default_str();
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

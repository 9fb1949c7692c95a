// SPDX-License-Identifier: MIT
//
// A cloth falls over a moving sphere, held along one edge (cloth.hpp). The host waits once, at the end.
#include "cloth.hpp"
#include "device.hpp"
#include "picture.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

namespace {

struct Arguments {
    std::uint32_t grid = 65, device = 0;
    int frames = 60;
    bool out_of_order = false;
    std::string out;
};

void run(const Arguments& arguments) {
    const cl::Device device = choose_device(arguments.device);
    Cloth cloth(device, arguments.grid, arguments.out_of_order ? CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE : 0);
    for (int frame = 0; frame < arguments.frames; ++frame) cloth.frame();

    const apsl::Stats stats = cloth.read_stats();
    std::cout << cloth.mesh().topology->triangle_count() << " triangles, " << arguments.frames << " frames on "
              << device.getInfo<CL_DEVICE_NAME>() << (arguments.out_of_order ? ", out of order" : ", in order")
              << "\nlast frame: greatest area change " << stats.max_area_change << ", greatest stretch "
              << stats.max_stretch << ", " << stats.sub_steps << " sub-steps, status " << static_cast<int>(stats.status)
              << '\n';
    if (!arguments.out.empty())
        write_picture(arguments.out, arguments.frames - 1, cloth.mesh(), cloth.read_positions());
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("A cloth that falls over a moving sphere, all on the device, with apsl as its solver.");
    Arguments arguments;
    app.add_option("--grid", arguments.grid, "vertices a side")->check(CLI::Range(2, 4096))->capture_default_str();
    app.add_option("--frames", arguments.frames, "of 1/60 s")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_option("--out", arguments.out, "folder for the last frame, as scenes/pictures/render.py opens it");
    app.add_flag("--out-of-order", arguments.out_of_order, "on an out-of-order queue");
    app.add_option("--device", arguments.device, "its number over all platforms")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        run(arguments);
        return 0;
    } catch (const cl::BuildError& error) {
        for (const auto& [device, log] : error.getBuildLog()) std::cerr << log << '\n';
    } catch (const cl::Error& error) {
        std::cerr << "error: OpenCL: " << error.what() << " failed with code " << error.err() << '\n';
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << '\n';
    }
    return 1;
}

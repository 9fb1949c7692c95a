// SPDX-License-Identifier: MIT
//
// apsl in a pipeline that lives on the device: a cloth falls over a sphere, held along one edge. A step is
//     predict, relax springs, limit strain (apsl), advance and collide
// on one queue; kernels in cloth_step.cl. The order counts: apsl takes the positions of the START of the step and the
// velocities proposed for it, and corrects the velocities. The host only queues commands: it waits once, at the end.
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include "mesh.hpp"
#include "picture.hpp"
#include "trace.hpp"

#include <CLI/CLI.hpp>
#include <apsl/strain_limiter.hpp>
#include <iostream>
#include <numeric>

namespace {

constexpr int steps_per_frame = 4;
constexpr float time_step = 1.0f / 60.0f / steps_per_frame;  // s
constexpr float gravity = -9.81f;                            // m/s²
constexpr float damping = 0.99f;                             // what a step leaves of a velocity
constexpr float density = 0.2f;                              // kg/m²
constexpr float stretch = 0.2f, bending = 0.02f;             // see Spring in cloth_step.cl
constexpr cl_float4 sphere{{0.0f, -0.35f, 0.0f, 0.3f}};      // m: centre, radius
constexpr float friction = 0.4f;
constexpr apsl::Parameters bench_parameters{
    .time_step = time_step, .regularization = 1.2f, .sub_steps = 10, .tolerance = 0.0f, .max_iterations = 3};

struct Arguments {
    std::uint32_t grid = 65, device = 0;
    int frames = 90;
    bool out_of_order = false, bench = false;
    std::string trace, out;
};

struct Spring {  // as in cloth_step.cl
    cl_uint other;
    cl_float rest_length, stiffness;
};

/// The cloth on the device. Everything is made once: a step makes nothing, waits for nothing, reads nothing back.
class Cloth {
public:
    Cloth(const cl::Context& context, const cl::Device& device, const Arguments& arguments,
          const std::shared_ptr<const apsl::Topology>& topology, const std::vector<float>& rest)
        : arguments_(arguments), limiter_(context(), device(), topology) {
        if (arguments.bench) parameters_ = bench_parameters;
        queue_ = cl::CommandQueue(context, device,
                                  (arguments.out_of_order ? CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE : 0) |
                                      (arguments.trace.empty() ? 0 : CL_QUEUE_PROFILING_ENABLE));
        make_buffers(context, *topology, rest);
        make_kernels(context, topology->vertex_count());
    }

    void frame() {
        for (int step = 0; step < steps_per_frame; ++step) {
            launch("predict", predict_);
            launch("relax_springs", relax_);  // from velocities_ to relaxed_
            launch("relax_springs", relax_back_);
            limit_strain();
            launch("advance", advance_);
        }
        queue_.flush();
        ++frame_;
    }

    /// m, three for each vertex; waits until all that was queued is done.
    std::vector<float> read_positions() const {
        queue_.finish();
        std::vector<float> positions(positions_.getInfo<CL_MEM_SIZE>() / sizeof(float));
        queue_.enqueueReadBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(float), positions.data());
        return positions;
    }

    /// Of the last step; waits likewise.
    apsl::Stats read_stats() const {
        queue_.finish();
        apsl::Stats stats{};
        cl::Event(limiter_.read_stats(queue_(), {&stats, 1})).wait();
        return stats;
    }

    const Trace& trace() const { return trace_; }

private:
    void launch(const char* stage, const cl::Kernel& kernel) {
        const double begin = Trace::now();
        cl::Event event;
        queue_.enqueueNDRangeKernel(kernel, cl::NullRange, padded_vertices_, cl::NDRange(64), &before_, &event);
        queued(stage, begin, event, false);
    }

    void limit_strain() {
        const double begin = Trace::now();
        const cl_event before = before_.empty() ? nullptr : before_[0]();
        const apsl::Buffers buffers{.positions = {positions_()},
                                    .velocities = {velocities_()},
                                    .inverse_masses = {inverse_masses_()},
                                    .rest_areas = {rest_areas_()}};
        const cl::Event event(limiter_.enqueue(queue_(), buffers, parameters_, std::span(&before, before_.size())));
        queued("limit_strain", begin, event, true);
    }

    /// An in-order queue runs stages one behind the other; on an out-of-order queue each waits for the one before.
    void queued(const char* stage, double begin, const cl::Event& event, bool many_commands) {
        if (arguments_.out_of_order) before_.assign(1, event);
        if (!arguments_.trace.empty()) trace_.add(stage, frame_, begin, event, many_commands);
    }

    void make_buffers(const cl::Context& context, const apsl::Topology& topology, const std::vector<float>& rest) {
        std::vector<float> rest_areas, inverse_masses(topology.vertex_count()), still(rest.size());
        for (const apsl::Triangle& triangle : topology.triangles()) {
            rest_areas.push_back(area(rest, triangle));
            for (const std::uint32_t v : triangle) inverse_masses[v] += density * rest_areas.back() / 3.0f;
        }
        for (float& mass : inverse_masses) mass = 1.0f / mass;
        std::fill_n(inverse_masses.begin(), arguments_.grid, 0.0f);  // pins: the first row

        // Stretch springs along the edges, then bending springs between vertices two edges apart; listed for both ends.
        std::vector<apsl::VertexPair> pairs(topology.edges().begin(), topology.edges().end());
        for (const apsl::VertexPair& pair : topology.second_ring_pairs()) pairs.push_back(pair);
        std::vector<cl_uint> offsets(topology.vertex_count() + 1);
        for (const auto& [a, b] : pairs) ++offsets[a + 1], ++offsets[b + 1];
        std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
        std::vector<cl_uint> next(offsets);
        std::vector<Spring> springs(offsets.back());
        for (std::size_t n = 0; n < pairs.size(); ++n) {
            const auto [a, b] = pairs[n];
            const float stiffness = n < topology.edges().size() ? stretch : bending;
            springs[next[a]++] = {b, distance(rest, a, b), stiffness};
            springs[next[b]++] = {a, distance(rest, a, b), stiffness};
        }

        const auto upload = [&](const auto& values) {
            return cl::Buffer(context, values.begin(), values.end(), false);
        };
        positions_ = upload(rest);
        velocities_ = upload(still);
        relaxed_ = upload(still);
        inverse_masses_ = upload(inverse_masses);
        rest_areas_ = upload(rest_areas);
        offsets_ = upload(offsets);
        springs_ = upload(springs);
    }

    void make_kernels(const cl::Context& context, std::size_t vertex_count) {
        std::ifstream file(CLOTH_STEP_CL);
        if (!file) throw std::runtime_error(CLOTH_STEP_CL ": cannot be read");
        const cl::Program program(context, std::string(std::istreambuf_iterator<char>(file), {}));
        program.build("-cl-std=CL1.2");
        padded_vertices_ = cl::NDRange((vertex_count + 63) / 64 * 64);
        const auto kernel = [&](const char* name, const auto&... values) {
            cl::Kernel made(program, name);
            cl_uint n = 0;
            made.setArg(n++, static_cast<cl_uint>(vertex_count));
            made.setArg(n++, time_step);
            (made.setArg(n++, values), ...);
            return made;
        };
        predict_ = kernel("predict", gravity, damping, inverse_masses_, velocities_);
        relax_ = kernel("relax_springs", offsets_, springs_, inverse_masses_, positions_, velocities_, relaxed_);
        relax_back_ = kernel("relax_springs", offsets_, springs_, inverse_masses_, positions_, relaxed_, velocities_);
        advance_ = kernel("advance", sphere, friction, inverse_masses_, positions_, velocities_);
    }

    Arguments arguments_;
    cl::CommandQueue queue_;
    cl::Buffer positions_, velocities_, relaxed_, inverse_masses_, rest_areas_, offsets_, springs_;
    cl::Kernel predict_, relax_, relax_back_, advance_;
    cl::NDRange padded_vertices_;
    apsl::StrainLimiter limiter_;
    apsl::Parameters parameters_{.time_step = time_step, .sub_steps = 4, .first_regularization = 1.02f};
    std::vector<cl::Event> before_;  // empty on an in-order queue
    int frame_ = 0;
    Trace trace_;
};

cl::Device choose_device(std::size_t number) {
    std::vector<cl::Platform> platforms;
    std::vector<cl::Device> all, devices;
    cl::Platform::get(&platforms);
    for (const cl::Platform& platform : platforms) {
        platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        all.insert(all.end(), devices.begin(), devices.end());
    }
    if (number >= all.size())
        throw std::runtime_error("--device " + std::to_string(number) + ": there are " + std::to_string(all.size()));
    return all[number];
}

void run(const Arguments& arguments) {
    const cl::Device device = choose_device(arguments.device);
    std::vector<float> rest;
    const std::vector<apsl::Triangle> triangles = square(arguments.grid, 1.5f, rest);
    const auto topology = apsl::Topology::build(triangles, rest.size() / 3);
    Cloth cloth(cl::Context(device), device, arguments, topology, rest);
    for (int frame = 0; frame < arguments.frames; ++frame) cloth.frame();

    const apsl::Stats stats = cloth.read_stats();
    std::cout << triangles.size() << " triangles, " << arguments.frames << " frames on "
              << device.getInfo<CL_DEVICE_NAME>() << (arguments.out_of_order ? ", out of order" : ", in order")
              << "\nlast step: greatest area change " << stats.max_area_change << ", RMS " << stats.rms_area_change
              << ", " << stats.cg_iterations << " CG iterations, status " << static_cast<int>(stats.status) << '\n';
    if (!arguments.trace.empty()) cloth.trace().write(arguments.trace);
    if (!arguments.out.empty())
        write_picture(arguments.out, arguments.frames - 1, *topology, rest, cloth.read_positions());
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("A cloth that falls over a sphere, all on the device, its strain limited by apsl.");
    Arguments arguments;
    app.add_option("--grid", arguments.grid, "vertices a side")->check(CLI::Range(2, 4096))->capture_default_str();
    app.add_option("--frames", arguments.frames, "of 1/60 s")->check(CLI::Range(1, 100000))->capture_default_str();
    app.add_option("--out", arguments.out, "folder for the last frame, as scenes/pictures/render.py opens it");
    app.add_option("--trace", arguments.trace, "file for what host and device did when, Chrome's trace format");
    app.add_flag("--out-of-order", arguments.out_of_order, "on an out-of-order queue");
    app.add_option("--device", arguments.device, "its number over all platforms")->capture_default_str();
    app.add_flag("--bench", arguments.bench, "limit as bench/kernels does: 10 sub-steps of exactly 3 CG iterations");
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

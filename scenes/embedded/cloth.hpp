// SPDX-License-Identifier: MIT
//
// A cloth that lives on the device, with apsl as its solver. A frame is
//     touch_sphere (touch_sphere.cl), step (apsl)
// on one queue: what each vertex may touch, then one call that is the whole time step, positions and velocities in and
// out. The host only queues commands.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include "mesh.hpp"

#include <apsl/strain_limiter.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

inline constexpr float width = 1.5f, thickness = 0.005f;  // m, of the cloth
inline constexpr float density = 0.2f;                    // kg/m²
inline constexpr float time_step = 1.0f / 60.0f;          // s, a frame
inline constexpr float sphere_radius = 0.3f;              // m
inline constexpr float friction = 0.4f;

/// Centre of the sphere after that many frames, m; it swings to and fro once a second.
inline cl_float4 sphere_center(int frames) {
    return {{0.0f, -0.35f, 0.15f * std::sin(6.2831853f * time_step * static_cast<float>(frames)), 0.0f}};
}

/// A square cloth that falls over a moving sphere, held along one edge, all on the device. Everything is made once: a
/// frame makes nothing, waits for nothing, reads nothing back.
class Cloth {
public:
    /// `grid` vertices a side. `kernels`: where touch_sphere.cl is.
    Cloth(const cl::Device& device, std::uint32_t grid, cl_command_queue_properties queue_properties,
          const std::string& kernels = TOUCH_SPHERE_CL)
        : mesh_(square(grid, width)),
          context_(device),
          queue_(context_, device, queue_properties),
          out_of_order_((queue_properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0),
          limiter_(context_(), device(), mesh_.topology,
                   {.limits_stretch = true, .integrates = true, .keeps_contacts = true, .bends = true}) {
        make_buffers(grid);
        make_kernel(kernels);
        queue_rest_state();
    }

    void frame() {
        touch_sphere_.setArg(0, sphere_center(frames_));
        touch_sphere_.setArg(1, sphere_center(++frames_));
        cl::Event touched;
        queue_.enqueueNDRangeKernel(touch_sphere_, cl::NullRange, padded_vertices_, cl::NDRange(64), &before_,
                                    &touched);
        queued("touch_sphere", touched);
        queued("step", cl::Event(limiter_.enqueue(queue_(), buffers_, parameters, wait_list())));
        queue_.flush();
    }

    /// m, three for each vertex; waits until all that was queued is done.
    std::vector<float> read_positions() const {
        queue_.finish();
        std::vector<float> positions(mesh_.positions.size());
        queue_.enqueueReadBuffer(positions_, CL_TRUE, 0, positions.size() * sizeof(float), positions.data());
        return positions;
    }

    /// Of the last frame; waits likewise.
    apsl::Stats read_stats() const {
        queue_.finish();
        apsl::Stats stats{};
        cl::Event(limiter_.read_stats(queue_(), {&stats, 1})).wait();
        return stats;
    }

    const SquareMesh& mesh() const { return mesh_; }

    apsl::Parameters parameters{.time_step = time_step,
                                .stretch_ceiling = 1.1f,
                                .acceleration = {0.0f, -9.81f, 0.0f},
                                .damping = 1.0f,
                                .bending = 5e-4f};
    /// Is told of each stage once it is queued, and of its last command.
    std::function<void(const char* stage, const cl::Event& last)> on_queued = [](const char*, const cl::Event&) {};

private:
    /// An in-order queue runs stages one behind the other; on an out-of-order queue each waits for the one before.
    void queued(const char* stage, const cl::Event& last) {
        if (out_of_order_) before_.assign(1, last);
        on_queued(stage, last);
    }

    std::span<const cl_event> wait_list() const {
        if (before_.empty()) return {};
        return {&before_[0](), 1};
    }

    void make_buffers(std::uint32_t grid) {
        const apsl::Topology& topology = *mesh_.topology;
        const std::vector<float> still(mesh_.positions.size());
        std::vector<float> inverse_masses(topology.vertex_count());
        for (const apsl::Triangle& triangle : topology.triangles())
            for (const std::uint32_t v : triangle)
                inverse_masses[v] += density * area(mesh_.positions, triangle) / 3.0f;
        for (float& mass : inverse_masses) mass = 1.0f / mass;
        std::fill_n(inverse_masses.begin(), grid, 0.0f);  // pins: the first row

        const auto upload = [&](const std::vector<float>& values) {
            return cl::Buffer(context_, values.begin(), values.end(), false);
        };
        const auto reserve = [&](std::size_t floats) {
            return cl::Buffer(context_, CL_MEM_READ_WRITE, floats * sizeof(float));
        };
        positions_ = upload(mesh_.positions);
        velocities_ = upload(still);
        inverse_masses_ = upload(inverse_masses);
        rest_areas_ = reserve(topology.triangle_count());
        rest_shapes_ = reserve(4 * topology.triangle_count());
        rest_hinges_ = reserve(2 * topology.hinge_count());
        contacts_ = reserve(8 * topology.vertex_count());
        buffers_ = {.positions = {positions_()},
                    .velocities = {velocities_()},
                    .inverse_masses = {inverse_masses_()},
                    .rest_areas = {rest_areas_()},
                    .rest_shapes = {rest_shapes_()},
                    .contacts = {contacts_()},
                    .rest_hinges = {rest_hinges_()}};
    }

    void make_kernel(const std::string& path) {
        std::ifstream file(path);
        if (!file) throw std::runtime_error(path + ": cannot be read");
        const cl::Program program(context_, std::string(std::istreambuf_iterator<char>(file), {}));
        program.build("-cl-std=CL1.2");
        touch_sphere_ = cl::Kernel(program, "touch_sphere");
        const auto vertex_count = static_cast<cl_uint>(mesh_.topology->vertex_count());
        padded_vertices_ = cl::NDRange((vertex_count + 63) / 64 * 64);
        cl_uint n = 2;  // the first two are the frame's
        const auto set = [&](const auto&... values) { (touch_sphere_.setArg(n++, values), ...); };
        set(sphere_radius + thickness, friction, time_step, vertex_count, positions_, velocities_, contacts_);
    }

    /// The cloth is at rest as it lies now.
    void queue_rest_state() {
        queued("rest_areas", cl::Event(limiter_.enqueue_rest_areas(queue_(), buffers_.positions, buffers_.rest_areas)));
        queued("rest_shapes", cl::Event(limiter_.enqueue_rest_shapes(queue_(), buffers_.positions, buffers_.rest_shapes,
                                                                     wait_list())));
        queued("rest_hinges", cl::Event(limiter_.enqueue_rest_hinges(queue_(), buffers_.positions, buffers_.rest_hinges,
                                                                     wait_list())));
    }

    SquareMesh mesh_;
    cl::Context context_;
    cl::CommandQueue queue_;
    bool out_of_order_;
    int frames_ = 0;
    cl::Buffer positions_, velocities_, inverse_masses_, rest_areas_, rest_shapes_, rest_hinges_, contacts_;
    apsl::Buffers buffers_;  // the same, as apsl takes them
    cl::Kernel touch_sphere_;
    cl::NDRange padded_vertices_;
    apsl::StrainLimiter limiter_;
    std::vector<cl::Event> before_;  // empty on an in-order queue
};

// SPDX-License-Identifier: MIT
//
// apsl in a pipeline that lives on the device. A step is
//     predict, relax springs, limit strain (apsl), advance and collide
// on one queue; kernels in cloth_step.cl. The order counts: apsl takes the positions of the START of the step and the
// velocities proposed for it, and corrects the velocities. The host only queues commands.
#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include "mesh.hpp"

#include <apsl/strain_limiter.hpp>

#include <fstream>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

inline constexpr int steps_per_frame = 4;
inline constexpr float time_step = 1.0f / 60.0f / steps_per_frame;  // s
inline constexpr float gravity = -9.81f;                            // m/s²
inline constexpr float damping = 0.99f;                             // what a step leaves of a velocity
inline constexpr float density = 0.2f;                              // kg/m²
inline constexpr float stretch = 0.2f, bending = 0.02f;             // see Spring in cloth_step.cl
inline constexpr cl_float4 sphere{{0.0f, -0.35f, 0.0f, 0.3f}};      // m: centre, radius
inline constexpr float friction = 0.4f;
struct Spring {  // as in cloth_step.cl
    cl_uint other;
    cl_float rest_length, stiffness;
};

/// A square cloth that falls over a sphere, held along one edge, all on the device. Everything is made once: a step
/// makes nothing, waits for nothing, reads nothing back.
class Cloth {
public:
    /// `grid` vertices a side. `kernels`: where cloth_step.cl is.
    Cloth(const cl::Device& device, std::uint32_t grid, cl_command_queue_properties queue_properties,
          const std::string& kernels = CLOTH_STEP_CL)
        : mesh_(square(grid, 1.5f)),
          context_(device),
          queue_(context_, device, queue_properties),
          out_of_order_((queue_properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0),
          limiter_(context_(), device(), mesh_.topology) {
        make_buffers(grid);
        make_kernels(kernels);
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

    const SquareMesh& mesh() const { return mesh_; }

    apsl::Parameters parameters{.time_step = time_step, .sub_steps = 4, .first_regularization = 1.02f};
    /// Is told of each stage once it is queued, and of its last command.
    std::function<void(const char* stage, const cl::Event& last)> on_queued = [](const char*, const cl::Event&) {};

private:
    void launch(const char* stage, const cl::Kernel& kernel) {
        cl::Event event;
        queue_.enqueueNDRangeKernel(kernel, cl::NullRange, padded_vertices_, cl::NDRange(64), &before_, &event);
        queued(stage, event);
    }

    void limit_strain() {
        const cl_event before = before_.empty() ? nullptr : before_[0]();
        const apsl::Buffers buffers{.positions = {positions_()},
                                    .velocities = {velocities_()},
                                    .inverse_masses = {inverse_masses_()},
                                    .rest_areas = {rest_areas_()}};
        const cl::Event event(limiter_.enqueue(queue_(), buffers, parameters, std::span(&before, before_.size())));
        queued("limit_strain", event);
    }

    /// An in-order queue runs stages one behind the other; on an out-of-order queue each waits for the one before.
    void queued(const char* stage, const cl::Event& last) {
        if (out_of_order_) before_.assign(1, last);
        on_queued(stage, last);
    }

    void make_buffers(std::uint32_t grid) {
        const apsl::Topology& topology = *mesh_.topology;
        const std::vector<float>& rest = mesh_.positions;
        std::vector<float> rest_areas, inverse_masses(topology.vertex_count()), still(rest.size());
        for (const apsl::Triangle& triangle : topology.triangles()) {
            rest_areas.push_back(area(rest, triangle));
            for (const std::uint32_t v : triangle) inverse_masses[v] += density * rest_areas.back() / 3.0f;
        }
        for (float& mass : inverse_masses) mass = 1.0f / mass;
        std::fill_n(inverse_masses.begin(), grid, 0.0f);  // pins: the first row

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
            return cl::Buffer(context_, values.begin(), values.end(), false);
        };
        positions_ = upload(rest);
        velocities_ = upload(still);
        relaxed_ = upload(still);
        inverse_masses_ = upload(inverse_masses);
        rest_areas_ = upload(rest_areas);
        offsets_ = upload(offsets);
        springs_ = upload(springs);
    }

    void make_kernels(const std::string& path) {
        const std::size_t vertex_count = mesh_.topology->vertex_count();
        std::ifstream file(path);
        if (!file) throw std::runtime_error(path + ": cannot be read");
        const cl::Program program(context_, std::string(std::istreambuf_iterator<char>(file), {}));
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

    SquareMesh mesh_;
    cl::Context context_;
    cl::CommandQueue queue_;
    bool out_of_order_;
    cl::Buffer positions_, velocities_, relaxed_, inverse_masses_, rest_areas_, offsets_, springs_;
    cl::Kernel predict_, relax_, relax_back_, advance_;
    cl::NDRange padded_vertices_;
    apsl::StrainLimiter limiter_;
    std::vector<cl::Event> before_;  // empty on an in-order queue
};

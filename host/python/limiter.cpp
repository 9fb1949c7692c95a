// SPDX-License-Identifier: MIT
#include "limiter.hpp"

#include "arrays.hpp"
#include "devices.hpp"
#include "kernels/constants.h"
#include "opencl_error.hpp"
#include "process.hpp"

#include <cmath>

namespace apsl::python {
namespace {

// Of each triangle's number what validate() demands of one for all.
void check_list(const Array<float>& values, const Field<Parameters, float>& field) {
    for (py::ssize_t a = 0; a < values.size(); ++a) {
        const float value = values.data()[a];
        if (std::isfinite(value) && field.bounds.hold(value)) continue;
        Parameters parameters;
        parameters.*field.member = value;
        try {
            validate(parameters);
        } catch (const Error& error) {
            throw Error(error.code(), "triangle " + std::to_string(a) + ": " + error.what());
        }
    }
}

}  // namespace

Limiter::Limiter(py::handle triangles, py::handle vertex_count, py::handle device, const py::kwargs& arguments)
    : vertex_count_(from_python<std::uint32_t>(vertex_count, "vertex_count")) {
    const std::vector<Triangle> corners = triangle_list(triangles);
    const Options options = with_arguments(Options{}, arguments, "StrainLimiter", option_fields);
    const std::optional<std::size_t> number = device_number(device);

    const py::gil_scoped_release others_may_run;
    triangle_count_ = corners.size();
    const auto topology = Topology::build(corners, vertex_count_);
    hinge_count_ = topology->hinge_count();
    cl_device_id id = choose_device(number);
    cl_int code = CL_SUCCESS;
    context_ = host::ContextHandle(clCreateContext(nullptr, 1, &id, nullptr, nullptr, &code));
    host::check(code, "apsl: creating an OpenCL context");
    queue_ = host::QueueHandle(clCreateCommandQueue(context_.get(), id, 0, &code));
    host::check(code, "apsl: creating a command queue");
    limiter_.emplace(context_.get(), id, topology, options);
    positions_ = make_buffer(3 * vertex_count_);
    velocities_ = make_buffer(3 * vertex_count_);
    inverse_masses_ = make_buffer(vertex_count_);
    rest_areas_ = make_buffer(triangle_count_);
    if (options.regularization_per_triangle) regularization_ = make_buffer(triangle_count_);
    if (options.limits_stretch) rest_shapes_ = make_buffer(4 * triangle_count_);
    if (options.bends) rest_hinges_ = make_buffer(std::max<std::size_t>(2 * hinge_count_, 1));
    if (options.stretch_ceiling_per_triangle) stretch_ceilings_ = make_buffer(triangle_count_);
    if (options.keeps_contacts) contacts_ = make_buffer(APSLK_CONTACT_SIZE * vertex_count_);
    if (options.acceleration_per_vertex) accelerations_ = make_buffer(3 * vertex_count_);
    tethers_per_vertex_ = options.tethers_per_vertex;
    if (tethers_per_vertex_ > 0) tether_anchors_ = make_buffer(tethers_per_vertex_ * vertex_count_);
    if (tethers_per_vertex_ > 0) tether_lengths_ = make_buffer(tethers_per_vertex_ * vertex_count_);
}

host::BufferHandle Limiter::make_buffer(std::size_t count) {
    cl_int code = CL_SUCCESS;
    host::BufferHandle buffer(clCreateBuffer(context_.get(), CL_MEM_READ_WRITE, count * sizeof(float), nullptr, &code));
    host::check(code, "apsl: allocating an array on the device");
    return buffer;
}

void Limiter::upload(const host::BufferHandle& buffer, const void* numbers, std::size_t count) {
    // Blocking: where a later step throws, nothing may still be reading the caller's array.
    host::check(clEnqueueWriteBuffer(queue_.get(), buffer.get(), CL_TRUE, 0, count * sizeof(float), numbers, 0, nullptr,
                                     nullptr),
                "apsl: copying an array to the device");
}

py::tuple Limiter::limit(py::handle positions, py::handle velocities, py::handle inverse_masses, py::handle rest_areas,
                         const py::kwargs& arguments) {
    enter_opencl();
    const Array<float> given_positions = vectors<float>(positions, "positions", vertex_count_);
    const Array<float> given_velocities = vectors<float>(velocities, "velocities", vertex_count_);
    const Array<float> given_masses = numbers<float>(inverse_masses, "inverse_masses", vertex_count_);
    const Array<float> given_areas = numbers<float>(rest_areas, "rest_areas", triangle_count_);
    py::dict settings(arguments.attr("copy")());
    // One of the arrays that a call takes beside parameters, where the limiter was made for it: apsl.StrainLimiter sees
    // to it that it is there.
    const auto taken = [&](const host::BufferHandle& buffer, const char* name, std::size_t rows,
                           std::size_t floats_a_row) {
        std::optional<Array<float>> given;
        if (!buffer) return given;
        const py::object value = settings.attr("pop")(name);
        given = floats_a_row > 1 ? table<float>(value, name, rows, floats_a_row) : numbers<float>(value, name, rows);
        return given;
    };
    const auto given_regularization = taken(regularization_, "regularization", triangle_count_, 1);
    const auto given_shapes = taken(rest_shapes_, "rest_shapes", triangle_count_, 4);
    const auto given_ceilings = taken(stretch_ceilings_, "stretch_ceiling", triangle_count_, 1);
    const auto given_contacts = taken(contacts_, "contacts", vertex_count_, APSLK_CONTACT_SIZE);
    const auto given_accelerations = taken(accelerations_, "accelerations", vertex_count_, 3);
    const auto given_hinges = taken(rest_hinges_, "rest_hinges", hinge_count_, 2);
    std::optional<Array<std::uint32_t>> given_anchors;
    std::optional<Array<float>> given_lengths;
    if (tethers_per_vertex_ > 0) {
        given_anchors = indices(settings.attr("pop")("tether_anchors"), "tether_anchors", "row", vertex_count_,
                                tethers_per_vertex_);
        given_lengths =
            table<float>(settings.attr("pop")("tether_lengths"), "tether_lengths", vertex_count_, tethers_per_vertex_);
    }
    for_each_field(parameter_fields, [&](const auto& field) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, Field<Parameters, float>>) {
            const auto& list = field.member == &Parameters::stretch_ceiling ? given_ceilings : given_regularization;
            if (field.may_be_a_list && list) check_list(*list, field);
        }
    });
    const Parameters parameters =
        with_arguments(Parameters{}, settings, limiter_->options().integrates ? "step" : "limit", parameter_fields);
    Array<float> limited({static_cast<py::ssize_t>(vertex_count_), py::ssize_t{3}});
    float* const result = limited.mutable_data();
    const bool integrates = limiter_->options().integrates;
    Array<float> ends({static_cast<py::ssize_t>(integrates ? vertex_count_ : 0), py::ssize_t{3}});
    float* const end = ends.mutable_data();
    Stats stats{};
    {
        const py::gil_scoped_release others_may_run;
        const std::lock_guard one_call_at_a_time(mutex_);
        upload(positions_, given_positions.data(), 3 * vertex_count_);
        upload(velocities_, given_velocities.data(), 3 * vertex_count_);
        upload(inverse_masses_, given_masses.data(), vertex_count_);
        upload(rest_areas_, given_areas.data(), triangle_count_);
        if (given_regularization) upload(regularization_, given_regularization->data(), triangle_count_);
        if (given_shapes) upload(rest_shapes_, given_shapes->data(), 4 * triangle_count_);
        if (given_hinges && hinge_count_ > 0) upload(rest_hinges_, given_hinges->data(), 2 * hinge_count_);
        if (given_ceilings) upload(stretch_ceilings_, given_ceilings->data(), triangle_count_);
        if (given_contacts) upload(contacts_, given_contacts->data(), APSLK_CONTACT_SIZE * vertex_count_);
        if (given_accelerations) upload(accelerations_, given_accelerations->data(), 3 * vertex_count_);
        if (given_anchors) upload(tether_anchors_, given_anchors->data(), tethers_per_vertex_ * vertex_count_);
        if (given_lengths) upload(tether_lengths_, given_lengths->data(), tethers_per_vertex_ * vertex_count_);
        const Buffers buffers{.positions = {positions_.get()},
                              .velocities = {velocities_.get()},
                              .inverse_masses = {inverse_masses_.get()},
                              .rest_areas = {rest_areas_.get()},
                              .regularization = {regularization_.get()},
                              .rest_shapes = {rest_shapes_.get()},
                              .stretch_ceilings = {stretch_ceilings_.get()},
                              .contacts = {contacts_.get()},
                              .rest_hinges = {rest_hinges_.get()},
                              .accelerations = {accelerations_.get()},
                              .tether_anchors = {tether_anchors_.get()},
                              .tether_lengths = {tether_lengths_.get()}};
        const host::EventHandle filtered(limiter_->enqueue(queue_.get(), buffers, parameters));
        const host::EventHandle read(limiter_->read_stats(queue_.get(), {&stats, 1}));
        const cl_event read_event = read.get();
        host::check(clWaitForEvents(1, &read_event), "apsl: limiting");
        host::check(clEnqueueReadBuffer(queue_.get(), velocities_.get(), CL_TRUE, 0, 3 * vertex_count_ * sizeof(float),
                                        result, 0, nullptr, nullptr),
                    "apsl: copying velocities from the device");
        if (integrates)
            host::check(clEnqueueReadBuffer(queue_.get(), positions_.get(), CL_TRUE, 0,
                                            3 * vertex_count_ * sizeof(float), end, 0, nullptr, nullptr),
                        "apsl: copying positions from the device");
    }
    if (integrates) return py::make_tuple(ends, limited, to_dict(stats, stats_fields));
    return py::make_tuple(limited, to_dict(stats, stats_fields));
}

}  // namespace apsl::python

// SPDX-License-Identifier: MIT
#include "device_limiter.hpp"

#include "arrays.hpp"
#include "devices.hpp"
#include "opencl_error.hpp"
#include "process.hpp"

namespace apsl::python {
namespace {

using Address = DeviceLimiter::Address;

// What a limiter with a context takes: where the numbers lie in the caller's buffers, too.
constexpr std::tuple device_option_fields = std::tuple_cat(option_fields, layout_fields);

template <class Object>
Object object(Address address) {
    return reinterpret_cast<Object>(address);
}

std::vector<cl_event> events(const std::vector<Address>& addresses) {
    std::vector<cl_event> list;
    for (const Address address : addresses) list.push_back(object<cl_event>(address));
    return list;
}

cl_device_id only_device(cl_context context) {
    const char* doing = "apsl: asking the context for its devices";
    std::size_t size = 0;
    host::check(clGetContextInfo(context, CL_CONTEXT_DEVICES, 0, nullptr, &size), doing);
    std::vector<cl_device_id> devices(size / sizeof(cl_device_id));
    host::check(clGetContextInfo(context, CL_CONTEXT_DEVICES, size, devices.data(), nullptr), doing);
    if (devices.size() != 1)
        refuse("device", "None", "one of the " + std::to_string(devices.size()) + " of the context");
    return devices.front();
}

cl_device_id device_of(cl_context context, py::handle device) {
    if (device.is_none()) return only_device(context);
    if (py::hasattr(device, "int_ptr")) return object<cl_device_id>(device.attr("int_ptr").cast<Address>());
    return choose_device(device_number(device));
}

}  // namespace

DeviceLimiter::DeviceLimiter(py::handle triangles, py::handle vertex_count, Address context, py::handle device,
                             const py::kwargs& arguments)
    : vertex_count_(from_python<std::uint32_t>(vertex_count, "vertex_count")) {
    enter_opencl();
    const std::vector<Triangle> corners = triangle_list(triangles);
    const Options options = with_arguments(Options{}, arguments, "StrainLimiter", device_option_fields);
    host::check(clRetainContext(object<cl_context>(context)), "apsl: keeping the context");
    context_ = host::ContextHandle(object<cl_context>(context));
    const cl_device_id id = device_of(context_.get(), device);

    const py::gil_scoped_release others_may_run;
    triangle_count_ = corners.size();
    const auto topology = Topology::build(corners, vertex_count_);
    hinge_count_ = topology->hinge_count();
    limiter_.emplace(context_.get(), id, topology, options);
}

Address DeviceLimiter::enqueue(Address queue, const std::map<std::string, Place>& places,
                               const std::vector<Address>& wait_for, const py::kwargs& arguments) {
    enter_opencl();
    const Parameters parameters = with_arguments(Parameters{}, arguments, "enqueue", parameter_fields);
    const auto view = [&](const char* name) {
        const auto found = places.find(name);
        return found == places.end() ? BufferView{}
                                     : BufferView{object<cl_mem>(found->second.first), found->second.second};
    };
    const Buffers buffers{.positions = view("positions"),
                          .velocities = view("velocities"),
                          .inverse_masses = view("inverse_masses"),
                          .rest_areas = view("rest_areas"),
                          .regularization = view("regularization"),
                          .rest_shapes = view("rest_shapes"),
                          .stretch_ceilings = view("stretch_ceiling"),
                          .contacts = view("contacts"),
                          .rest_hinges = view("rest_hinges"),
                          .accelerations = view("accelerations"),
                          .tether_anchors = view("tether_anchors"),
                          .tether_lengths = view("tether_lengths")};
    const py::gil_scoped_release others_may_run;
    const std::lock_guard one_call_at_a_time(mutex_);
    return reinterpret_cast<Address>(
        limiter_->enqueue(object<cl_command_queue>(queue), buffers, parameters, events(wait_for)));
}

py::dict DeviceLimiter::read_stats(Address queue, const std::vector<Address>& wait_for) {
    enter_opencl();
    Stats stats{};
    {
        const py::gil_scoped_release others_may_run;
        host::EventHandle read;
        {
            const std::lock_guard one_call_at_a_time(mutex_);
            read =
                host::EventHandle(limiter_->read_stats(object<cl_command_queue>(queue), {&stats, 1}, events(wait_for)));
        }
        const cl_event read_event = read.get();
        host::check(clWaitForEvents(1, &read_event), "apsl: reading statistics");
    }
    return to_dict(stats, stats_fields);
}

py::dict DeviceLimiter::options() const {
    return to_dict(limiter_->options(), device_option_fields);
}

}  // namespace apsl::python

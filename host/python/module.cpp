// SPDX-License-Identifier: MIT
//
// apsl._core: the C++ interface as the Python package wants it. What a user sees, and its documentation, is in apsl/.
#include "areas.hpp"
#include "device_limiter.hpp"
#include "devices.hpp"
#include "limiter.hpp"
#include "process.hpp"
#include "tethers.hpp"

#include <apsl/version.hpp>

#define APSL_PYTHON_STRING(number) #number
#define APSL_PYTHON_VERSION(major, minor, patch) \
    APSL_PYTHON_STRING(major) "." APSL_PYTHON_STRING(minor) "." APSL_PYTHON_STRING(patch)

namespace apsl::python {
namespace {

// apsl.Error of apsl/_records.py, with what apsl::Error knows.
void translate(std::exception_ptr pointer) {
    try {
        if (pointer) std::rethrow_exception(pointer);
    } catch (const Error& error) {
        const py::object type = py::module_::import("apsl._records").attr("Error");
        const py::object instance = type(error.what(), to_python(error.code()), error.opencl_code(), error.build_log());
        PyErr_SetObject(type.ptr(), instance.ptr());
    }
}

py::list device_dicts() {
    py::list list;
    for (const host::OpenClDevice& device : devices()) {
        py::dict fields;
        fields["number"] = list.size();
        fields["name"] = device.name;
        fields["platform"] = device.platform;
        fields["driver"] = device.driver;
        fields["is_gpu"] = device.is_gpu;
        fields["compute_units"] = device.compute_units;
        fields["memory"] = device.memory;
        list.append(fields);
    }
    return list;
}

PYBIND11_MODULE(_core, module) {
    module.attr("__version__") = APSL_PYTHON_VERSION(APSL_VERSION_MAJOR, APSL_VERSION_MINOR, APSL_VERSION_PATCH);
    watch_forks();
    py::register_exception_translator(translate);
    module.def("devices", device_dicts);
    module.def("rest_areas", areas, py::arg("positions"), py::arg("triangles"));
    module.def("rest_hinges", rest_hinges, py::arg("positions"), py::arg("triangles"));
    module.def("rest_shapes", rest_shapes, py::arg("positions"), py::arg("triangles"));
    module.def("area_change", area_change, py::arg("positions"), py::arg("triangles"), py::arg("rest_areas"));
    module.def("tethers_to_pins", tethers_to_pins, py::arg("rest_positions"), py::arg("triangles"), py::arg("pinned"),
               py::arg("per_vertex"), py::arg("stretch"));
    module.def("pinned_piece_count", pinned_piece_count, py::arg("triangles"), py::arg("vertex_count"),
               py::arg("pinned"));
    module.def("default_parameters", [] { return to_dict(Parameters{}, parameter_fields); });
    py::class_<Limiter>(module, "Limiter")
        .def(py::init<py::handle, py::handle, py::handle, const py::kwargs&>())
        .def("limit", &Limiter::limit)
        .def_property_readonly("options", &Limiter::options)
        .def_property_readonly("scratch_bytes", &Limiter::scratch_bytes);
    py::class_<DeviceLimiter>(module, "DeviceLimiter")
        .def(py::init<py::handle, py::handle, DeviceLimiter::Address, py::handle, const py::kwargs&>())
        .def("enqueue", &DeviceLimiter::enqueue)
        .def("read_stats", &DeviceLimiter::read_stats)
        .def_property_readonly("vertex_count", &DeviceLimiter::vertex_count)
        .def_property_readonly("triangle_count", &DeviceLimiter::triangle_count)
        .def_property_readonly("hinge_count", &DeviceLimiter::hinge_count)
        .def_property_readonly("options", &DeviceLimiter::options)
        .def_property_readonly("scratch_bytes", &DeviceLimiter::scratch_bytes);
}

}  // namespace
}  // namespace apsl::python

// SPDX-License-Identifier: MIT
#include "devices.hpp"

#include "process.hpp"
#include "values.hpp"

#include <apsl/error.hpp>

namespace apsl::python {

std::vector<host::OpenClDevice> devices() {
    enter_opencl();
    return host::opencl_devices();
}

std::optional<std::size_t> device_number(py::handle device) {
    if (device.is_none()) return std::nullopt;
    const py::object number =
        py::hasattr(device, "number") ? py::object(device.attr("number")) : py::reinterpret_borrow<py::object>(device);
    return from_python<std::uint32_t>(number, "device");
}

cl_device_id choose_device(std::optional<std::size_t> wanted) {
    const std::vector<host::OpenClDevice> all = devices();
    if (all.empty())
        throw Error(ErrorCode::unsupported,
                    "no OpenCL device found: install pocl-opencl-icd (runs on any processor) or your graphics card's "
                    "OpenCL driver");
    if (!wanted) return host::default_device(all).id;
    if (*wanted >= all.size())
        throw Error(ErrorCode::invalid_argument, "device: got " + std::to_string(*wanted) + ", expected 0 to " +
                                                     std::to_string(all.size() - 1) + " (see apsl.devices())");
    return all[*wanted].id;
}

}  // namespace apsl::python

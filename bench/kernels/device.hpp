// SPDX-License-Identifier: MIT
#pragma once

#include "host/handles.hpp"
#include "results.hpp"

#include <CL/cl.h>

#include <string>
#include <vector>

namespace apsl::bench {

/// Throws std::runtime_error for a failed call.
void check(cl_int status, const char* what_was_done);

/// The OpenCL device all of a run is measured on.
struct Device {
    cl_device_id id = nullptr;
    bool is_cpu = false;
    host::ContextHandle context;
    host::QueueHandle queue;            ///< in order, for wall time
    host::QueueHandle profiling_queue;  ///< in order, for profiling events
    Place place;                        ///< its copy bandwidth is measured later

    host::BufferHandle buffer(std::size_t bytes, const void* contents = nullptr) const;
    host::BufferHandle upload(const std::vector<float>& contents) const {
        return buffer(contents.size() * sizeof(float), contents.data());
    }
};

/// Of the devices on platforms whose names contain `platform`, the one with that number.
/// Throws std::runtime_error where there is none, naming the platforms there are.
Device open_device(const std::string& platform, std::size_t number);

}  // namespace apsl::bench

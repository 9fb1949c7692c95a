// SPDX-License-Identifier: MIT
#pragma once

#include <CL/opencl.hpp>

#include <stdexcept>
#include <string>
#include <vector>

/// The device with that number over all platforms. Throws std::runtime_error where there is none.
inline cl::Device choose_device(std::size_t number) {
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

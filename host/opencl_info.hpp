// SPDX-License-Identifier: MIT
#pragma once

#include "opencl_error.hpp"

#include <CL/cl.h>

#include <cstddef>
#include <string>

namespace apsl::host {

/// What one of OpenCL's clGet…Info says of an object. Throws Error(opencl); `doing` is as for check().
template <class Value, class Object>
Value info(cl_int(CL_API_CALL* query)(Object, cl_uint, std::size_t, void*, std::size_t*), Object object, cl_uint what,
           const char* doing) {
    Value value{};
    check(query(object, what, sizeof value, &value, nullptr), doing);
    return value;
}

/// A text of an object, up to its first null character.
template <class Object>
std::string info_text(cl_int(CL_API_CALL* query)(Object, cl_uint, std::size_t, void*, std::size_t*), Object object,
                      cl_uint what, const char* doing) {
    std::size_t size = 0;
    check(query(object, what, 0, nullptr, &size), doing);
    std::string text(size, '\0');
    check(query(object, what, size, text.data(), nullptr), doing);
    return text.c_str();
}

}  // namespace apsl::host

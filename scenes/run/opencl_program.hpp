// SPDX-License-Identifier: MIT
#pragma once

#include "host/handles.hpp"

#include <string>

namespace apsl::scenes {

/// A kernel of pipeline/, in a file of its own name. Throws InputError with the first line of the compiler's output.
host::KernelHandle make_kernel(cl_context context, cl_device_id device, const std::string& name,
                               const std::string& definitions = {});

}  // namespace apsl::scenes

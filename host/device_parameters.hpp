// SPDX-License-Identifier: MIT
#pragma once

#include "kernels/layout.h"

#include <apsl/parameters.hpp>

namespace apsl::host {

/// What the kernels read of valid parameters, with what depends on them alone computed once a call.
apsl_parameters device_parameters(const Parameters& p);

}  // namespace apsl::host

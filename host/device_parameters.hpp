// SPDX-License-Identifier: MIT
#pragma once

#include "kernels/layout.h"

#include "resolved_parameters.hpp"

namespace apsl::host {

/// What the kernels read of them.
apslk_parameters device_parameters(const ResolvedParameters& p);

}  // namespace apsl::host

// SPDX-License-Identifier: MIT
#pragma once

#include "host/kernel_sources.hpp"

#include <span>

namespace apsl::scenes {

/// The kernels of pipeline/, embedded at build time.
std::span<const host::KernelSource> kernel_sources();

}  // namespace apsl::scenes

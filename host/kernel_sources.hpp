// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

namespace apsl::host {

/// A file of kernels/, embedded at build time.
struct KernelSource {
    std::string_view name;
    std::string_view text;
};

std::span<const KernelSource> kernel_sources();

}  // namespace apsl::host

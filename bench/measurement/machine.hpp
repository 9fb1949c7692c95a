// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace apsl::bench {

/// The commit the sources stand at, "-dirty" behind it where files outside docs/ differ; "unknown" away from them. What
/// the environment variable APSL_COMMIT says comes first: bench/gpu.sh runs programs far from their sources.
std::string commit();

/// As the operating system names it.
std::string processor_name();

}  // namespace apsl::bench

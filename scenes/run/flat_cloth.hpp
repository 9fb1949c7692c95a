// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "run/report.hpp"

#include <optional>
#include <string>

namespace apsl::scenes {

/// A line about a limited cloth that lies exactly in one coordinate plane at the end of a run in which it was pushed
/// together: no spring and no limiter has a direction out of the plane, so that it cannot fold, and areas cannot be
/// held. Nothing otherwise. `summary`: of the whole run.
std::optional<std::string> flat_cloth_warning(const ClothState& cloth, const RunSummary& summary);

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#pragma once

#include "run/report.hpp"

#include <string>

namespace apsl::scenes {

/// What a person wants to know of a run, a few lines of text.
std::string summary_text(const RunReport& report);

/// What to do about frames whose solves did not converge; empty where all did.
std::string convergence_advice(const RunReport& report);

/// What to do about frames that ended far above the stretch ceiling; empty where none did.
std::string ceiling_advice(const RunReport& report);

}  // namespace apsl::scenes

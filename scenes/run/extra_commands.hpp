// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace apsl::scenes {

/// Commands that the program has only in a build with APSL_BUILD_COMPARE: bench/compare/ defines this then, and
/// no_extra_commands.cpp otherwise. `chosen` is set where one of them was parsed, to what runs it: exit code and
/// exceptions as in commands.hpp.
void add_extra_commands(CLI::App& program, std::function<int()>& chosen);

}  // namespace apsl::scenes

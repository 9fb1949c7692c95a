// SPDX-License-Identifier: MIT
#include "run/extra_commands.hpp"

namespace apsl::scenes {

void add_extra_commands(CLI::App&, std::function<int()>&) {
}

}  // namespace apsl::scenes

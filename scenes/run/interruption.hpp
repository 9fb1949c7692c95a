// SPDX-License-Identifier: MIT
#pragma once

namespace apsl::scenes {

/// From here on the first Ctrl-C or SIGTERM is noted; a second one ends the program at once.
void note_interruptions();

/// Whether one has been noted.
bool interrupted();

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#pragma once

namespace apsl::scenes {

/// From here on the first Ctrl-C, SIGTERM or SIGHUP (its terminal is closed) is noted; a second one ends the program
/// at once.
void note_interruptions();

/// Whether one has been noted.
bool interrupted();

/// What shells have for a program that the noted signal ended: 130 of Ctrl-C, 143 of SIGTERM, 129 of SIGHUP.
int exit_code_of_interruption();

}  // namespace apsl::scenes

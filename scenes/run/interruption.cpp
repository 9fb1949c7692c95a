// SPDX-License-Identifier: MIT
#include "run/interruption.hpp"

#include <csignal>

namespace apsl::scenes {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int signal) {
    noted = signal;
}

}  // namespace

void note_interruptions() {
    struct sigaction action = {};
    action.sa_handler = note;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // Under nohup it is ignored, and stays so.
    struct sigaction present = {};
    sigaction(SIGHUP, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() {
    return noted != 0;
}

int exit_code_of_interruption() {
    return 128 + static_cast<int>(noted);
}

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#include "run/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace apsl::scenes {

Progress::Progress(int frames) : frames_(frames), on_terminal_(isatty(STDERR_FILENO) != 0) {
}

Progress::~Progress() {
    if (bar_drawn_) std::fputc('\n', stderr);
}

void Progress::show(const FrameReport& frame) {
    const int done = frame.frame + 1;
    if (on_terminal_) {
        constexpr int width = 30;
        const auto filled = static_cast<std::size_t>(static_cast<long long>(width) * done / frames_);
        const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
        std::fprintf(stderr, "\r[%s] %d/%d frames, area change %.3g %%, %.3g ms a frame \033[K", bar.c_str(), done,
                     frames_, 100.0 * frame.max_area_change, 1e3 * frame.step_seconds);
        bar_drawn_ = true;
        return;
    }
    const int every = std::max(1, (frames_ + 4) / 5);
    if (done % every == 0 || done == frames_) {
        std::fprintf(stderr, "frame %d of %d: area change %.3g %%, %.3g ms\n", done, frames_,
                     100.0 * frame.max_area_change, 1e3 * frame.step_seconds);
    }
}

}  // namespace apsl::scenes

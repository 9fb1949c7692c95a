// SPDX-License-Identifier: MIT
#pragma once

#include "run/report.hpp"

namespace apsl::scenes {

/// How far a run is, on stderr: a bar that is drawn over on a terminal, a few plain lines elsewhere.
class Progress {
public:
    explicit Progress(int frames);
    /// Ends the bar's line, also when an error leaves it half-way.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(const FrameReport& frame);

private:
    int frames_;
    bool on_terminal_;
    bool bar_drawn_ = false;
};

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#include "stability/fuzz/watchdog.hpp"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace apsl::test {

Watchdog::Watchdog() : thread_([this] { watch(); }) {
}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    changed_.notify_one();
    thread_.join();
}

void Watchdog::begin(std::string what, std::chrono::seconds patience) {
    {
        const std::lock_guard lock(mutex_);
        what_ = std::move(what);
        patience_ = patience;
        heard_ = true;
    }
    changed_.notify_one();
}

void Watchdog::watch() {
    std::unique_lock lock(mutex_);
    while (!ended_) {
        heard_ = false;
        if (changed_.wait_for(lock, patience_, [&] { return heard_ || ended_; })) continue;
        std::printf("no end after %lld s: %s\n", static_cast<long long>(patience_.count()), what_.c_str());
        std::fflush(stdout);
        std::_Exit(3);
    }
}

}  // namespace apsl::test

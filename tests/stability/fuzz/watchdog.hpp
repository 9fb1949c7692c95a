// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace apsl::test {

/// Ends the process with exit code 3 and the words it was given last where nothing more is heard for too long: a kernel
/// that never ends cannot be ended otherwise.
class Watchdog {
public:
    Watchdog();
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// What is about to run, and how long it may take.
    void begin(std::string what, std::chrono::seconds patience);

private:
    void watch();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string what_;
    std::chrono::seconds patience_{3600};
    bool heard_ = false, ended_ = false;
    std::thread thread_;
};

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
#pragma once

#include <CL/opencl.hpp>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Of a frame on the device, ms.
struct FrameTimes {
    double frame, stage;
};

/// What host and device did when, in Chrome's trace format (chrome://tracing, ui.perfetto.dev): one row for the host's
/// calls, one for the device's queue, µs since the first call. The queue must have CL_QUEUE_PROFILING_ENABLE.
class Trace {
public:
    /// A frame begins, and with it its first stage.
    void begin_frame(int frame) {
        frame_ = frame;
        queued_before_ = now();
    }

    /// The host has just queued a stage, and began to where it had queued the one before. `last`: the stage's last
    /// command. `many`: it has others.
    void add(const char* stage, const cl::Event& last, bool many) {
        const double end = now();
        stages_.push_back({stage, frame_, queued_before_, end, last, many});
        queued_before_ = end;
    }

    /// Only once all commands have ended. The slice of a stage of many commands begins where the stage before ended: an
    /// event tells of its own command alone.
    void write(const std::string& path) const {
        std::ofstream file(path);
        file << std::fixed << std::setprecision(3) << R"({"displayTimeUnit": "ms", "traceEvents": [)" << '\n'
             << R"({"ph": "M", "pid": 1, "tid": 1, "name": "thread_name", "args": {"name": "host: enqueue"}},)" << '\n'
             << R"({"ph": "M", "pid": 1, "tid": 2, "name": "thread_name", "args": {"name": "device: queue"}})";
        const double first = stages_.empty() ? 0.0 : stages_.front().begin;
        const double shift = host_minus_device() - first;
        double before = 0.0;
        for (const Stage& stage : stages_) {
            const auto slice = [&](int row, double begin, double end) {
                file << ",\n{\"ph\": \"X\", \"pid\": 1, \"tid\": " << row << ", \"name\": \"" << stage.name
                     << "\", \"ts\": " << begin << ", \"dur\": " << end - begin
                     << ", \"args\": {\"frame\": " << stage.frame << "}}";
            };
            slice(1, stage.begin - first, stage.end - first);
            const double start = device_time<CL_PROFILING_COMMAND_START>(stage) + shift;
            const double end = device_time<CL_PROFILING_COMMAND_END>(stage) + shift;
            slice(2, stage.many ? before : start, end);
            before = end;
        }
        file << "\n]}\n";
        if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
    }

    /// Only once all commands have ended. Medians: of a frame's time, and of what the stages of that name take of it. A
    /// stage begins where the one before ended; the first frame, whose kernels run for the first time, is left out.
    FrameTimes frame_times(std::string_view name) const {
        std::vector<FrameTimes> frames;
        for (std::size_t n = 1; n < stages_.size(); ++n) {
            const Stage& stage = stages_[n];
            if (stage.frame == 0) continue;
            if (stage.frame != stages_[n - 1].frame) frames.push_back({0.0, 0.0});
            const double taken = 1e-3 * (device_time<CL_PROFILING_COMMAND_END>(stage) -
                                         device_time<CL_PROFILING_COMMAND_END>(stages_[n - 1]));
            frames.back().frame += taken;
            if (stage.name == name) frames.back().stage += taken;
        }
        const auto median = [&](double FrameTimes::* time) {
            if (frames.empty()) return 0.0;
            const auto middle = frames.begin() + static_cast<std::ptrdiff_t>(frames.size() / 2);
            std::nth_element(frames.begin(), middle, frames.end(),
                             [&](const FrameTimes& a, const FrameTimes& b) { return a.*time < b.*time; });
            return *middle.*time;
        };
        return {median(&FrameTimes::frame), median(&FrameTimes::stage)};
    }

private:
    struct Stage {
        const char* name;
        int frame;
        double begin, end;  // of the host's calls, µs
        cl::Event event;
        bool many;
    };

    /// µs
    static double now() {
        return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    template <cl_profiling_info what>
    static double device_time(const Stage& stage) {
        return 1e-3 * static_cast<double>(stage.event.getProfilingInfo<what>());
    }

    /// OpenCL 1.2 does not relate the two clocks, but a command is queued by the device's clock within the call that
    /// queues it by the host's. The shortest call tells the difference best, to half its length.
    double host_minus_device() const {
        const auto shorter = [](const Stage& a, const Stage& b) { return a.end - a.begin < b.end - b.begin; };
        const auto shortest = std::min_element(stages_.begin(), stages_.end(), shorter);
        if (shortest == stages_.end()) return 0.0;
        return 0.5 * (shortest->begin + shortest->end) - device_time<CL_PROFILING_COMMAND_QUEUED>(*shortest);
    }

    std::vector<Stage> stages_;
    int frame_ = 0;
    double queued_before_ = 0.0;  // µs
};

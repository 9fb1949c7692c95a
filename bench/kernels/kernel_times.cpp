// SPDX-License-Identifier: MIT
#include "kernel_times.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace apsl::bench {
namespace {

/// The part of the filter that a kernel belongs to.
std::string phase_of(const std::string& kernel) {
    static const std::array<std::pair<const char*, std::vector<std::string>>, 8> phases{{
        {"matrix and right-hand side", {"bound_vertices", "assemble_gradients", "assemble_pressure_csr"}},
        {"CG: apply", {"matrix_free_apply_dot", "csr_spmv_dot"}},
        {"CG: vectors", {"cg_update"}},
        {"CG: warm start and last iterations", {"measure_guess", "start_from_guess", "finish_solve"}},
        {"Chebyshev", {"chebyshev_step"}},
        {"displacements", {"gather_displacements"}},
        {"begin and end",
         {"set_parameters", "predict_positions", "order_triangle_values", "measure_step", "judge_whole_step",
          "start_small_steps", "begin_solve", "measure_area_change", "end_call", "update_velocities"}},
        {"all in one launch", {"filter_in_one_group"}},
    }};
    for (const auto& [phase, kernels] : phases)
        if (std::find(kernels.begin(), kernels.end(), kernel) != kernels.end()) return phase;
    return "other kernels";
}

}  // namespace

void KernelTimes::add(const std::vector<KernelTime>& call) {
    ++calls_;
    for (const KernelTime& kernel : call) {
        Samples& samples = samples_[kernel.name];
        samples.launches = static_cast<long>(kernel.launches);
        samples.per_launch.push_back(kernel.seconds / static_cast<double>(std::max<std::int64_t>(kernel.launches, 1)));
    }
}

std::vector<Measurement> KernelTimes::kernels(const Sizes& sizes, int iterations) const {
    std::vector<Measurement> result;
    for (const auto& [name, samples] : samples_) {
        const auto [median, spread] = median_and_spread(samples.per_launch);
        Measurement& m = result.emplace_back();
        m.quantity = "kernel";
        m.clock = "device";
        m.name = name;
        m.median = median;
        m.spread = spread;
        m.bytes = bytes_moved(name, sizes, iterations);
    }
    return result;
}

std::vector<Measurement> KernelTimes::phases(double wall) const {
    std::map<std::string, std::vector<double>> seconds;
    for (const auto& [name, samples] : samples_) {
        std::vector<double>& phase = seconds[phase_of(name)];
        phase.resize(calls_);
        for (std::size_t call = 0; call < samples.per_launch.size(); ++call)
            phase[call] += static_cast<double>(samples.launches) * samples.per_launch[call];
    }
    std::vector<Measurement> result;
    double remaining = wall;
    for (const auto& [name, of_calls] : seconds) {
        const auto [median, spread] = median_and_spread(of_calls);
        Measurement& m = result.emplace_back();
        m.quantity = "phase";
        m.clock = "device";
        m.name = name;
        m.median = median;
        m.spread = spread;
        remaining -= median;
    }
    if (remaining > 0.0) {
        Measurement& between = result.emplace_back();
        between.quantity = "phase";
        between.clock = "host";
        between.name = "between kernels";
        between.median = remaining;
    }
    return result;
}

std::optional<Measurement> KernelTimes::iteration(const Sizes& sizes, int iterations) const {
    std::vector<double> seconds(calls_, 0.0);
    bool any = false;
    for (const auto& [name, samples] : samples_)
        if (samples.launches >= iterations && samples.per_launch.size() == calls_) {
            any = true;
            for (std::size_t call = 0; call < calls_; ++call) seconds[call] += samples.per_launch[call];
        }
    if (!any) return std::nullopt;
    const auto [median, spread] = median_and_spread(seconds);
    Measurement m;
    m.quantity = "cg_iteration";
    m.clock = "device";
    m.median = median;
    m.spread = spread;
    m.bytes = sum_of_bytes(sizes, iterations, iterations);
    return m;
}

std::optional<double> KernelTimes::iteration_bytes(const Sizes& sizes, int iterations) const {
    return sum_of_bytes(sizes, iterations, std::numeric_limits<int>::max());
}

std::optional<double> KernelTimes::sum_of_bytes(const Sizes& sizes, int iterations, int averaged_over) const {
    double sum = 0.0;
    for (const auto& [name, samples] : samples_)
        if (samples.launches >= iterations) {
            const std::optional<double> bytes = bytes_moved(name, sizes, averaged_over);
            if (!bytes) return std::nullopt;
            sum += *bytes;
        }
    return sum > 0.0 ? std::optional(sum) : std::nullopt;
}

}  // namespace apsl::bench

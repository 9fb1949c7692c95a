// SPDX-License-Identifier: MIT
#pragma once

#include "bytes.hpp"
#include "results.hpp"

#include <apsl/strain_limiter.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace apsl::bench {

/// The kernels of several filter calls alike, from their profiling events.
class KernelTimes {
public:
    /// The kernels of one call.
    void add(const std::vector<KernelTime>& call);

    /// Median time of a launch, for every kernel; solves are of `iterations`.
    std::vector<Measurement> kernels(const Sizes& sizes, int iterations) const;
    /// What a call that takes `wall` seconds spends its time on; adds up to it.
    std::vector<Measurement> phases(double wall) const;
    /// The kernels that a call launches for each of its `iterations`, together; none where there are no such kernels.
    std::optional<Measurement> iteration(const Sizes& sizes, int iterations) const;
    /// Bytes of these in an iteration that is not a solve's first; none where one of them is not counted.
    std::optional<double> iteration_bytes(const Sizes& sizes, int iterations) const;

private:
    struct Samples {
        long launches = 0;               ///< of one call
        std::vector<double> per_launch;  ///< s, one for each call
    };
    std::optional<double> sum_of_bytes(const Sizes& sizes, int iterations, int averaged_over) const;

    std::map<std::string, Samples> samples_;
    std::size_t calls_ = 0;
};

}  // namespace apsl::bench

// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace apsl::bench {

/// Where a method runs.
struct Place {
    std::string device;  ///< CL_DEVICE_NAME, or the processor
    std::string driver;  ///< CL_DRIVER_VERSION with the platform's name, or the compiler and its flags
    int threads = 1;
    std::optional<double> copy_bandwidth;  ///< B/s, of this device in this run
};

/// One row of docs/benchmark.schema.json, which says what the fields mean.
struct Measurement {
    std::string quantity, method, clock;
    std::optional<std::string> name;
    std::size_t triangles = 0;
    double median = 0.0, spread = 0.0;  ///< s
    std::optional<double> bytes, error, residual, max_area_change;
};

/// Median, and third quartile minus first. Both in the unit of the samples, which are at least one.
struct MedianAndSpread {
    double median, spread;
};
MedianAndSpread median_and_spread(std::vector<double> samples);

/// The measurements of one run.
class Results {
public:
    /// Looks up the commit the sources stand at.
    Results();

    /// A measurement whose time is not above zero (a difference of two times that drowned in noise) is left out, and
    /// said so on stderr.
    void add(const Place& place, const Measurement& measurement);
    /// Takes this copy bandwidth, B/s, for all rows that have a lower one: a busy moment must not flatter anybody.
    void raise_copy_bandwidth(double bandwidth);
    /// Writes the file whole or not at all. Throws std::runtime_error.
    void write(const std::string& path) const;

private:
    std::string commit_;
    std::vector<std::pair<Place, Measurement>> rows_;
};

/// The processor, with the compiler that made this program.
Place processor(int threads);

}  // namespace apsl::bench

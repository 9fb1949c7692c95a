// SPDX-License-Identifier: MIT
#include "results.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace apsl::bench {
namespace {

std::string output_of(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::string output;
    std::array<char, 256> line{};
    while (pipe && std::fgets(line.data(), static_cast<int>(line.size()), pipe.get())) output += line.data();
    while (!output.empty() && output.back() == '\n') output.pop_back();
    return output;
}

/// The commit the sources stand at, "-dirty" behind it where files differ.
std::string commit() {
    const std::string description =
        output_of("git -C '" APSL_SOURCE_DIRECTORY "' describe --always --abbrev=12 --dirty --exclude='*' 2>/dev/null");
    return description.empty() ? "unknown" : description;
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown processor";
}

template <class Value>
nlohmann::json value_or_null(const std::optional<Value>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace

MedianAndSpread median_and_spread(std::vector<double> samples) {
    std::sort(samples.begin(), samples.end());
    const auto quantile = [&](double fraction) {
        const double place = fraction * static_cast<double>(samples.size() - 1);
        const auto below = static_cast<std::size_t>(place);
        const std::size_t above = std::min(below + 1, samples.size() - 1);
        const double weight = place - static_cast<double>(below);
        return (1.0 - weight) * samples[below] + weight * samples[above];
    };
    return {quantile(0.5), quantile(0.75) - quantile(0.25)};
}

Results::Results() : commit_(commit()) {
}

void Results::add(const Place& place, const Measurement& measurement) {
    if (measurement.median > 0.0)
        rows_.emplace_back(place, measurement);
    else
        std::cerr << "warning: " << measurement.method << ", " << measurement.triangles
                  << " triangles: " << measurement.quantity << " left out, it took no time that could be measured\n";
}

void Results::raise_copy_bandwidth(double bandwidth) {
    for (auto& [place, measurement] : rows_)
        if (place.copy_bandwidth) place.copy_bandwidth = std::max(*place.copy_bandwidth, bandwidth);
}

void Results::write(const std::string& path) const {
    nlohmann::json rows = nlohmann::json::array();
    for (const auto& [place, m] : rows_) {
        nlohmann::json row{{"commit", commit_},
                           {"device", place.device},
                           {"driver", place.driver},
                           {"build_type", APSL_BUILD_TYPE},
                           {"threads", place.threads},
                           {"triangles", m.triangles},
                           {"quantity", m.quantity},
                           {"name", value_or_null(m.name)},
                           {"method", m.method},
                           {"clock", m.clock},
                           {"median_seconds", m.median},
                           {"spread", m.spread},
                           {"bytes_moved", value_or_null(m.bytes)},
                           {"gb_per_second", nullptr},
                           {"copy_gb_per_second", nullptr},
                           {"error", value_or_null(m.error)}};
        if (m.bytes) row["gb_per_second"] = 1e-9 * *m.bytes / m.median;
        if (place.copy_bandwidth) row["copy_gb_per_second"] = 1e-9 * *place.copy_bandwidth;
        if (m.residual) row["residual"] = *m.residual;
        if (m.max_area_change) row["max_area_change"] = *m.max_area_change;
        rows.push_back(std::move(row));
    }
    const std::string part = path + ".part";
    {
        std::ofstream file(part);
        file << rows.dump(1) << '\n';
        if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
    }
    std::filesystem::rename(part, path);
}

Place processor(int threads) {
    static const std::string name = processor_name();
    return {name, "GCC-compatible " __VERSION__ ", " APSL_COMPILER_FLAGS, threads, std::nullopt};
}

}  // namespace apsl::bench

// SPDX-License-Identifier: MIT
#include "results.hpp"

#include "measurement/machine.hpp"
#include "measurement/quartiles.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace apsl::bench {
namespace {

template <class Value>
nlohmann::json value_or_null(const std::optional<Value>& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
}

}  // namespace

MedianAndSpread median_and_spread(std::vector<double> samples) {
    const Quartiles q = quartiles(std::move(samples));
    return {q.median, q.third - q.first};
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

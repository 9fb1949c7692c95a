// SPDX-License-Identifier: MIT
#include "stability/drift.hpp"

#include <stdexcept>

namespace apsl::test {
namespace {

template <class Quantity>
void add_growth(const std::vector<Stretch>& stretches, std::size_t settled, Quantity Stretch::* quantity,
                Quantity limit, const std::string& name, std::vector<std::string>& lines) {
    const Quantity first = stretches[settled].*quantity;
    for (std::size_t n = settled + 1; n < stretches.size(); ++n) {
        const Quantity now = stretches[n].*quantity;
        if (now <= first + limit) continue;  // false as well where it is not a number
        lines.push_back(name + " went from " + std::to_string(first) + " (up to frame " +
                        std::to_string(stretches[settled].last_frame) + ") to " + std::to_string(now) +
                        " (up to frame " + std::to_string(stretches[n].last_frame) + "), allowed is a rise of " +
                        std::to_string(limit));
        return;
    }
}

}  // namespace

std::vector<std::string> drift(const std::vector<Stretch>& stretches, std::size_t settled, const DriftLimits& limits) {
    if (settled + 2 > stretches.size())
        throw std::invalid_argument(std::to_string(stretches.size()) + " stretches of frames, of which " +
                                    std::to_string(settled) + " settle: at least two more are needed");
    std::vector<std::string> lines;
    add_growth(stretches, settled, &Stretch::kinetic_energy, limits.energy, "kinetic energy in J", lines);
    add_growth(stretches, settled, &Stretch::total_energy, limits.energy, "total energy in J", lines);
    add_growth(stretches, settled, &Stretch::max_area_change, limits.area_change, "greatest area change", lines);
    add_growth(stretches, settled, &Stretch::rms_area_change, limits.area_change, "RMS area change", lines);
    add_growth(stretches, settled, &Stretch::resident_bytes, limits.bytes, "resident memory in bytes", lines);
    return lines;
}

}  // namespace apsl::test

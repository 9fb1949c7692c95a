// SPDX-License-Identifier: MIT
#include "run/float_range.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string_view>
#include <vector>

namespace apsl::scenes {
namespace {

using Limits = std::numeric_limits<float>;

/// `each` values in a row belong to one vertex or triangle.
struct Quantity {
    const std::vector<double>& values;
    std::size_t each;
    double least, greatest;  // sizes; 0 is held too
    std::string_view what;
};

std::optional<std::string> beyond(const Quantity& quantity) {
    for (std::size_t i = 0; i < quantity.values.size(); ++i) {
        const double size = std::abs(quantity.values[i]);
        if (size == 0.0 || (size >= quantity.least && size <= quantity.greatest)) continue;
        std::ostringstream text;
        text << quantity.what << " " << i / quantity.each << " is " << quantity.values[i]
             << ", beyond the 32 bits that the device holds; change the mesh's size or masses, or run with --backend "
                "reference";
        return text.str();
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::string> beyond_float_range(const ClothState& cloth) {
    const double greatest = Limits::max();
    const Quantity quantities[] = {
        {cloth.positions, 3, 0.0, greatest, "a coordinate (m) of vertex"},
        // Kernels square an area.
        {cloth.rest_areas, 1, Limits::min(), std::sqrt(greatest), "the rest area (m²) of triangle"},
        {cloth.inverse_masses, 1, Limits::min(), greatest, "the inverse mass (1/kg) of vertex"},
    };
    for (const Quantity& quantity : quantities)
        if (auto text = beyond(quantity)) return text;
    return std::nullopt;
}

}  // namespace apsl::scenes

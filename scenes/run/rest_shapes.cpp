// SPDX-License-Identifier: MIT
#include "run/rest_shapes.hpp"

#include <apsl/reference.hpp>

#include <cmath>

namespace apsl::scenes {

std::vector<double> rest_shapes(const ClothState& cloth) {
    std::vector<double> shapes = reference::rest_shapes<double>(*cloth.topology, cloth.rest_positions);
    const std::vector<double> areas = reference::areas<double>(*cloth.topology, cloth.rest_positions);
    for (std::size_t n = 0; n < shapes.size(); ++n) {
        const double rest_area = cloth.rest_areas[n / 4];
        if (rest_area != areas[n / 4] && rest_area > 0.0) shapes[n] *= std::sqrt(areas[n / 4] / rest_area);
    }
    return shapes;
}

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#include "compare/method_cloth.hpp"

#include "pipeline/geometry.hpp"

namespace apsl::compare {

methods::Cloth as_method_cloth(const scenes::ClothState& cloth, double time_step) {
    methods::Cloth copy{.topology = cloth.topology,
                        .rest_positions = {},
                        .rest_areas = cloth.rest_areas,
                        .inverse_masses = cloth.inverse_masses,
                        .time_step = time_step};
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v)
        copy.rest_positions.emplace_back(scenes::vector_at(std::span<const double>(cloth.rest_positions), v));
    return copy;
}

bool all_finite(std::span<const Eigen::Vector3f> vectors) {
    for (const Eigen::Vector3f& vector : vectors)
        if (!vector.allFinite()) return false;
    return true;
}

}  // namespace apsl::compare

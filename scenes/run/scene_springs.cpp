// SPDX-License-Identifier: MIT
#include "run/scene_springs.hpp"

#include <utility>

namespace apsl::scenes {
namespace {

SceneSprings springs_of(const NoIntegrator&, const Scene&, const ClothState&) {
    return {};
}

SceneSprings springs_of(const ImplicitSpringsIntegrator& implicit, const Scene&, const ClothState& cloth) {
    const Topology& topology = *cloth.topology;
    SceneSprings made{.springs = {}, .damping = implicit.damping, .warnings = {}};
    if (implicit.stretch_stiffness > 0.0)
        made.springs = stretch_springs(topology, cloth.rest_positions, implicit.stretch_stiffness);
    if (implicit.bend_stiffness > 0.0) {
        const auto bending = bending_springs(topology, cloth.rest_positions, implicit.bend_stiffness);
        made.springs.insert(made.springs.end(), bending.begin(), bending.end());
    }
    return made;
}

SceneSprings springs_of(const StandAloneIntegrator&, const Scene&, const ClothState&) {
    return {};
}

SceneSprings springs_of(const BendingSpringsIntegrator& bending, const Scene& scene, const ClothState& cloth) {
    StandAloneSprings springs = stand_alone_springs(*cloth.topology, cloth.rest_positions, bending.bend_stiffness);
    SceneSprings made{.springs = {}, .damping = bending.damping, .warnings = {}};
    if (const std::size_t added = springs.between_lattices + springs.connecting; added > 0) {
        made.warnings.push_back(
            scene.file + ": integrator.bending_springs: bending springs left the cloth in " +
            std::to_string(springs.lattices) + " lattices that only areas join; " + std::to_string(added) +
            " springs between them were added, an irregular mesh (a grid with random diagonals) needs none");
    }
    made.springs = std::move(springs.springs);
    return made;
}

}  // namespace

SceneSprings make_scene_springs(const Scene& scene, const ClothState& cloth) {
    return std::visit([&](const auto& integrator) { return springs_of(integrator, scene, cloth); }, scene.integrator);
}

}  // namespace apsl::scenes

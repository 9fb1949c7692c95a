// SPDX-License-Identifier: MIT
#include "run/parse_vertices.hpp"

#include <limits>
#include <utility>

namespace apsl::scenes {
namespace {

constexpr std::int64_t max_index = std::numeric_limits<std::int32_t>::max();

}  // namespace

Motion parse_motion(SceneObject object) {
    Motion motion;
    motion.start = object.number("start", motion.start, Range::at_least(0.0));
    motion.stop = object.number("stop", motion.stop, Range::at_least(motion.start));
    const std::string kind = object.only_one_of({"rotate", "translate"});
    SceneObject path(object.find(kind));
    if (kind == "rotate") {
        Rotation rotation;
        rotation.axis = path.vector3("axis", rotation.axis);
        rotation.degrees_per_second = path.number("degrees_per_second", rotation.degrees_per_second);
        if (path.has("center")) rotation.center = path.vector3("center", {});
        if (rotation.axis == std::array<double, 3>{}) path.find("axis").fail("expected an axis of any length but 0");
        motion.path = rotation;
    } else {
        motion.path = Translation{path.vector3("velocity", {})};
    }
    path.refuse_other_keys();
    return motion;
}

namespace {

// Keys that may stand beside the selection have been asked for before.
VertexSelection parse_selection(SceneObject& object) {
    const std::string kind = object.only_one_of({"vertices", "corners", "box"});
    const SceneValue value = object.find(kind);
    // None would leave the cloth free where its user pinned it.
    if (value.json->is_array() && value.json->empty()) value.expected("at least one");
    if (kind == "vertices") {
        SelectedVertices selection;
        for (const SceneValue& vertex : value.entries())
            selection.vertices.push_back(static_cast<std::uint32_t>(vertex.integer(0, max_index)));
        return selection;
    }
    if (kind == "corners") {
        SelectedCorners selection;
        for (const SceneValue& corner : value.entries()) selection.corners.push_back(corner.text());
        return selection;
    }
    SceneObject box_object(value);
    SelectedBox box;
    box.min = box_object.vector3("min", box.min);
    box.max = box_object.vector3("max", box.max);
    box_object.refuse_other_keys();
    return box;
}

}  // namespace

Pin parse_pin(SceneObject object) {
    Pin pin;
    if (object.has("motion")) pin.motion = parse_motion(SceneObject(object.find("motion")));
    pin.selection = parse_selection(object);
    return pin;
}

MassFactor parse_mass_factor(SceneObject object) {
    MassFactor masses;
    masses.factor = object.number("factor", masses.factor, Range::above(0.0));
    masses.selection = parse_selection(object);
    return masses;
}

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#include "run/select_vertices.hpp"

#include "run/input_error.hpp"

#include <algorithm>
#include <optional>
#include <span>

namespace apsl::scenes {
namespace {

struct BoundingBox {
    std::array<double, 3> min;
    std::array<double, 3> max;
};

BoundingBox bounding_box(const Mesh& mesh) {
    BoundingBox box{{mesh.positions[0], mesh.positions[1], mesh.positions[2]},
                    {mesh.positions[0], mesh.positions[1], mesh.positions[2]}};
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        box.min[k % 3] = std::min(box.min[k % 3], mesh.positions[k]);
        box.max[k % 3] = std::max(box.max[k % 3], mesh.positions[k]);
    }
    return box;
}

// "min_x_max_z": one coordinate per named axis, none where the name is no corner.
std::optional<std::array<std::optional<double>, 3>> corner_coordinates(const std::string& name,
                                                                       const BoundingBox& box) {
    std::array<std::optional<double>, 3> coordinates;
    if (name.size() % 6 != 5) return std::nullopt;  // terms of five letters, "_" between them
    for (std::size_t k = 0; k < name.size(); k += 6) {
        const std::string side = name.substr(k, 4);
        const std::size_t axis = static_cast<std::size_t>(name[k + 4] - 'x');
        const bool ends_well = k + 5 == name.size() || name[k + 5] == '_';
        if ((side != "min_" && side != "max_") || axis > 2 || coordinates[axis] || !ends_well) return std::nullopt;
        coordinates[axis] = side == "min_" ? box.min[axis] : box.max[axis];
    }
    return coordinates;
}

std::uint32_t nearest_vertex(const Mesh& mesh, const std::array<std::optional<double>, 3>& coordinates) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        double distance = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!coordinates[axis]) continue;
            const double difference = mesh.positions[3 * v + axis] - *coordinates[axis];
            distance += difference * difference;
        }
        if (distance < least) {
            least = distance;
            nearest = v;
        }
    }
    return static_cast<std::uint32_t>(nearest);
}

std::vector<std::uint32_t> select(const SelectedVertices& selection, const Mesh& mesh, const std::string& where) {
    const bool welded = !mesh.welded_to.empty();
    const std::size_t count = welded ? mesh.welded_to.size() : mesh.vertex_count();
    std::vector<std::uint32_t> vertices = selection.vertices;
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        if (vertices[k] >= count) {
            throw InputError(where + ".vertices[" + std::to_string(k) + "]: vertex " + std::to_string(vertices[k]) +
                             " is out of range, expected 0 to " + std::to_string(count - 1));
        }
        if (welded) vertices[k] = mesh.welded_to[vertices[k]];
    }
    return vertices;
}

std::vector<std::uint32_t> select(const SelectedCorners& selection, const Mesh& mesh, const std::string& where) {
    const BoundingBox box = bounding_box(mesh);
    std::vector<std::uint32_t> vertices;
    for (const std::string& name : selection.corners) {
        const auto coordinates = corner_coordinates(name, box);
        if (!coordinates) {
            throw InputError(where + ".corners: \"" + name +
                             "\" is no corner, expected min or max of each axis that matters, such as min_x_max_z");
        }
        vertices.push_back(nearest_vertex(mesh, *coordinates));
    }
    return vertices;
}

std::vector<std::uint32_t> select(const SelectedBox& box, const Mesh& mesh, const std::string& where) {
    std::vector<std::uint32_t> vertices;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double coordinate = mesh.positions[3 * v + axis];
            inside = inside && coordinate >= box.min[axis] && coordinate <= box.max[axis];
        }
        if (inside) vertices.push_back(static_cast<std::uint32_t>(v));
    }
    if (vertices.empty()) throw InputError(where + ".box: no vertex of the mesh lies inside, expected at least one");
    return vertices;
}

}  // namespace

std::vector<std::uint32_t> select_vertices(const VertexSelection& selection, const Mesh& mesh,
                                           const std::string& where) {
    return std::visit([&](const auto& kind) { return select(kind, mesh, where); }, selection);
}

std::vector<PinGroup> resolve_pins(const Scene& scene, const Mesh& mesh) {
    std::vector<PinGroup> groups;
    for (std::size_t k = 0; k < scene.pins.size(); ++k) {
        const std::string where = scene.file + ": pins[" + std::to_string(k) + "]";
        groups.push_back({select_vertices(scene.pins[k].selection, mesh, where), scene.pins[k].motion});
    }
    return groups;
}

}  // namespace apsl::scenes

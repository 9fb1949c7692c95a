// SPDX-License-Identifier: MIT
#include "caller_buffers.hpp"

#include "caller_objects.hpp"
#include "invalid.hpp"
#include "kernels/constants.h"

#include <cstdint>
#include <cstdlib>
#include <string>

namespace apsl::host {
namespace {

// Floats from the first number of the first vertex to the last of the last.
std::size_t vector_extent(std::size_t vertices, std::uint32_t stride, std::uint32_t component_stride) {
    return (vertices - 1) * stride + std::size_t{2} * component_stride + 1;
}

// Vertices of both may alternate in one buffer, but no float belongs to both. Looked at where the strides are alike;
// two sub-buffers of one buffer are taken to be apart.
void check_velocities_apart(const Buffers& buffers, const Options& options, std::size_t vertices) {
    if (buffers.velocities.buffer != buffers.positions.buffer || options.velocity_stride != options.position_stride ||
        options.velocity_component_stride != options.position_component_stride)
        return;
    const auto floats = [](const BufferView& view) { return static_cast<std::int64_t>(view.offset / sizeof(float)); };
    const std::int64_t apart = floats(buffers.velocities) - floats(buffers.positions);
    const std::int64_t stride = options.position_stride, component_stride = options.position_component_stride;
    for (std::int64_t components = -2; components <= 2; ++components) {
        const std::int64_t rest = apart - components * component_stride;
        if (rest % stride == 0 && std::abs(rest / stride) < static_cast<std::int64_t>(vertices))
            invalid("buffers.velocities overlaps buffers.positions: both begin in one buffer, " +
                    std::to_string(apart) + " floats apart");
    }
}

}  // namespace

std::size_t position_floats(const Options& options, const CallerCounts& counts) {
    return vector_extent(counts.vertices, options.position_stride, options.position_component_stride);
}

void check_buffers(const Buffers& buffers, const Options& options, const CallerCounts& counts, cl_context context) {
    const auto check = [&](const BufferView& view, std::size_t floats, Access access, const char* name) {
        check_view(view, floats, access, context, name);
    };
    check(buffers.positions, position_floats(options, counts),
          options.positions_only || options.integrates ? Access::read_and_write : Access::read, "buffers.positions");
    if (!options.positions_only) {
        check(buffers.velocities,
              vector_extent(counts.vertices, options.velocity_stride, options.velocity_component_stride),
              Access::read_and_write, "buffers.velocities");
        check_velocities_apart(buffers, options, counts.vertices);
    } else if (buffers.velocities.buffer) {
        invalid("buffers.velocities is given, but Options::positions_only is on");
    }
    check(buffers.inverse_masses, (counts.vertices - 1) * options.inverse_mass_stride + 1, Access::read,
          "buffers.inverse_masses");
    check(buffers.rest_areas, counts.triangles, Access::read, "buffers.rest_areas");
    const auto check_optional = [&](bool on, const BufferView& view, std::size_t floats, const char* name,
                                    const char* option) {
        const std::string full_name = std::string("buffers.") + name;
        if (on)
            check(view, floats, Access::read, full_name.c_str());
        else if (view.buffer)
            invalid(full_name + " is given, but Options::" + option + " is off");
    };
    check_optional(options.regularization_per_triangle, buffers.regularization, counts.triangles, "regularization",
                   "regularization_per_triangle");
    check_optional(options.limits_stretch, buffers.rest_shapes, 4 * counts.triangles, "rest_shapes", "limits_stretch");
    // A mesh without hinges needs no buffer.
    if (!options.bends || counts.hinges > 0)
        check_optional(options.bends, buffers.rest_hinges, 2 * counts.hinges, "rest_hinges", "bends");
    check_optional(options.stretch_ceiling_per_triangle, buffers.stretch_ceilings, counts.triangles, "stretch_ceilings",
                   "stretch_ceiling_per_triangle");
    check_optional(options.keeps_contacts, buffers.contacts, APSLK_CONTACT_SIZE * counts.vertices, "contacts",
                   "keeps_contacts");
    check_optional(options.acceleration_per_vertex, buffers.accelerations, position_floats(options, counts),
                   "accelerations", "acceleration_per_vertex");
    const std::size_t tethers = std::size_t{options.tethers_per_vertex} * counts.vertices;
    check_optional(tethers > 0, buffers.tether_anchors, tethers, "tether_anchors", "tethers_per_vertex");
    check_optional(tethers > 0, buffers.tether_lengths, tethers, "tether_lengths", "tethers_per_vertex");
}

const BufferView& corrected(const Buffers& buffers) {
    return buffers.velocities.buffer ? buffers.velocities : buffers.positions;
}

const BufferView& or_any(const BufferView& optional, const Buffers& buffers) {
    return optional.buffer ? optional : buffers.rest_areas;
}

}  // namespace apsl::host

// SPDX-License-Identifier: MIT
#include "caller_buffers.hpp"

#include "caller_objects.hpp"
#include "invalid.hpp"
#include "kernels/constants.h"

#include <string>

namespace apsl::host {
namespace {

FloatsInUse positions_in_use(const char* name, const BufferView& view, const Options& options,
                             const CallerCounts& counts, bool written) {
    return {name, view, written, counts.vertices, options.position_stride, 3, options.position_component_stride};
}

}  // namespace

void check_buffers(const Buffers& buffers, const Options& options, const CallerCounts& counts, cl_context context,
                   const std::optional<FloatsInUse>& scratch) {
    MemoryInUse in_use;
    if (scratch) in_use.add(*scratch);
    const auto use = [&](const FloatsInUse& floats) {
        check_view(floats.view, floats.extent(), floats.written ? Access::read_and_write : Access::read, context,
                   floats.name);
        in_use.add(floats);
    };
    use(positions_in_use("buffers.positions", buffers.positions, options, counts,
                         options.positions_only || options.integrates));
    if (!options.positions_only)
        use({"buffers.velocities", buffers.velocities, true, counts.vertices, options.velocity_stride, 3,
             options.velocity_component_stride});
    else if (buffers.velocities.buffer)
        invalid("buffers.velocities is given, but Options::positions_only is on");
    use({"buffers.inverse_masses", buffers.inverse_masses, false, counts.vertices, options.inverse_mass_stride});
    use({"buffers.rest_areas", buffers.rest_areas, false, counts.triangles});
    const auto use_optional = [&](bool on, const FloatsInUse& floats, const char* option) {
        if (on)
            use(floats);
        else if (floats.view.buffer)
            invalid(std::string(floats.name) + " is given, but Options::" + option + " is off");
    };
    use_optional(options.regularization_per_triangle,
                 {"buffers.regularization", buffers.regularization, false, counts.triangles},
                 "regularization_per_triangle");
    use_optional(options.limits_stretch, {"buffers.rest_shapes", buffers.rest_shapes, false, 4 * counts.triangles},
                 "limits_stretch");
    // A mesh without hinges needs no buffer.
    if (!options.bends || counts.hinges > 0)
        use_optional(options.bends, {"buffers.rest_hinges", buffers.rest_hinges, false, 2 * counts.hinges}, "bends");
    use_optional(options.stretch_ceiling_per_triangle,
                 {"buffers.stretch_ceilings", buffers.stretch_ceilings, false, counts.triangles},
                 "stretch_ceiling_per_triangle");
    use_optional(options.keeps_contacts,
                 {"buffers.contacts", buffers.contacts, false, APSLK_CONTACT_SIZE * counts.vertices}, "keeps_contacts");
    use_optional(options.acceleration_per_vertex,
                 positions_in_use("buffers.accelerations", buffers.accelerations, options, counts, false),
                 "acceleration_per_vertex");
    const std::size_t tethers = std::size_t{options.tethers_per_vertex} * counts.vertices;
    use_optional(tethers > 0, {"buffers.tether_anchors", buffers.tether_anchors, false, tethers}, "tethers_per_vertex");
    use_optional(tethers > 0, {"buffers.tether_lengths", buffers.tether_lengths, false, tethers}, "tethers_per_vertex");
}

void check_rest_buffers(const BufferView& rest_positions, const FloatsInUse& target, const Options& options,
                        const CallerCounts& counts, cl_context context, const std::optional<FloatsInUse>& scratch) {
    const FloatsInUse positions = positions_in_use("rest_positions", rest_positions, options, counts, false);
    check_view(positions.view, positions.extent(), Access::read, context, positions.name);
    check_view(target.view, target.extent(), Access::write, context, target.name);
    MemoryInUse in_use;
    if (scratch) in_use.add(*scratch);
    in_use.add(positions);
    in_use.add(target);
}

const BufferView& corrected(const Buffers& buffers) {
    return buffers.velocities.buffer ? buffers.velocities : buffers.positions;
}

const BufferView& or_any(const BufferView& optional, const Buffers& buffers) {
    return optional.buffer ? optional : buffers.rest_areas;
}

}  // namespace apsl::host

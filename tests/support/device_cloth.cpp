// SPDX-License-Identifier: MIT
#include "support/device_cloth.hpp"

#include <apsl/reference.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

namespace apsl::test {
namespace {

/// Floats from one element to the next, and from one of its components to the next.
struct Layout {
    std::size_t width, stride, component_stride = 1;

    std::size_t place(std::size_t element, std::size_t component) const {
        return element * stride + component * component_stride;
    }
};

Layout layout_of_positions(const Options& options) {
    return {3, options.position_stride, options.position_component_stride};
}

Layout layout_of_velocities(const Options& options) {
    return {3, options.velocity_stride, options.velocity_component_stride};
}

/// A caller's buffer, which may end with its last number; poison in between.
std::vector<float> placed(std::span<const MovingCloth> cloths, std::vector<double> MovingCloth::* numbers,
                          const Layout& layout, std::size_t offset) {
    std::vector<double> joined;
    for (const MovingCloth& cloth : cloths)
        joined.insert(joined.end(), (cloth.*numbers).begin(), (cloth.*numbers).end());
    const std::size_t count = joined.size() / layout.width;
    if (count == 0) return poison<float>(offset + 1);
    std::vector<float> all = poison<float>(offset + layout.place(count - 1, layout.width - 1) + 1);
    for (std::size_t n = 0; n < joined.size(); ++n)
        all[offset + layout.place(n / layout.width, n % layout.width)] = static_cast<float>(joined[n]);
    return all;
}

std::size_t vertices_of(std::span<const MovingCloth> cloths) {
    std::size_t count = 0;
    for (const MovingCloth& cloth : cloths) count += cloth.topology->vertex_count();
    return count;
}

void round_to_float(std::vector<double>& numbers) {
    for (double& number : numbers) number = static_cast<float>(number);
}

}  // namespace

MovingCloth moving_cloth(const Mesh& mesh, std::uint32_t seed) {
    MovingCloth cloth;
    cloth.topology = Topology::build(mesh.triangles, mesh.vertex_count());
    cloth.rest_areas = reference::areas<double>(*cloth.topology, mesh.positions);
    const double total = std::accumulate(cloth.rest_areas.begin(), cloth.rest_areas.end(), 0.0);
    const double edge = std::sqrt(total / static_cast<double>(cloth.rest_areas.size()));
    cloth.positions = wavy(mesh.positions, 0.2 * edge, seed);
    round_to_float(cloth.rest_areas);
    round_to_float(cloth.positions);

    std::mt19937 random(seed);
    const auto number = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
    };
    constexpr double steps_per_second = 60.0;
    for (std::size_t n = 0; n < cloth.positions.size(); ++n)
        cloth.velocities.push_back(steps_per_second *
                                   (0.1 * (n % 3 == 0 ? mesh.positions[n] : 0.0) + 0.03 * edge * number(-1.0, 1.0)));
    cloth.inverse_masses = reference::inverse_masses<double>(*cloth.topology, cloth.rest_areas, 0.2);
    for (double& inverse_mass : cloth.inverse_masses) inverse_mass *= number(0.5, 2.0);
    for (const std::size_t pin : {std::size_t{0}, mesh.vertex_count() / 2}) cloth.inverse_masses[pin] = 0.0;
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a) cloth.regularization.push_back(number(1.05, 2.0));
    round_to_float(cloth.velocities);
    round_to_float(cloth.inverse_masses);
    round_to_float(cloth.regularization);
    cloth.rest_shapes = reference::rest_shapes<double>(*cloth.topology, mesh.positions);
    round_to_float(cloth.rest_shapes);
    cloth.rest_hinges = reference::rest_hinges<double>(*cloth.topology, mesh.positions);
    round_to_float(cloth.rest_hinges);
    for (std::size_t a = 0; a < cloth.rest_areas.size(); ++a)
        cloth.stretch_ceilings.push_back(a % 9 == 4 ? 0.0 : number(1.02, 1.2));
    round_to_float(cloth.stretch_ceilings);
    for (std::size_t v = 0; v < cloth.inverse_masses.size(); ++v) {
        std::array<double, 3> normal{number(-1.0, 1.0), number(-1.0, 1.0), number(0.2, 1.0)};
        const double length =
            v % 5 == 2 ? std::numeric_limits<double>::infinity() : std::hypot(normal[0], normal[1], normal[2]);
        double offset = edge * number(-0.3, 0.3);
        for (std::size_t k = 0; k < 3; ++k) {
            normal[k] /= length;
            offset += normal[k] * (cloth.positions[3 * v + k] + cloth.velocities[3 * v + k] / steps_per_second);
        }
        cloth.contacts.insert(cloth.contacts.end(), {normal[0], normal[1], normal[2], offset, number(-1.0, 1.0),
                                                     number(-1.0, 1.0), number(-1.0, 1.0), number(0.0, 1.0)});
    }
    round_to_float(cloth.contacts);
    for (std::size_t n = 0; n < cloth.positions.size(); ++n) cloth.accelerations.push_back(number(-20.0, 20.0));
    round_to_float(cloth.accelerations);
    for (std::size_t t = 0; t < MovingCloth::tethers * cloth.inverse_masses.size(); ++t) {
        const std::size_t v = t / MovingCloth::tethers, pin = t % MovingCloth::tethers * (mesh.vertex_count() / 2);
        double squared = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto end = [&](std::size_t n) { return cloth.positions[n] + cloth.velocities[n] / steps_per_second; };
            squared += std::pow(end(3 * v + k) - end(3 * pin + k), 2);
        }
        cloth.tether_anchors.push_back(t % 7 == 3 ? std::numeric_limits<std::uint32_t>::max()
                                                  : static_cast<std::uint32_t>(pin));
        cloth.tether_lengths.push_back(t % 5 == 2 ? 0.0 : std::sqrt(squared) * number(0.85, 1.1));
    }
    round_to_float(cloth.tether_lengths);
    return cloth;
}

Options with_layout(Options options, const Options& layout) {
    options.position_stride = layout.position_stride;
    options.velocity_stride = layout.velocity_stride;
    options.position_component_stride = layout.position_component_stride;
    options.velocity_component_stride = layout.velocity_component_stride;
    options.inverse_mass_stride = layout.inverse_mass_stride;
    return options;
}

namespace {

// Numbered as the vertices of all cloths follow one another.
std::vector<std::uint32_t> anchors_of(std::span<const MovingCloth> cloths, std::size_t offset) {
    std::vector<std::uint32_t> anchors = poison<std::uint32_t>(offset);
    std::uint32_t before = 0;
    for (const MovingCloth& cloth : cloths) {
        const auto count = static_cast<std::uint32_t>(cloth.inverse_masses.size());
        for (const std::uint32_t anchor : cloth.tether_anchors)
            anchors.push_back(anchor < count ? before + anchor : anchor);
        before += count;
    }
    return anchors;
}

}  // namespace

CallerBuffers::CallerBuffers(std::span<const MovingCloth> cloths, const Options& the_options, std::size_t the_offset)
    : options(the_options),
      offset(the_offset),
      vertex_count(vertices_of(cloths)),
      positions(placed(cloths, &MovingCloth::positions, layout_of_positions(options), offset)),
      velocities(placed(cloths, &MovingCloth::velocities, layout_of_velocities(options), offset)),
      inverse_masses(placed(cloths, &MovingCloth::inverse_masses, {1, options.inverse_mass_stride}, offset)),
      rest_areas(placed(cloths, &MovingCloth::rest_areas, {1, 1}, offset)),
      regularization(placed(cloths, &MovingCloth::regularization, {1, 1}, offset)),
      rest_shapes(placed(cloths, &MovingCloth::rest_shapes, {4, 4}, offset)),
      stretch_ceilings(placed(cloths, &MovingCloth::stretch_ceilings, {1, 1}, offset)),
      contacts(placed(cloths, &MovingCloth::contacts, {8, 8}, offset)),
      rest_hinges(placed(cloths, &MovingCloth::rest_hinges, {2, 2}, offset)),
      accelerations(placed(cloths, &MovingCloth::accelerations, layout_of_positions(options), offset)),
      tether_lengths(
          placed(cloths, &MovingCloth::tether_lengths, {MovingCloth::tethers, MovingCloth::tethers}, offset)),
      tether_anchors(anchors_of(cloths, offset)) {
}

Buffers CallerBuffers::views() const {
    const std::size_t bytes = offset * sizeof(float);
    Buffers views{.positions = {positions.get(), bytes},
                  .velocities = {velocities.get(), bytes},
                  .inverse_masses = {inverse_masses.get(), bytes},
                  .rest_areas = {rest_areas.get(), bytes},
                  .regularization = {}};
    if (options.regularization_per_triangle) views.regularization = {regularization.get(), bytes};
    if (options.limits_stretch) views.rest_shapes = {rest_shapes.get(), bytes};
    if (options.stretch_ceiling_per_triangle) views.stretch_ceilings = {stretch_ceilings.get(), bytes};
    if (options.keeps_contacts) views.contacts = {contacts.get(), bytes};
    if (options.bends) views.rest_hinges = {rest_hinges.get(), bytes};
    if (options.acceleration_per_vertex) views.accelerations = {accelerations.get(), bytes};
    if (options.tethers_per_vertex > 0) {
        views.tether_anchors = {tether_anchors.get(), bytes};
        views.tether_lengths = {tether_lengths.get(), bytes};
    }
    return views;
}

namespace {

// [3V], without the gaps, which nothing may have written to.
std::vector<float> without_gaps(const std::vector<float>& all, const Layout& layout, std::size_t offset,
                                std::size_t vertex_count, const char* name) {
    std::vector<float> numbers, gaps = all;
    for (std::size_t n = 0; n < 3 * vertex_count; ++n) {
        const std::size_t place = offset + layout.place(n / 3, n % 3);
        numbers.push_back(all[place]);
        gaps[place] = poison<float>(1)[0];
    }
    if (!same_bytes(gaps, poison<float>(gaps.size())))
        throw std::runtime_error(std::string("a float between the ") + name + " of two vertices was written");
    return numbers;
}

}  // namespace

std::vector<float> CallerBuffers::read_velocities() const {
    for (const auto* array : {&positions, &inverse_masses, &rest_areas, &regularization, &rest_shapes,
                              &stretch_ceilings, &contacts, &rest_hinges, &accelerations, &tether_lengths})
        array->read();
    tether_anchors.read();
    return without_gaps(velocities.read(), layout_of_velocities(options), offset, vertex_count, "velocities");
}

std::vector<float> CallerBuffers::read_positions() const {
    return without_gaps(positions.read(), layout_of_positions(options), offset, vertex_count, "positions");
}

std::vector<Stats> filter(StrainLimiter& limiter, const CallerBuffers& buffers,
                          std::span<const Parameters> parameters) {
    const Owned<cl_command_queue> queue = in_order_queue();
    const cl_event limited = limiter.enqueue(queue.get(), buffers.views(), parameters);
    std::vector<Stats> stats(limiter.cloth_count());
    const cl_event read = limiter.read_stats(queue.get(), stats, {&limited, 1});
    require_success(wait_and_release(read), "reading the statistics");
    require_success(wait_and_release(limited), "the filter");
    return stats;
}

}  // namespace apsl::test

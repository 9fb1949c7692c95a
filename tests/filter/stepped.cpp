// SPDX-License-Identifier: MIT
#include "filter/stepped.hpp"

#include "support/tolerances.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <catch2/catch.hpp>
#include <tuple>

namespace apsl::test {

Ended step_on_device(StrainLimiter& limiter, const MovingCloth& cloth, const Options& options,
                     const Parameters& parameters) {
    const CallerBuffers buffers({&cloth, 1}, options);
    const Stats stats = filter(limiter, buffers, {&parameters, 1})[0];
    const std::vector<float> velocities = buffers.read_velocities(), positions = buffers.read_positions();
    return {{positions.begin(), positions.end()}, {velocities.begin(), velocities.end()}, stats};
}

Ended step_on_device(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    StrainLimiter limiter(device().context, device().id, cloth.topology, options);
    return step_on_device(limiter, cloth, options, parameters);
}

Ended step_with_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    reference::StrainLimiter limiter(cloth.topology, options);
    Ended end{cloth.positions, cloth.velocities, {}};
    std::span<const double> shapes, contacts, hinges, accelerations, lengths;
    std::span<const std::uint32_t> anchors;
    if (options.tethers_per_vertex > 0) {
        anchors = cloth.tether_anchors;
        lengths = cloth.tether_lengths;
    }
    if (options.limits_stretch) shapes = cloth.rest_shapes;
    if (options.keeps_contacts) contacts = cloth.contacts;
    if (options.bends) hinges = cloth.rest_hinges;
    if (options.acceleration_per_vertex) accelerations = cloth.accelerations;
    limiter.enqueue({.positions = cloth.positions,
                     .velocities = end.velocities,
                     .inverse_masses = cloth.inverse_masses,
                     .rest_areas = cloth.rest_areas,
                     .regularization = {},
                     .rest_shapes = shapes,
                     .contacts = contacts,
                     .end_positions = end.positions,
                     .rest_hinges = hinges,
                     .accelerations = accelerations,
                     .tether_anchors = anchors,
                     .tether_lengths = lengths},
                    parameters);
    end.stats = limiter.read_stats();
    return end;
}

std::vector<Options> strided_and_apart(const Options& options) {
    Options strided = options;
    strided.position_stride = 4;
    strided.velocity_stride = 7;
    Options apart = options;
    apart.position_stride = apart.velocity_stride = 1;
    apart.position_component_stride = apart.velocity_component_stride = 64;
    return {strided, apart};
}

void check_step_in_every_layout(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    const Ended want = step_on_device(cloth, options, parameters);
    std::vector<Options> layouts = strided_and_apart(options);
    layouts.push_back(options);
    for (const Options& layout : layouts) {
        StrainLimiter limiter(device().context, device().id, cloth.topology, layout);
        const CallerBuffers buffers({&cloth, 1}, layout, 5);
        const auto inputs = [&] {
            return std::tuple(buffers.accelerations.read(), buffers.tether_lengths.read(),
                              buffers.tether_anchors.read());
        };
        const auto [accelerations, lengths, anchors] = inputs();
        filter(limiter, buffers, {&parameters, 1});
        const std::vector<float> velocities = buffers.read_velocities(), positions = buffers.read_positions();
        CHECK(std::equal(positions.begin(), positions.end(), want.positions.begin()));
        CHECK(std::equal(velocities.begin(), velocities.end(), want.velocities.begin()));
        const auto [accelerations_after, lengths_after, anchors_after] = inputs();
        CHECK(same_bytes(accelerations, accelerations_after));
        CHECK(same_bytes(lengths, lengths_after));
        CHECK(same_bytes(anchors, anchors_after));
    }
}

void check_step_as_alone(const std::vector<MovingCloth>& cloths, const Options& options, const Parameters& parameters) {
    StrainLimiter limiter(device().context, device().id, topologies_of(cloths), options);
    const CallerBuffers buffers(cloths, options);
    filter(limiter, buffers, {&parameters, 1});
    const std::vector<float> positions = buffers.read_positions();
    std::size_t first = 0;
    for (const MovingCloth& cloth : cloths) {
        const Ended alone = step_on_device(cloth, options, parameters);
        const std::vector<double> got(positions.begin() + static_cast<std::ptrdiff_t>(first),
                                      positions.begin() + static_cast<std::ptrdiff_t>(first + alone.positions.size()));
        CHECK(difference(got, alone.positions) <= elementwise_tolerance(20.0) * norm(alone.positions));
        first += alone.positions.size();
    }
}

BothEnds check_step_against_reference(const MovingCloth& cloth, const Options& options, const Parameters& parameters) {
    const Ended got = step_on_device(cloth, options, parameters),
                want = step_with_reference(cloth, options, parameters);
    CHECK(got.stats.status == want.stats.status);
    CHECK(got.stats.sub_steps == want.stats.sub_steps);
    std::vector<double> moved(want.positions.size());
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] = want.positions[n] - cloth.positions[n];
    CHECK(difference(got.positions, want.positions) <=
          0.03 * norm(moved) + elementwise_tolerance(200.0) * norm(want.positions));
    CHECK(difference(got.velocities, want.velocities) <=
          0.05 * norm(want.velocities) +
              elementwise_tolerance(200.0) * norm(want.positions) / static_cast<double>(parameters.time_step));
    return {got, want};
}

}  // namespace apsl::test

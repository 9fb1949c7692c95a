// SPDX-License-Identifier: MIT
#pragma once

#include "support/meshes.hpp"
#include "support/opencl.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace apsl::test {

/// A cloth in the middle of a step, as a caller has it. Every number is a 32-bit float, held in double: the reference
/// and the device are given the same.
struct MovingCloth {
    std::shared_ptr<const Topology> topology;
    std::vector<double> positions;         ///< m, [3V]
    std::vector<double> velocities;        ///< m/s, [3V]
    std::vector<double> inverse_masses;    ///< 1/kg, [V]
    std::vector<double> rest_areas;        ///< m², [T]
    std::vector<double> regularization;    ///< α, [T]
    std::vector<double> rest_shapes;       ///< 1/m, [4T]
    std::vector<double> rest_hinges;       ///< rad and m²/m², [2H]
    std::vector<double> stretch_ceilings;  ///< [T], from 1.02 to 1.2, every ninth 0
    /// [8V], Buffers::contacts: planes that about half of the vertices end a step behind, a third of an edge deep at
    /// most, every fifth vertex without one.
    std::vector<double> contacts;
    std::vector<double> accelerations;  ///< m/s², [3V], up to 20 either way
    /// `tethers` of each vertex, [2V], to its pins: about as long as they are apart at the end of the step, every fifth
    /// of length 0, every seventh with an anchor that is no vertex.
    std::vector<std::uint32_t> tether_anchors;
    std::vector<double> tether_lengths;  ///< m

    static constexpr std::uint32_t tethers = 2;
};

/// The mesh at rest where it lies, wavy now and about to be stretched by some 15 %: unequal masses, two pins.
MovingCloth moving_cloth(const Mesh& mesh, std::uint32_t seed);

/// The options with the strides of `layout`.
Options with_layout(Options options, const Options& layout);

/// The caller's buffers of one or more cloths, guarded, and the filter run on them.
struct CallerBuffers {
    /// `offset`: floats before the first element of every buffer. Layouts and per-triangle α from the options.
    CallerBuffers(std::span<const MovingCloth> cloths, const Options& options, std::size_t offset = 0);

    Options options;
    std::size_t offset;
    std::size_t vertex_count;
    DeviceArray<float> positions, velocities, inverse_masses, rest_areas, regularization, rest_shapes, stretch_ceilings,
        contacts, rest_hinges, accelerations, tether_lengths;
    DeviceArray<std::uint32_t> tether_anchors;

    Buffers views() const;
    /// [3V] of all cloths, without stride and offset. Checks the guard bands of every buffer.
    std::vector<float> read_velocities() const;
    /// Likewise.
    std::vector<float> read_positions() const;
};

/// Queues one call on an in-order queue, waits, and returns the statistics, one entry a cloth.
std::vector<Stats> filter(StrainLimiter& limiter, const CallerBuffers& buffers, std::span<const Parameters> parameters);

}  // namespace apsl::test

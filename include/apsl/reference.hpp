// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/options.hpp>
#include <apsl/stats.hpp>
#include <apsl/topology.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace apsl::reference {

/// What the filter reads and writes, in the caller's memory.
template <class Real>
struct Buffers {
    std::span<const Real> positions;         ///< m, [3V], x̃: the start of the step, not the predicted end
    std::span<Real> velocities;              ///< m/s, [3V], ṽ in and out
    std::span<const Real> inverse_masses;    ///< 1/kg, [V], 0 pins a vertex
    std::span<const Real> rest_areas;        ///< m², [T], > 0
    std::span<const Real> regularization;    ///< α ≥ 1, [T], or empty: Parameters::regularization for all
    std::span<const Real> rest_shapes = {};  ///< 1/m, [4T], with Options::limits_stretch; as apsl::Buffers has them
    std::span<const Real> stretch_ceilings = {};  ///< [T], 0 or ≥ 1.01, or empty: Parameters::stretch_ceiling for all
    std::span<const Real> contacts = {};          ///< [8V], with Options::keeps_contacts; as apsl::Buffers has them
    /// m, [3V], out: the end of the step, with Options::integrates. May be the memory of `positions`.
    std::span<Real> end_positions = {};
    std::span<const Real> rest_hinges = {};  ///< [2H], with Options::bends; as apsl::Buffers has them
    /// m/s², [3V], with Options::acceleration_per_vertex; as apsl::Buffers has them
    std::span<const Real> accelerations = {};
    std::span<const std::uint32_t> tether_anchors =
        {};                                     ///< with Options::tethers_per_vertex; as apsl::Buffers has them
    std::span<const Real> tether_lengths = {};  ///< m ≥ 0, likewise
};

/// The filter of Algorithm 1 on the CPU, one thread, plain code: what device results are checked against.
/// Same verbs as apsl::StrainLimiter; here everything has happened when enqueue returns.
/// Instantiated for double (the reference) and float (the baseline of the benchmarks).
template <class Real>
class BasicStrainLimiter {
public:
    /// Of the options `matrix`, `solver`, `warm_start_sub_steps`, `bound_interval`, `limits_stretch`, `integrates`,
    /// `keeps_contacts`, `bends`, `acceleration_per_vertex` and `tethers_per_vertex` count here; the others say how a
    /// device is used. α is one for each triangle where the buffers have one. Throws Error(invalid_argument) as
    /// validate() does.
    explicit BasicStrainLimiter(std::shared_ptr<const Topology> topology, const Options& options = {});
    ~BasicStrainLimiter();
    BasicStrainLimiter(BasicStrainLimiter&&) noexcept;  ///< what was moved from may only be assigned to or destroyed
    BasicStrainLimiter& operator=(BasicStrainLimiter&&) noexcept;  ///< likewise

    /// Bytes held between calls.
    std::size_t scratch_bytes() const;
    /// Filters the velocities. Throws Error(invalid_argument) for sizes that do not fit the topology, parameters out
    /// of range, α < 1, negative or non-finite inverse masses, rest areas that are not positive.
    /// Positions or velocities that are not finite are a status (diverged): velocities are left as they were.
    void enqueue(const Buffers<Real>& buffers, const Parameters& parameters);
    /// Of the last call.
    Stats read_stats() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

/// The reference itself, in double precision.
using StrainLimiter = BasicStrainLimiter<double>;

extern template class BasicStrainLimiter<double>;
extern template class BasicStrainLimiter<float>;

/// Rest areas of the triangles at the given positions: m², [T] from [3V]. Zero for a degenerate triangle.
template <class Real>
std::vector<Real> areas(const Topology& topology, std::span<const Real> positions);

/// Buffers::rest_shapes of the triangles at the given positions: 1/m, [4T] from [3V]. Zeros for a degenerate triangle.
template <class Real>
std::vector<Real> rest_shapes(const Topology& topology, std::span<const Real> positions);

/// Buffers::rest_hinges at the given positions: [2H] from [3V]. Zeros where a triangle of the hinge has no area.
template <class Real>
std::vector<Real> rest_hinges(const Topology& topology, std::span<const Real> positions);

/// Lumped inverse masses: each vertex carries a third of its triangles' rest area times density (kg/m²). 0 for isolated
/// vertices. 1/kg, [V].
template <class Real>
std::vector<Real> inverse_masses(const Topology& topology, std::span<const Real> rest_areas, Real density);

}  // namespace apsl::reference

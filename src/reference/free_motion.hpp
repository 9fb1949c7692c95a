// SPDX-License-Identifier: MIT
#pragma once

#include "resolved_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

// What acceleration and damping make of velocities where a call is a whole time step (docs/formulation.md, A whole
// step). A pinned vertex keeps its velocity; without Options::integrates every vertex does. `accelerations`:
// Buffers::accelerations, [3V], or empty.
namespace apsl::reference {

/// Of one small step: u ← kept (u + gain).
template <class Real>
struct FreePart {
    std::array<Real, 3> acceleration;  ///< m/s², of all vertices
    std::span<const Real> accelerations;
    Real duration;  ///< s
    Real kept;

    FreePart(const ResolvedParameters& parameters, std::span<const Real> vertex_accelerations)
        : accelerations(vertex_accelerations),
          duration(static_cast<Real>(parameters.time_step) / static_cast<Real>(std::max(parameters.small_steps, 1))),
          kept(std::exp(-static_cast<Real>(parameters.damping) * duration)) {
        for (std::size_t k = 0; k < 3; ++k) acceleration[k] = static_cast<Real>(parameters.acceleration[k]);
    }

    /// m/s, of component n of the velocities of all vertices.
    Real gain(std::size_t n) const {
        return duration * (acceleration[n % 3] + (accelerations.empty() ? Real(0) : accelerations[n]));
    }
    /// Component n of the velocities of all vertices.
    Real operator()(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? kept * (velocity + gain(n)) : velocity;
    }
    /// The velocity that becomes this one.
    Real before(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? velocity / kept - gain(n) : velocity;
    }
};

/// Of all small steps of a time step, with nothing else to move the cloth.
template <class Real>
struct FreeStep {
    FreePart<Real> part;
    Real gains = Real(0), mean_gains = Real(0);  ///< of a part's gain
    Real kept = Real(1), mean_kept = Real(0);

    FreeStep(const ResolvedParameters& parameters, std::span<const Real> accelerations)
        : part(parameters, accelerations) {
        const int parts = std::max(parameters.small_steps, 1);
        for (int k = 0; k < parts; ++k) {
            kept *= part.kept;
            gains = part.kept * (gains + Real(1));
            mean_kept += kept / static_cast<Real>(parts);
            mean_gains += gains / static_cast<Real>(parts);
        }
    }

    /// m/s, what acceleration adds to component n of the velocities of all vertices.
    Real gain(std::size_t n) const { return gains * part.gain(n); }
    /// Velocity at the end.
    Real end(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? kept * velocity + gain(n) : velocity;
    }
    /// Displacement over the time step.
    Real mean(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? mean_kept * velocity + mean_gains * part.gain(n) : velocity;
    }
};

}  // namespace apsl::reference

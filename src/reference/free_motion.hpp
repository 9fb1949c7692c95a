// SPDX-License-Identifier: MIT
#pragma once

#include "resolved_parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

// What acceleration and damping make of velocities where a call is a whole time step (docs/formulation.md, A whole
// step). A pinned vertex keeps its velocity; without Options::integrates every vertex does.
namespace apsl::reference {

/// Of one small step: u ← kept (u + gain).
template <class Real>
struct FreePart {
    std::array<Real, 3> gain;  ///< m/s
    Real kept;

    explicit FreePart(const ResolvedParameters& parameters) {
        const Real duration =
            static_cast<Real>(parameters.time_step) / static_cast<Real>(std::max(parameters.small_steps, 1));
        kept = std::exp(-static_cast<Real>(parameters.damping) * duration);
        for (std::size_t k = 0; k < 3; ++k) gain[k] = duration * static_cast<Real>(parameters.acceleration[k]);
    }

    /// Component n of the velocities of all vertices.
    Real operator()(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? kept * (velocity + gain[n % 3]) : velocity;
    }
};

/// Of all small steps of a time step, with nothing else to move the cloth.
template <class Real>
struct FreeStep {
    std::array<Real, 3> gain, mean_gain;  ///< m/s
    Real kept = Real(1), mean_kept = Real(0);

    explicit FreeStep(const ResolvedParameters& parameters) {
        const FreePart<Real> part(parameters);
        const int parts = std::max(parameters.small_steps, 1);
        Real gains = Real(0), mean_gains = Real(0);
        for (int k = 0; k < parts; ++k) {
            kept *= part.kept;
            gains = part.kept * (gains + Real(1));
            mean_kept += kept / static_cast<Real>(parts);
            mean_gains += gains / static_cast<Real>(parts);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            gain[k] = gains * part.gain[k];
            mean_gain[k] = mean_gains * part.gain[k];
        }
    }

    /// Velocity at the end.
    Real end(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? kept * velocity + gain[n % 3] : velocity;
    }
    /// Displacement over the time step.
    Real mean(Real velocity, std::size_t n, std::span<const Real> inverse_masses) const {
        return inverse_masses[n / 3] > Real(0) ? mean_kept * velocity + mean_gain[n % 3] : velocity;
    }
};

}  // namespace apsl::reference

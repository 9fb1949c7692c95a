// SPDX-License-Identifier: MIT
#pragma once

#include "kernels/arrays.hpp"

#include <cmath>
#include <cstddef>

namespace apsl::test {

/// Acceleration and damping in small steps.
inline constexpr Parameters falling{
    .sub_steps = 5, .acceleration = {1.0f, -9.81f, 0.5f}, .damping = 0.7f, .stepping = Stepping::small_steps};
inline constexpr int parts = 4;

/// Of number n of a cloth's vectors: its velocity after `parts_taken` parts with nothing but acceleration and damping,
/// and how far it has moved. `own`: with the vertex' own acceleration.
struct FreeNumber {
    double velocity, moved = 0.0;

    FreeNumber(const Cloth& cloth, std::size_t n, int parts_taken, bool own) : velocity(cloth.velocities[n]) {
        const double duration = static_cast<double>(falling.time_step) / parts;
        const double kept = std::exp(-static_cast<double>(falling.damping) * duration);
        const double acceleration =
            static_cast<double>(falling.acceleration[n % 3]) + (own ? cloth.accelerations[n] : 0.0);
        for (int part = 0; part < parts_taken; ++part) {
            if (cloth.inverse_masses[n / 3] > 0.0) velocity = kept * (velocity + duration * acceleration);
            moved += duration * velocity;
        }
    }
};

}  // namespace apsl::test

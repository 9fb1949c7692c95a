// SPDX-License-Identifier: MIT
#include "pipeline/implicit_springs.hpp"

#include "pipeline/geometry.hpp"
#include "pipeline/spring_operator.hpp"

#include <apsl/error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace apsl::scenes {

namespace {

void check_springs(const ClothState& cloth, const std::vector<Spring>& springs) {
    for (std::size_t i = 0; i < springs.size(); ++i) {
        const Spring& spring = springs[i];
        const std::string name = "implicit springs: spring " + std::to_string(i) + " ";
        if (spring.a >= cloth.masses.size() || spring.b >= cloth.masses.size()) {
            throw Error(ErrorCode::invalid_argument, name + "names a vertex out of range, the mesh has " +
                                                         std::to_string(cloth.masses.size()) + " vertices");
        }
        if (spring.a == spring.b)
            throw Error(ErrorCode::invalid_argument, name + "names vertex " + std::to_string(spring.a) + " twice");
        if (!(spring.rest_length >= 0.0) || !std::isfinite(spring.rest_length))
            throw Error(ErrorCode::invalid_argument, name + "has a rest length that is negative or not finite");
        if (!(spring.stiffness >= 0.0) || !std::isfinite(spring.stiffness))
            throw Error(ErrorCode::invalid_argument, name + "has a stiffness that is negative or not finite");
    }
}

bool all_finite(std::span<const double> values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

double dot(std::span<const double> a, std::span<const double> b) {
    // Three sums side by side: one would wait for itself at every addition. The order is fixed, so results repeat.
    double sums[3] = {0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < a.size(); i += 3) {
        sums[0] += a[i] * b[i];
        sums[1] += a[i + 1] * b[i + 1];
        sums[2] += a[i + 2] * b[i + 2];
    }
    return sums[0] + sums[1] + sums[2];
}

}  // namespace

// ‖r‖ ≤ 1e-3 ‖b‖ in the preconditioner's norm, where b is mostly one step of gravity: each step changes velocities to
// about 1e-3 of that, far below what the filter behind it corrects. Measured on the 65×65 curtain: 1e-2 takes 41
// iterations a step, 1e-3 69, 1e-4 97, 1e-8 204; greatest area changes with the filter on are alike from 1e-2 down.
constexpr double relative_tolerance = 1e-3;
constexpr int max_iterations = 2000;

struct ImplicitSprings::Implementation {
    SpringOperator system;
    double damping;
    std::vector<double> velocity_change, residual, direction, image, preconditioned;  // [3V]

    Implementation(const ClothState& cloth, std::vector<Spring> springs, double damping_per_second)
        : system(cloth, std::move(springs)),
          damping(damping_per_second),
          velocity_change(cloth.velocities.size()),
          residual(cloth.velocities.size()),
          direction(cloth.velocities.size()),
          image(cloth.velocities.size()),
          preconditioned(cloth.velocities.size()) {}

    // h (f + h K v − d M v), zero at pinned vertices. The system must have been linearised at the same positions.
    void set_right_hand_side(const ClothState& cloth, const std::array<double, 3>& gravity, double time_step) {
        system.spring_forces(cloth, residual);
        for (std::size_t vertex = 0; vertex < cloth.masses.size(); ++vertex) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const std::size_t i = 3 * vertex + axis;
                residual[i] =
                    time_step * (residual[i] + cloth.masses[vertex] * (gravity[axis] - damping * cloth.velocities[i]));
            }
        }
        system.add_stiffness(cloth.velocities, residual);
        system.clear_pinned(residual);
    }

    // Preconditioned conjugate gradients from zero, on `residual` = b.
    SpringSolve solve() {
        std::fill(velocity_change.begin(), velocity_change.end(), 0.0);
        system.precondition(residual, preconditioned);
        direction = preconditioned;
        double rho = dot(residual, preconditioned);
        const double target = relative_tolerance * relative_tolerance * rho;
        const double initial = rho;
        SpringSolve result;
        while (rho > target && result.iterations < max_iterations) {
            system.apply(direction, image);
            const double step = rho / dot(direction, image);
            for (std::size_t i = 0; i < residual.size(); ++i) {
                velocity_change[i] += step * direction[i];
                residual[i] -= step * image[i];
            }
            system.precondition(residual, preconditioned);
            const double rho_before = std::exchange(rho, dot(residual, preconditioned));
            const double beta = rho / rho_before;
            for (std::size_t i = 0; i < residual.size(); ++i) direction[i] = preconditioned[i] + beta * direction[i];
            ++result.iterations;
        }
        result.residual = initial > 0.0 ? std::sqrt(rho / initial) : 0.0;
        result.converged = rho <= target;
        return result;
    }
};

ImplicitSprings::ImplicitSprings(const ClothState& cloth, std::vector<Spring> springs, double damping) {
    check_springs(cloth, springs);
    if (!(damping >= 0.0) || !std::isfinite(damping)) {
        throw Error(ErrorCode::invalid_argument,
                    "implicit springs: damping must be finite and ≥ 0 (1/s), got " + std::to_string(damping));
    }
    implementation_ = std::make_unique<Implementation>(cloth, std::move(springs), damping);
}

ImplicitSprings::~ImplicitSprings() = default;
ImplicitSprings::ImplicitSprings(ImplicitSprings&&) noexcept = default;
ImplicitSprings& ImplicitSprings::operator=(ImplicitSprings&&) noexcept = default;

SpringSolve ImplicitSprings::advance_velocities(ClothState& cloth, const std::array<double, 3>& gravity,
                                                double time_step) {
    if (!(time_step > 0.0)) {
        throw Error(ErrorCode::invalid_argument,
                    "implicit springs: time_step must be positive (s), got " + std::to_string(time_step));
    }
    if (!all_finite(cloth.positions) || !all_finite(cloth.velocities))
        return {.iterations = 0, .residual = 1.0, .converged = false};
    Implementation& state = *implementation_;
    state.system.linearize(cloth, time_step, state.damping);
    state.set_right_hand_side(cloth, gravity, time_step);
    SpringSolve result = state.solve();
    if (!all_finite(state.velocity_change)) {
        result.converged = false;
        return result;
    }
    for (std::size_t i = 0; i < cloth.velocities.size(); ++i) cloth.velocities[i] += state.velocity_change[i];
    return result;
}

std::span<const Spring> ImplicitSprings::springs() const noexcept {
    return implementation_->system.springs();
}

std::size_t ImplicitSprings::scratch_bytes() const noexcept {
    return implementation_->system.scratch_bytes() + 5 * implementation_->residual.size() * sizeof(double);
}

}  // namespace apsl::scenes

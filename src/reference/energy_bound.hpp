// SPDX-License-Identifier: MIT
#pragma once

#include "reference/contact.hpp"
#include "reference/geometry.hpp"

#include "../../kernels/constants.h"

#include <apsl/reference.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

// What a whole step may leave of kinetic energy (docs/formulation.md, Energy).
namespace apsl::reference {

/// A step where nothing but acceleration and damping acts.
template <class Real>
struct FreeEnd {
    std::span<const Real> positions;   ///< m, [3V]
    std::span<const Real> velocities;  ///< m/s, [3V]
    Real time_step;                    ///< s
};

/// What drives a cloth, and the frame that energies are measured in.
struct Drive {
    Vector3<double> velocity = Vector3<double>::Zero();  ///< m/s, of the frame
    double pins = 0.0;                                   ///< m/s, of the pins there
    double mass = 0.0;                                   ///< kg, of vertices that move
    double bodies = 0.0;                                 ///< kg m²/s², what bodies can add to Σ m |u|² there
    bool flies = false;                                  ///< nothing holds it or is within its reach
};

/// m²/s²: what a body adds at most to the square of a vertex' velocity, both in the frame. It pushes along its normal
/// up to its own speed there. With friction it drags along its surface, by what Coulomb's law gives for the speed that
/// they close at.
template <class Real>
double added_by_body(const Contact<Real>& contact, const Vector3<double>& velocity, const Vector3<double>& frame) {
    const Vector3<double> body = contact.velocity.template cast<double>() - frame, own = velocity - frame,
                          normal = contact.normal.template cast<double>();
    const double pushing = body.dot(normal), into = own.dot(normal);
    double added = pushing > into ? std::max(pushing * pushing - into * into, 0.0) : 0.0;
    if (contact.friction > Real(0)) {
        const double slip = (own - into * normal).norm(),
                     rubbed = slip + static_cast<double>(contact.friction) * std::max(pushing - into, 0.0),
                     dragged = std::min((body - pushing * normal).norm(), rubbed);
        added += std::max(dragged * dragged - slip * slip, 0.0);
    }
    return added;
}

/// Whether a body is faster than a vertex in the frame: then it also sets in motion what hangs on the vertex.
template <class Real>
bool pulls_along(const Contact<Real>& contact, const Vector3<double>& velocity, const Vector3<double>& frame) {
    return (contact.velocity.template cast<double>() - frame).squaredNorm() > (velocity - frame).squaredNorm();
}

/// What bodies add to Σ m |u|², kg m²/s².
struct AddedByBodies {
    double alone = 0.0, along = 0.0;  ///< to vertices that are faster than their body, and to those that it pulls along
    double pulling = 0.0;             ///< kg, of the latter

    /// What hangs on a vertex is the cloth's and counts once, and up to so many times the vertex' own mass.
    double of_cloth(double mass) const {
        return alone + along * std::clamp(mass / std::max(pulling, std::numeric_limits<double>::min()), 1.0,
                                          double{APSLK_PULLED_ALONG});
    }
};

/// The frame is the middle of the box around the velocities of the pins, and they drive by half its diagonal. Of a
/// cloth without pins it is its own mean velocity, or, where a body is within its reach, what stands still.
template <class Real>
Drive drive(const Buffers<Real>& buffers, const FreeEnd<Real>& free) {
    Eigen::AlignedBox<double, 3> pins;
    Vector3<double> momentum = Vector3<double>::Zero();
    Drive found;
    bool touches = false;
    const auto velocity = [&](std::size_t i) -> Vector3<double> {
        return position(free.velocities, i).template cast<double>();
    };
    const auto is_near = [&](std::size_t i) {
        return !buffers.contacts.empty() && buffers.inverse_masses[i] > Real(0) &&
               Contact<Real>(buffers.contacts, i)
                   .comes_near(position(free.positions, i), position(free.velocities, i), free.time_step);
    };
    for (std::size_t i = 0; i < buffers.inverse_masses.size(); ++i) {
        if (!(buffers.inverse_masses[i] > Real(0))) {
            pins.extend(velocity(i));
            continue;
        }
        momentum += velocity(i) / static_cast<double>(buffers.inverse_masses[i]);
        found.mass += 1.0 / static_cast<double>(buffers.inverse_masses[i]);
        touches = touches || is_near(i);
    }
    if (!pins.isEmpty()) {
        found.velocity = pins.center();
        found.pins = 0.5 * pins.diagonal().norm();
    } else if (!touches && found.mass > 0.0) {
        found.velocity = momentum / found.mass;
        found.flies = true;
    }
    AddedByBodies added;
    for (std::size_t i = 0; touches && i < buffers.inverse_masses.size(); ++i) {
        if (!is_near(i)) continue;
        const Contact<Real> contact(buffers.contacts, i);
        const double mass = 1.0 / static_cast<double>(buffers.inverse_masses[i]);
        const bool pulls = pulls_along(contact, velocity(i), found.velocity);
        (pulls ? added.along : added.alone) += mass * added_by_body(contact, velocity(i), found.velocity);
        if (pulls) added.pulling += mass;
    }
    found.bodies = added.of_cloth(found.mass);
    return found;
}

/// Σ m |u|² may be this times what is allowed. What is a little off its limits corrects itself, and the cloth of the
/// discrete step is a little off its energy too. `worst`: by how much the triangle that is furthest from its limits
/// misses them.
inline double energy_let_pass(double worst) {
    const double within = std::max(double{APSLK_UNMET} / std::max(worst, double{APSLK_AT_REST}) - 1.0, 0.0);
    return double{APSLK_ENERGY_LET_PASS} + double{APSLK_ENERGY_LET_PASS_WITHIN} * within;
}

/// J, of all parts: what hinges held at the start, less what they held at the start of the last part of several.
inline double bending_given(double at_start, double left, int parts) {
    const double count = parts;
    return std::max(at_start - (parts > 1 ? left : 0.0), 0.0) * count / std::max(count - 1.0, 1.0);
}

/// Pressures and tensions do no work but by what drives the cloth, and pins bring it to twice their speed at most.
template <class Real>
class EnergyBound {
public:
    EnergyBound() = default;
    EnergyBound(const Buffers<Real>& buffers, const FreeEnd<Real>& free)
        : inverse_masses_(buffers.inverse_masses),
          free_velocities_(free.velocities.begin(), free.velocities.end()),
          drive_(drive(buffers, free)) {
        for (std::size_t i = 0; i < inverse_masses_.size(); ++i) allowed_ += square(free_velocities_, i);
    }

    /// What hinges gave, J.
    void add_bending(double energy) { allowed_ += 2.0 * energy; }

    /// What acceleration gives on the way that the cloth went, in place of what it gives to the step without a limit.
    /// `change`: m, of component n of all positions over the step; `gained`: m/s, what acceleration adds to that of
    /// velocities.
    template <class Change, class Gained>
    void follow(std::span<const Real> start_velocities, double time_step, const Change& change, const Gained& gained) {
        for (std::size_t n = 0; n < free_velocities_.size(); ++n)
            if (inverse_masses_[n / 3] > Real(0)) {
                const double twice_mean =
                    static_cast<double>(start_velocities[n]) + static_cast<double>(free_velocities_[n]);
                allowed_ += gained(n) * (2.0 * change(n) / time_step - twice_mean) /
                            static_cast<double>(inverse_masses_[n / 3]);
            }
    }

    /// Where the cloth has more energy than it may, leads velocities of vertices that gained over the step without a
    /// limit back to theirs there, and slows the cloth as a whole where that is not enough, in the frame of what drives
    /// it. A cloth that flies keeps its momentum: it is only slowed as a whole. `worst`: by how much the triangle that
    /// is furthest from its limits misses them. Returns the share of the cloth's energy there that is left.
    double apply(std::span<Real> velocities, double worst) const {
        std::vector<double> gains(inverse_masses_.size());
        double left = 0.0, gained = 0.0;
        for (std::size_t i = 0; i < gains.size(); ++i) {
            const double energy = square(velocities, i);
            gains[i] = std::max(energy - square(free_velocities_, i), 0.0);
            left += energy;
            gained += gains[i];
        }
        const double free = std::max(allowed_, 0.0), pins = drive_.pins * std::sqrt(drive_.mass),
                     root = std::sqrt(free);
        const double allowed =
            std::pow(std::max(root, std::min(root + pins, 2.0 * pins)) + std::sqrt(drive_.bodies), 2);
        if (!(left > energy_let_pass(worst) * allowed)) return 1.0;
        const double over = left - allowed;
        const double gain_kept = drive_.flies ? 1.0 : std::max(1.0 - over / gained, 0.0);
        const double rest = drive_.flies ? left : left - gained;
        const auto speed_kept = static_cast<Real>(drive_.flies || over > gained ? std::sqrt(allowed / rest) : 1.0);
        const Vector3<Real> frame = drive_.velocity.template cast<Real>();
        for (std::size_t i = 0; i < gains.size(); ++i) {
            if (!(inverse_masses_[i] > Real(0))) continue;
            Eigen::Map<Vector3<Real>> velocity(velocities.data() + 3 * i);
            if (gains[i] > 0.0 && gain_kept < 1.0) {
                const Vector3<Real> free_velocity = position(std::span<const Real>(free_velocities_), i);
                velocity = free_velocity + static_cast<Real>(gain_kept) * (velocity - free_velocity);
            }
            if (speed_kept < Real(1)) velocity = frame + speed_kept * (velocity - frame);
        }
        return allowed / left;
    }

private:
    /// m |u|² in the frame of what drives the cloth, kg m²/s², of a vertex that can move: twice its kinetic energy.
    double square(std::span<const Real> velocities, std::size_t i) const {
        if (!(inverse_masses_[i] > Real(0))) return 0.0;
        return (position(velocities, i).template cast<double>() - drive_.velocity).squaredNorm() /
               static_cast<double>(inverse_masses_[i]);
    }

    std::span<const Real> inverse_masses_;
    std::vector<Real> free_velocities_;  ///< at the end of the step without a limit, [3V]
    Drive drive_;
    double allowed_ = 0.0;  ///< Σ m |u|², but for what drives the cloth
};

}  // namespace apsl::reference

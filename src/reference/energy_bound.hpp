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
#include <cstdint>
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
/// up to its own speed there, and drags along its surface where there is friction. A body that is faster than the
/// vertex also sets in motion what hangs on it.
template <class Real>
double added_by_body(const Contact<Real>& contact, const Vector3<double>& velocity, const Vector3<double>& frame) {
    const Vector3<double> body = contact.velocity.template cast<double>() - frame, own = velocity - frame,
                          normal = contact.normal.template cast<double>();
    const double pushing = body.dot(normal), into = own.dot(normal);
    double added = pushing > into ? std::max(pushing * pushing - into * into, 0.0) : 0.0;
    if (contact.friction > Real(0))
        added += std::max((body - pushing * normal).squaredNorm() - (own - into * normal).squaredNorm(), 0.0);
    return body.squaredNorm() > own.squaredNorm() ? double{APSLK_PULLED_ALONG} * added : added;
}

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
    for (std::size_t i = 0; touches && i < buffers.inverse_masses.size(); ++i)
        if (is_near(i))
            found.bodies += added_by_body(Contact<Real>(buffers.contacts, i), velocity(i), found.velocity) /
                            static_cast<double>(buffers.inverse_masses[i]);
    return found;
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
        : inverse_masses_(buffers.inverse_masses), drive_(drive(buffers, free)), free_(inverse_masses_.size()) {
        for (std::size_t i = 0; i < free_.size(); ++i) free_[i] = square(free.velocities, i);
    }

    /// What hinges gave, J.
    void add_bending(double energy) { bending_ += 2.0 * energy; }

    /// Where the cloth has more energy than it may, and some of it is outside its limits, takes from vertices there
    /// what they gained over the step without a limit, and from the others where that is not enough. A cloth that flies
    /// keeps its momentum: it is slowed as a whole, in the frame of what drives it. `unmet`: 1 for a vertex at a
    /// triangle outside its limits, 0 for any other, [V]. Returns the share of the cloth's energy there that is left.
    double apply(std::span<Real> velocities, std::span<const std::uint8_t> unmet) const {
        std::vector<double> squares(free_.size());
        double free = bending_, all = 0.0, of_unmet = 0.0, gained_unmet = 0.0, gained_met = 0.0;
        for (std::size_t i = 0; i < free_.size(); ++i) {
            squares[i] = square(velocities, i);
            free += free_[i];
            all += squares[i];
            if (unmet[i] != 0) of_unmet += squares[i];
            (unmet[i] != 0 ? gained_unmet : gained_met) += std::max(squares[i] - free_[i], 0.0);
        }
        const double pins = drive_.pins * std::sqrt(drive_.mass), root = std::sqrt(free);
        const double allowed =
            std::pow(std::max(root, std::min(root + pins, 2.0 * pins)) + std::sqrt(drive_.bodies), 2);
        if (!(of_unmet > 0.0) || !(all > double{APSLK_ENERGY_LET_PASS} * allowed)) return 1.0;
        const double over = all - allowed;
        const double unmet_share = over < gained_unmet ? 1.0 - over / gained_unmet : 0.0,
                     met_share = over > gained_unmet ? std::max(1.0 - (over - gained_unmet) / gained_met, 0.0) : 1.0;
        for (std::size_t i = 0; i < free_.size(); ++i) {
            const double gain = unmet[i] != 0 ? unmet_share : met_share;
            double share = 1.0;
            if (drive_.flies)
                share = std::sqrt(allowed / all);
            else if (squares[i] > free_[i])
                share = std::sqrt(gain + (1.0 - gain) * free_[i] / squares[i]);
            const auto kept = static_cast<Real>(share);
            Eigen::Map<Vector3<Real>> velocity(velocities.data() + 3 * i);
            const Vector3<Real> frame = drive_.velocity.template cast<Real>();
            if (inverse_masses_[i] > Real(0) && kept < Real(1)) velocity = frame + kept * (velocity - frame);
        }
        return allowed / all;
    }

private:
    /// m |u|² in the frame of what drives the cloth, kg m²/s², of a vertex that can move: twice its kinetic energy.
    double square(std::span<const Real> velocities, std::size_t i) const {
        if (!(inverse_masses_[i] > Real(0))) return 0.0;
        return (position(velocities, i).template cast<double>() - drive_.velocity).squaredNorm() /
               static_cast<double>(inverse_masses_[i]);
    }

    std::span<const Real> inverse_masses_;
    Drive drive_;
    std::vector<double> free_;  ///< at the end of the step without a limit, [V]
    double bending_ = 0.0;
};

}  // namespace apsl::reference

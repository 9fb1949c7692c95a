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

// What a whole step may leave of kinetic energy (docs/formulation.md, Energy).
namespace apsl::reference {

/// What drives a cloth, and the frame that energies are measured in.
struct Drive {
    Vector3<double> velocity = Vector3<double>::Zero();  ///< m/s, of the frame
    double pins = 0.0;                                   ///< m/s, of the pins there
    double mass = 0.0;                                   ///< kg, of vertices that move
    double bodies = 0.0;                                 ///< kg m²/s², what bodies can add to Σ m |u|² there
    bool flies = false;                                  ///< nothing holds it or may touch it
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
/// cloth without pins it is its own mean velocity, or, where it may touch something, what stands still. `free`: m/s,
/// [3V], velocities at the end of the step where nothing but acceleration and damping acts.
template <class Real>
Drive drive(const Buffers<Real>& buffers, std::span<const Real> free) {
    Eigen::AlignedBox<double, 3> pins;
    Vector3<double> momentum = Vector3<double>::Zero();
    Drive found;
    bool touches = false;
    const auto velocity = [&](std::size_t i) -> Vector3<double> { return position(free, i).template cast<double>(); };
    const auto contact = [&](std::size_t i) { return Contact<Real>(buffers.contacts, i); };
    for (std::size_t i = 0; i < buffers.inverse_masses.size(); ++i) {
        if (!(buffers.inverse_masses[i] > Real(0))) {
            pins.extend(velocity(i));
            continue;
        }
        momentum += velocity(i) / static_cast<double>(buffers.inverse_masses[i]);
        found.mass += 1.0 / static_cast<double>(buffers.inverse_masses[i]);
        touches = touches || (!buffers.contacts.empty() && !contact(i).normal.isZero(Real(0)));
    }
    if (!pins.isEmpty()) {
        found.velocity = pins.center();
        found.pins = 0.5 * pins.diagonal().norm();
    } else if (!touches && found.mass > 0.0) {
        found.velocity = momentum / found.mass;
        found.flies = true;
    }
    for (std::size_t i = 0; touches && i < buffers.inverse_masses.size(); ++i)
        if (buffers.inverse_masses[i] > Real(0) && !contact(i).normal.isZero(Real(0)))
            found.bodies +=
                added_by_body(contact(i), velocity(i), found.velocity) / static_cast<double>(buffers.inverse_masses[i]);
    return found;
}

/// J, of all parts: what hinges held at the start, less what they held at the start of the last part of several.
inline double bending_given(double at_start, double left, int parts) {
    const double count = parts;
    return std::max(at_start - (parts > 1 ? left : 0.0), 0.0) * count / std::max(count - 1.0, 1.0);
}

/// Pressures and tensions do no work but by what drives the cloth.
template <class Real>
class EnergyBound {
public:
    EnergyBound() = default;
    /// `free`: see drive().
    EnergyBound(const Buffers<Real>& buffers, std::span<const Real> free)
        : inverse_masses_(buffers.inverse_masses), drive_(drive(buffers, free)), squares_(squares(free)) {}

    /// What hinges gave, J.
    void add_bending(double energy) { squares_ += 2.0 * energy; }

    /// Where the cloth has more energy than it may, and some of it is outside its limits, slows that in the frame of
    /// what drives the cloth, and the rest where that is not enough. A cloth that flies keeps its momentum: it is
    /// slowed as a whole. `unmet`: 1 for a vertex at a triangle outside its limits, 0 for any other, [V].
    void apply(std::span<Real> velocities, std::span<const std::uint8_t> unmet) const {
        const double allowed = std::sqrt(squares_) + drive_.pins * std::sqrt(drive_.mass) + std::sqrt(drive_.bodies);
        double unmet_squares = 0.0, met_squares = 0.0;
        for (std::size_t i = 0; i < inverse_masses_.size(); ++i)
            (unmet[i] != 0 ? unmet_squares : met_squares) += square(velocities, i);
        if (!(unmet_squares > 0.0) ||
            !(std::sqrt(unmet_squares + met_squares) > double{APSLK_ENERGY_LET_PASS} * allowed))
            return;
        const double left = allowed * allowed - met_squares, share = allowed / std::sqrt(unmet_squares + met_squares);
        const double unmet_kept = drive_.flies ? share : std::sqrt(std::max(left, 0.0) / unmet_squares),
                     met_kept = drive_.flies ? share
                                : left < 0.0 ? allowed / std::sqrt(met_squares)
                                             : 1.0;
        for (std::size_t n = 0; n < velocities.size(); ++n) {
            if (!(inverse_masses_[n / 3] > Real(0))) continue;
            const auto frame = static_cast<Real>(drive_.velocity[static_cast<Eigen::Index>(n % 3)]);
            const auto kept = static_cast<Real>(unmet[n / 3] != 0 ? unmet_kept : met_kept);
            if (kept < Real(1)) velocities[n] = frame + kept * (velocities[n] - frame);
        }
    }

private:
    /// Σ m |u|² in the frame of what drives the cloth, kg m²/s²: twice the kinetic energy.
    double squares(std::span<const Real> velocities) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < inverse_masses_.size(); ++i) sum += square(velocities, i);
        return sum;
    }

    double square(std::span<const Real> velocities, std::size_t i) const {
        if (!(inverse_masses_[i] > Real(0))) return 0.0;
        return (position(velocities, i).template cast<double>() - drive_.velocity).squaredNorm() /
               static_cast<double>(inverse_masses_[i]);
    }

    std::span<const Real> inverse_masses_;
    Drive drive_;
    double squares_ = 0.0;
};

}  // namespace apsl::reference

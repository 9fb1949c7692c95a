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
#include <span>

// What a whole step may leave of kinetic energy (docs/formulation.md, Energy).
namespace apsl::reference {

/// What drives a cloth, and the frame that energies are measured in.
struct Drive {
    Vector3<double> velocity = Vector3<double>::Zero();  ///< m/s, of the frame
    double speed = 0.0;                                  ///< m/s, of what drives the cloth there
};

/// The frame is the middle of the box around the velocities of the pins. Of a cloth without pins it is its own mean
/// velocity, or, where it may touch something, what stands still. Pins drive by half the diagonal of their box, a body
/// by what it is faster than the vertex that may touch it. `free`: m/s, [3V], velocities at the end of the step where
/// nothing but acceleration and damping acts.
template <class Real>
Drive drive(const Buffers<Real>& buffers, std::span<const Real> free) {
    Eigen::AlignedBox<double, 3> pins;
    Vector3<double> momentum = Vector3<double>::Zero();
    double mass = 0.0;
    bool touches = false;
    const auto velocity = [&](std::size_t i) -> Vector3<double> { return position(free, i).template cast<double>(); };
    const auto contact = [&](std::size_t i) { return Contact<Real>(buffers.contacts, i); };
    for (std::size_t i = 0; i < buffers.inverse_masses.size(); ++i) {
        if (!(buffers.inverse_masses[i] > Real(0))) {
            pins.extend(velocity(i));
            continue;
        }
        momentum += velocity(i) / static_cast<double>(buffers.inverse_masses[i]);
        mass += 1.0 / static_cast<double>(buffers.inverse_masses[i]);
        touches = touches || (!buffers.contacts.empty() && !contact(i).normal.isZero(Real(0)));
    }
    Drive found;
    if (!pins.isEmpty())
        found = {pins.center(), 0.5 * pins.diagonal().norm()};
    else if (!touches && mass > 0.0)
        found.velocity = momentum / mass;
    double faster = 0.0;
    for (std::size_t i = 0; touches && i < buffers.inverse_masses.size(); ++i)
        if (buffers.inverse_masses[i] > Real(0) && !contact(i).normal.isZero(Real(0)))
            faster = std::max(faster, (contact(i).velocity.template cast<double>() - found.velocity).norm() -
                                          (velocity(i) - found.velocity).norm());
    found.speed += faster;
    return found;
}

/// Pressures and tensions do no work but by what drives the cloth.
template <class Real>
class EnergyBound {
public:
    EnergyBound() = default;
    /// `free`: see drive().
    EnergyBound(const Buffers<Real>& buffers, std::span<const Real> free)
        : inverse_masses_(buffers.inverse_masses), drive_(drive(buffers, free)), squares_(squares(free)) {
        for (const Real inverse_mass : inverse_masses_)
            if (inverse_mass > Real(0)) mass_ += 1.0 / static_cast<double>(inverse_mass);
    }

    /// What hinges hold at the start of the step, J.
    void add_bending(double energy) { squares_ += 2.0 * energy; }

    /// Slows the whole cloth, in the frame of what drives it, where it has more energy than it may.
    void apply(std::span<Real> velocities) const {
        const double allowed = std::sqrt(squares_) + drive_.speed * std::sqrt(mass_),
                     root = std::sqrt(squares(velocities));
        if (!(root > double{APSLK_ENERGY_LET_PASS} * allowed)) return;
        const auto kept = static_cast<Real>(allowed / root);
        for (std::size_t n = 0; n < velocities.size(); ++n) {
            const auto frame = static_cast<Real>(drive_.velocity[static_cast<Eigen::Index>(n % 3)]);
            if (inverse_masses_[n / 3] > Real(0)) velocities[n] = frame + kept * (velocities[n] - frame);
        }
    }

private:
    /// Σ m |u|² in the frame of what drives the cloth, kg m²/s²: twice the kinetic energy.
    double squares(std::span<const Real> velocities) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < inverse_masses_.size(); ++i)
            if (inverse_masses_[i] > Real(0))
                sum += (position(velocities, i).template cast<double>() - drive_.velocity).squaredNorm() /
                       static_cast<double>(inverse_masses_[i]);
        return sum;
    }

    std::span<const Real> inverse_masses_;
    Drive drive_;
    double squares_ = 0.0, mass_ = 0.0;
};

}  // namespace apsl::reference

// SPDX-License-Identifier: MIT
#pragma once

#include "reference/geometry.hpp"

#include "../../kernels/constants.h"

#include <algorithm>
#include <cstddef>
#include <span>

// What a vertex touches, and how it is kept outside (docs/formulation.md, Contact).
namespace apsl::reference {

/// The plane that one vertex may touch: Buffers::contacts.
template <class Real>
struct Contact {
    Vector3<Real> normal;  ///< unit; zero: none
    Real offset;           ///< m, at the end of the step
    Vector3<Real> velocity;
    Real friction;

    Contact(std::span<const Real> contacts, std::size_t vertex)
        : Contact(contacts.subspan(APSLK_CONTACT_SIZE * vertex, APSLK_CONTACT_SIZE)) {}

    explicit Contact(std::span<const Real> numbers)
        : normal(position(numbers, 0)),
          offset(numbers[3]),
          velocity(position(numbers.subspan(4), 0)),
          friction(numbers[7]) {}

    /// m, ≥ 0: how deep x lies in the body a time `time_left` before the end of the step.
    Real depth(const Vector3<Real>& x, Real time_left) const {
        if (normal.isZero(Real(0))) return Real(0);
        return std::max(offset - time_left * normal.dot(velocity) - normal.dot(x), Real(0));
    }

    /// Whether a vertex that ends the step at x with `own` velocity, both free, comes within reach: what the two move
    /// by in a step at their speed against one another.
    bool comes_near(const Vector3<Real>& x, const Vector3<Real>& own, Real time_step) const {
        return !normal.isZero(Real(0)) && normal.dot(x) - offset <= time_step * (own - velocity).norm();
    }

    /// The share of a slip that friction takes where a speed `into` the body is taken as well, both m/s or both m:
    /// Coulomb's law.
    Real rubbed_share(Real slip, Real into) const {
        const Real most = friction * into;
        return slip > most ? most / slip : Real(1);
    }
};

/// A vertex at some moment of a step, and how it came there.
template <class Real>
struct MovingVertex {
    Vector3<Real> position;   ///< m
    Vector3<Real> motion;     ///< m, Δt times its velocity
    Vector3<Real> travelled;  ///< m, its way since it was last looked at

    /// Out of the body: to the surface, with no speed into it, and slowed along it by friction. `time_left`, s, until
    /// the end of the step; `share`, of the step, since the vertex was last looked at. False, and nothing moved, where
    /// it is outside.
    bool keep(const Contact<Real>& contact, Real time_step, Real time_left, Real share) {
        const Real depth = contact.depth(position, time_left);
        if (!(depth > Real(0))) return false;
        const auto along_surface = [&](const Vector3<Real>& v) -> Vector3<Real> {
            return v - v.dot(contact.normal) * contact.normal;
        };
        const Vector3<Real> body = time_step * contact.velocity, relative = motion - body;
        const Real into = std::max(-relative.dot(contact.normal), Real(0));
        const Vector3<Real> slip = along_surface(relative);
        const Real rubbed = contact.rubbed_share(slip.norm(), into);
        motion += into * contact.normal - rubbed * slip;
        position += depth * contact.normal - rubbed * along_surface(travelled - share * body);
        return true;
    }
};

}  // namespace apsl::reference

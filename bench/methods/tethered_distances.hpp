// SPDX-License-Identifier: MIT
#pragma once

#include "methods/method.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>

namespace apsl::methods {

/// What games move a cloth by: position-based dynamics as a whole integrator, in small steps, with tethers to the pins.
struct TetherSettings {
    int steps = 20;              ///< small steps in a time step of the cloth, ≥ 1
    double tether_length = 1.0;  ///< times the way to the pin at rest; 0 without tethers
    double bending = 1.0;        ///< part of its error that a bending constraint takes away in a small step, 0 to 1
    double damping = 0.5;        ///< 1/s, ≥ 0
    Eigen::Vector3d gravity{0.0, -9.81, 0.0};  ///< m/s²
};

/// Position-based distance constraints with tethers, on one thread, four constraints at a time.
///
/// A small step h: x ← x + h v, v damped and accelerated; every tether once; every bending constraint once; every edge
/// once; v ← what x moved by over h. Edges are the mesh's; a bending constraint is the distance of the two vertices
/// opposite an edge (in a grid also the other diagonal of a square).
///
/// T.-Y. Kim, N. Chentanez, M. Müller: Long range attachments: a method to simulate inextensible clothing in computer
/// games. SCA 2012. M. Macklin et al.: Small steps in physics simulation. SCA 2019. Constraints: pbd_edges.cpp.
class TetheredDistances {
public:
    /// Throws Error(invalid_argument) naming the setting that is out of range.
    TetheredDistances(const Cloth& cloth, const TetherSettings& settings);
    ~TetheredDistances();
    TetheredDistances(TetheredDistances&&) noexcept;
    TetheredDistances& operator=(TetheredDistances&&) noexcept;

    /// One time step of the cloth: positions (m, [V]) and velocities (m/s, [V]) of its start become those of its end.
    /// Pinned vertices go by their velocity. Where something is not finite anything may come out; nothing crashes.
    void advance(std::span<Eigen::Vector3f> positions, std::span<Eigen::Vector3f> velocities);

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace apsl::methods

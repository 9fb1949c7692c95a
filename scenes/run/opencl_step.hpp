// SPDX-License-Identifier: MIT
#pragma once

#include "run/opencl_contacts.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace apsl::scenes {

/// Whole steps on the device (Options::integrates). The cloth stays there: pinned vertices alone are told where they
/// go, and positions and velocities come back where somebody asks for them.
class OpenClStep {
public:
    /// As OpenClCloth. The origin of the device's 32-bit positions stays where the cloth is now.
    OpenClStep(const OpenClDevice& device, const ClothState& cloth, const StrainLimiting& settings, bool profile);

    /// Takes the positions and velocities of the cloth's pinned vertices to the device, where any moves or has moved
    /// last time.
    void place_pins(const ClothState& cloth);
    /// Finds what the cloth may touch in the step, as many colliders in each.
    void find_contacts(std::span<const ColliderStep> colliders);
    /// One step; of `cloth` the pinned vertices alone move on.
    Stats step(ClothState& cloth);
    /// Positions and velocities of all other vertices into `cloth`.
    void read_back(ClothState& cloth);

    OpenClCloth& device() { return device_; }

private:
    OpenClCloth device_;
    double time_step_;
    FreeFlight flight_;
    std::array<double, 3> origin_;       // m, of the device's positions
    std::vector<std::uint32_t> pinned_;  // vertices
    bool pins_moved_ = false;
    std::optional<OpenClContacts> contacts_;  // from the first on
    host::KernelHandle place_pins_;           // without pinned vertices null, like the buffers
    host::BufferHandle pinned_vertices_;
    host::BufferHandle pin_states_;
    std::vector<float> states_;                  // [6 · pinned]
    std::vector<float> positions_, velocities_;  // [3V]
};

}  // namespace apsl::scenes

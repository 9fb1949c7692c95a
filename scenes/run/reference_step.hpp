// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/contacts.hpp"
#include "run/reference_filter.hpp"

#include <span>
#include <vector>

namespace apsl::scenes {

/// Whole steps by the reference (Options::integrates), on the cloth as it is.
class ReferenceStep {
public:
    ReferenceStep(const ClothState& cloth, const StrainLimiting& settings)
        : filter_(cloth, settings),
          flight_(free_flight(settings.parameters)),
          time_step_(static_cast<double>(settings.parameters.time_step)) {}

    /// Finds what the cloth may touch in the step.
    void find_contacts(const ClothState& cloth, std::span<const ColliderStep> colliders) {
        if (!colliders.empty()) contacts_ = contacts(cloth, colliders, flight_, time_step_);
    }

    /// One step of all vertices, pinned ones by their velocity.
    Stats step(ClothState& cloth) { return filter_.call(cloth, cloth.positions, contacts_); }

private:
    ReferenceFilter filter_;
    FreeFlight flight_;
    double time_step_;
    std::vector<double> contacts_;  // [8V], empty without colliders
};

}  // namespace apsl::scenes

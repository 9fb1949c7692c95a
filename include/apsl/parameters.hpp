// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/export.hpp>
#include <apsl/version.hpp>

#include <array>
#include <cstdint>

namespace apsl {

/// Which positions each sub-step linearises about.
enum class Stepping : std::int32_t {
    /// small_steps from 20 sub-steps up, from 2 with Options::limits_stretch, integrates or keeps_contacts; whole_step
    /// below
    automatic = 0,
    whole_step = 1,  ///< Algorithm 1 as printed: every sub-step starts from x̃ + Δt ṽ and what was corrected so far
    /// All sub-steps but the last move on by an equal part of Δt, with velocities that hold the corrections so far, and
    /// correct there; the last only corrects (Macklin et al. 2019, docs/formulation.md). Needs 2 sub-steps, and pays
    /// where a vertex moves less than about half an edge in each; with fewer than 20, tolerance 0.03 or less. CG stops
    /// at three times `tolerance`: what one solve leaves, the next takes up.
    small_steps = 2,
};

APSL_STRUCTS_BEGIN

/// What may change from one filter call to the next.
struct Parameters {
    float time_step = 1.0f / 60.0f;  ///< s, > 0; Δt of Algorithm 1
    float regularization = 1.05f;    ///< α ≥ 1, multiplies diag(G) (Section 4); ignored where a per-triangle α is given
    std::int32_t sub_steps = 30;     ///< from 0 to 10000; the fixed count of Algorithm 1
    /// ≥ `sub_steps`; 0: automatic. With Options::limits_stretch the device takes as many small steps, from `sub_steps`
    /// to this, as the stretch that the whole step would make and the tension of the calls before ask for
    /// (docs/formulation.md, Stretch ceiling); all of them are queued. More than `sub_steps` need sub_steps ≥ 2,
    /// velocities, a stepping other than whole_step, and first_regularization = 0. Automatic is twice `sub_steps` where
    /// these hold, `sub_steps` elsewhere.
    std::int32_t most_sub_steps = 0;
    /// |A − A⁰| / A⁰ ≥ 0; no further sub-step once every triangle is at or below it. With small steps looked at before
    /// the first and before the last.
    float target_area_change = 0.0f;
    float tolerance = 0.1f;            ///< in [0, 1): CG stops at ‖r‖ ≤ tolerance · ‖b‖, Euclidean norms of areas in m²
    std::int32_t max_iterations = 50;  ///< from 1 to 10000, CG iterations a solve
    /// 0: α stays as given. Otherwise a solve that fails or takes more iterations than this raises α for the next one
    /// (α − 1 doubles, up to 1024-fold), and one that takes at most half of it lowers it again towards the given value
    /// (Section 4).
    std::int32_t adaptive_threshold = 0;
    /// 0: α is the same in every sub-step. Otherwise > 1, the α of the first: from there to `regularization`, in the
    /// last, α − 1 changes by the same factor from one sub-step to the next (docs/formulation.md). Needs
    /// regularization > 1; a per-triangle α is that of the last sub-step and is scaled alike.
    float first_regularization = 0.0f;
    /// With Options::limits_stretch: no principal stretch of a triangle above this multiple of its rest shape, ≥ 1.01.
    /// 0: areas alone. With areas held, edges end between 1/this and this. Ignored where each triangle has its own.
    float stretch_ceiling = 0.0f;
    /// m/s², with Options::integrates: what vertices that are not pinned gain in each small step. Gravity. What differs
    /// from vertex to vertex is Buffers::accelerations.
    std::array<float, 3> acceleration{};
    /// 1/s ≥ 0, with Options::integrates: velocities fall by exp(−damping · t).
    float damping = 0.0f;
    /// N·m ≥ 0, with Options::bends: what the cloth resists bending with, the rigidity of a plate. Cotton has some
    /// 1e-5, denim 1e-4.
    float bending = 0.0f;
    /// ≥ 1, with Options::bends: evaluations of bending a small step. A hinge is as stiff as `bending` says while
    /// B h²/(ρ l⁴) < 0.0125 times the square of this, h the duration of a small step, ρ in kg/m², l the edges' length,
    /// and softer beyond: never unstable. Each costs a launch.
    std::int32_t bending_iterations = 2;
    Stepping stepping = Stepping::automatic;  ///< which positions each sub-step linearises about
    /// false: the cloth is left alone, nothing of it is read or written, its statistics are zeros with Status::off, and
    /// what is kept for its next call stays.
    bool enabled = true;

    bool operator==(const Parameters&) const = default;  ///< field by field
};

APSL_STRUCTS_END

/// Throws Error(invalid_argument) naming the first field that is out of range or not finite.
APSL_API void validate(const Parameters& parameters);

}  // namespace apsl

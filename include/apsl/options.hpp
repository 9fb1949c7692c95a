// SPDX-License-Identifier: MIT
#pragma once

#include <apsl/cxx20.hpp>
#include <apsl/export.hpp>
#include <apsl/parameters.hpp>
#include <apsl/version.hpp>

#include <cstdint>

namespace apsl {

/// Which matrix couples the pressures (docs/formulation.md).
enum class Matrix : std::int32_t {
    consistent = 0,  ///< G = ½ Σ w g·g over shared vertices: what Eq. (6) really does to the areas
    printed = 1,     ///< Eq. (4) as printed: triangles across an edge only
};

/// How G is applied inside Conjugate Gradient.
enum class Apply : std::int32_t {
    assembled_csr = 0,  ///< assemble the rows, then sparse matrix-vector products
    matrix_free = 1,    ///< from the corner gradients, nothing assembled
};

/// How the system of a sub-step is solved.
enum class Solver : std::int32_t {
    conjugate_gradient = 0,  ///< of the damped matrix G + (α − 1) diag(G), to Parameters::tolerance
    /// A fixed Chebyshev polynomial in G, of a degree with the reach that α has (docs/formulation.md): no sums over the
    /// cloth, one launch an iteration, and stable however few of them. Parameters::tolerance is not used.
    chebyshev = 1,
    automatic = 2,  ///< chebyshev with Options::limits_stretch, conjugate_gradient otherwise
};

/// How a call is divided over the device.
enum class Execution : std::int32_t {
    automatic = 0,    ///< one_group where the largest cloth is small, many_groups otherwise
    many_groups = 1,  ///< each step of the filter is a launch over all of a cloth
    one_group = 2,    ///< one work-group takes one cloth through the whole call, in a single launch for all cloths
};

APSL_STRUCTS_BEGIN

/// What is compiled into the kernels of a StrainLimiter.
struct Options {
    Matrix matrix = Matrix::consistent;  ///< what couples the pressures
    Apply apply = Apply::matrix_free;    ///< how it is applied
    /// one_group requires matrix = consistent, apply = matrix_free and solver = conjugate_gradient. On GPUs it also
    /// requires warm_start_sub_steps = 0 and regularization_per_triangle = false.
    Execution execution = Execution::automatic;
    /// Work-items a group, a power of two up to the device's limit; 0 takes what suits the device (1 on a CPU).
    std::uint32_t work_group_size = 0;
    /// Floats from one vertex to the next in positions and in velocities: ≥ 3, or 1 and more where components lie in
    /// runs of their own.
    std::uint32_t position_stride = 3;
    std::uint32_t velocity_stride = 3;  ///< likewise
    /// Floats from x to y and from y to z: 1 side by side (xyzxyz…); otherwise a number such that the runs do not
    /// overlap (structure of arrays: xxx…yyy…zzz… has stride 1 and here the vertices that there is room for).
    std::uint32_t position_component_stride = 1;
    std::uint32_t velocity_component_stride = 1;  ///< likewise
    /// Floats from one inverse mass to the next, ≥ 1. In the w of xyzw positions: 4, and Buffers::inverse_masses at the
    /// positions' offset + 12.
    std::uint32_t inverse_mass_stride = 1;
    /// There are no velocities: positions are those at the end of the step, and a call corrects them in place, as a
    /// constraint of position-based dynamics does. Parameters::time_step is not used, and steps stay whole.
    bool positions_only = false;
    /// A regularization buffer is given with every call.
    bool regularization_per_triangle = false;
    /// How many sub-steps of a call keep their pressures (4 B a triangle each; later sub-steps share the last). The
    /// solves of the next call start from them: fewer CG iterations at small α, at the price of one product with the
    /// matrix a solve, counted as an iteration. As many as there are sub-steps, or 0: solves start
    /// from zero. Results then depend on the calls before, within the tolerance of the solves.
    std::uint32_t warm_start_sub_steps = 0;
    /// chebyshev needs the consistent matrix, matrix-free, no warm_start_sub_steps and one α for all triangles, and
    /// with every call Parameters::adaptive_threshold 0.
    Solver solver = Solver::automatic;
    /// chebyshev: sub-steps from one bound of the matrix to the next, ≥ 1. 1 is for garments, where a triangle may
    /// become another from one sub-step to the next; where none does, one bound for all sub-steps of a call (as many or
    /// more) is quicker (docs/formulation.md).
    std::uint32_t bound_interval = 1;
    /// Principal stretches are limited along with the areas (docs/formulation.md, Stretch ceiling):
    /// Buffers::rest_shapes is given with every call. Needs solver chebyshev and bound_interval 1.
    bool limits_stretch = false;
    /// Each triangle has its own ceiling, Buffers::stretch_ceilings, in place of Parameters::stretch_ceiling. Needs
    /// limits_stretch.
    bool stretch_ceiling_per_triangle = false;
    /// A call is a whole time step in place of a filter: positions and velocities in and out, acceleration and damping
    /// act in every small step (docs/formulation.md, A whole step). Needs velocities, execution other than one_group,
    /// and in every call sub_steps ≥ 2 and a stepping other than whole_step.
    bool integrates = false;
    /// Vertices stay outside of what they touch (docs/formulation.md, Contact): Buffers::contacts is given with every
    /// call. Needs velocities, execution other than one_group, and in every call sub_steps ≥ 2 and a stepping other
    /// than whole_step.
    bool keeps_contacts = false;
    /// Hinges resist bending, by Parameters::bending (docs/formulation.md, Bending): Buffers::rest_hinges is given with
    /// every call. Needs integrates, and limits_stretch: without something to hold it in its plane a cloth flows.
    bool bends = false;
    /// Each vertex has an acceleration of its own beside Parameters::acceleration, as of wind (docs/formulation.md, A
    /// whole step): Buffers::accelerations is given with every call. Needs integrates.
    bool acceleration_per_vertex = false;
    /// Tethers a vertex, up to 4: every small step but the last takes the speed that would lead it further from an
    /// anchor, a pinned vertex, than the tether is long (docs/formulation.md, Tethers). Buffers::tether_anchors and
    /// tether_lengths are given with every call. Needs integrates.
    std::uint32_t tethers_per_vertex = 0;

    bool operator==(const Options&) const = default;  ///< field by field
};

/// The solver that `options` mean: automatic is resolved.
constexpr Solver resolved_solver(const Options& options) {
    if (options.solver != Solver::automatic) return options.solver;
    return options.limits_stretch ? Solver::chebyshev : Solver::conjugate_gradient;
}

APSL_STRUCTS_END

/// Throws Error(invalid_argument) naming the first field that is out of range, or the first that does not go with
/// another. Strides are looked at only where a limiter is made: whether they fit depends on the cloths.
APSL_API void validate(const Options& options);

/// The same of both, and of what does not go together.
APSL_API void validate(const Options& options, const Parameters& parameters);

}  // namespace apsl

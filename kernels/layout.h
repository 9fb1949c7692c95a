// SPDX-License-Identifier: MIT
// What host and kernels share: the structs in device memory, byte for byte. Formulas are not shared with the host.
#ifndef APSL_LAYOUT_H
#define APSL_LAYOUT_H

#ifdef __OPENCL_C_VERSION__
typedef uint apsl_uint;
typedef int apsl_int;

// Every helper of a kernel is inlined. With helpers left as calls, results on pocl 3.1 with several threads were wrong
// in about half of the runs under load, and in none with its single-threaded driver; inlined, in none. The cause is not
// known.
#define APSL_INLINE static inline __attribute__((always_inline))
#else
#include <cstdint>
typedef std::uint32_t apsl_uint;
typedef std::int32_t apsl_int;
#endif

// Where a cloth lies in the limiter's arrays. Fixed when the limiter is built.
typedef struct {
    apsl_uint vertex_begin;
    apsl_uint vertex_count;
    apsl_uint triangle_begin;  // in the limiter's arrays: a multiple of APSL_TRIANGLE_ALIGNMENT
    apsl_uint triangle_count;
    apsl_uint patch_begin;
    apsl_uint patch_count;
    apsl_uint rest_area_begin;  // in the caller's arrays
    apsl_uint padding;
} apsl_cloth;

// One cloth's apsl::Parameters for the current call.
typedef struct {
    float time_step;           // s
    float regularization;      // α, of the last sub-step
    float damping_step;        // log2 of (α − 1) of a sub-step over that of the next; 0 where α stays
    float target_area_change;  // |A − A⁰| / A⁰
    float tolerance_squared;
    apsl_int sub_steps;
    apsl_int max_iterations;
    apsl_int adaptive_iterations;  // 0: α stays as given
    apsl_int walked;               // sub-steps that move on by a part of Δt; 0: all correct at its end
    apsl_int enabled;              // 0: the cloth is left alone in this call
    apsl_int raises_masses;        // 0: every vertex weighs what was given
    apsl_int padding[5];
} apsl_parameters;

// Parameters of consecutive cloths, as a kernel argument: below the 1024 bytes that every device takes.
#define APSL_PARAMETER_BLOCK 14
typedef struct {
    apsl_parameters entry[APSL_PARAMETER_BLOCK];
} apsl_parameter_block;

// apsl::Stats, written by the device.
typedef struct {
    apsl_int sub_steps;
    apsl_int cg_iterations;
    float residual;
    float max_area_change;
    float rms_area_change;
    float initial_max_area_change;
    float initial_rms_area_change;
    apsl_int status;
    apsl_int offender;
    apsl_uint offender_index;
    apsl_uint raised_vertices;
    float greatest_mass_ratio;
} apsl_stats;

#define APSL_STATUS_OK 0
#define APSL_STATUS_NOT_CONVERGED 1
#define APSL_STATUS_WORSENED 2
#define APSL_STATUS_DIVERGED 3
#define APSL_STATUS_OFF 4

#define APSL_OFFENDER_NONE 0
#define APSL_OFFENDER_VERTEX 1
#define APSL_OFFENDER_TRIANGLE 2

// A greatest area change up to which a cloth is at rest: 32-bit positions tell no better.
#define APSL_AT_REST 1e-5f
// Of the greatest coordinate: what moves a vertex of a 32-bit position, twice over.
#define APSL_POSITION_RESOLUTION 2.4e-7f

// Where a cloth's solve stands. Each field is written by one work-group in a launch that does not read it elsewhere.
typedef struct {
    apsl_int stopped;           // no further sub-step in this call
    apsl_int discarded;         // the call did nothing, or worse: velocities stay
    apsl_int iterating;         // this CG iteration does its work
    float initial_residual;     // ‖b‖², m⁴
    float scaled_residual[2];   // γ = r̄·r̄ with r̄ = r/√(α diag G), of even and of odd iterations
    float step[2];              // CG step length, of even and of odd iterations
    apsl_int solve_iterations;  // done in the present solve; at 0 there is no pressure to read
    float adaptive_factor;      // ≥ 1, multiplies α − 1; outlives the call
    float initial_capped_rms;   // RMS area change at x̃ + Δt ṽ, each triangle's counted as at most 1
    float greatest_mass;        // of what a vertex may effectively weigh, kg
    float extent;               // greatest |coordinate|, m; kept by filter_in_one_group alone
    float measured;             // Σ A⁰, m²; likewise
} apsl_solve_state;

// Partial results of the work-groups of a launch, one float a group for each of these.
#define APSL_PARTIAL_RESIDUAL_EVEN 0  // ‖r‖² after an even number of iterations
#define APSL_PARTIAL_RESIDUAL_ODD 1
#define APSL_PARTIAL_SCALED_RESIDUAL_EVEN 2
#define APSL_PARTIAL_SCALED_RESIDUAL_ODD 3
#define APSL_PARTIAL_CURVATURE 4  // r̄·Ar̄
#define APSL_PARTIAL_MAX_CHANGE 5
#define APSL_PARTIAL_SQUARED_CHANGE 6
#define APSL_PARTIAL_MEASURED 7  // sum of rest areas, m²
#define APSL_PARTIAL_NOT_FINITE 8
#define APSL_PARTIAL_GUESS 9  // r̄·y₀
#define APSL_PARTIAL_BAD_VERTICES 10
#define APSL_PARTIAL_CAPPED_CHANGE 11  // as the squared change, each triangle's counted as at most 1
#define APSL_PARTIAL_LOG_MASSES 12     // Σ log₂ m over movable vertices, m in kg
#define APSL_PARTIAL_MOVABLE 13        // vertices
#define APSL_PARTIAL_RAISED 14         // vertices that weigh more than given
#define APSL_PARTIAL_MASS_RATIO 15     // their greatest mass over the one given
#define APSL_PARTIAL_EXTENT 16         // greatest |coordinate| at x̃ + Δt ṽ, m
#define APSL_PARTIAL_KINDS 17

// Triangle arrays are padded with zeros to this many entries, so that vector loads need no remainder.
#define APSL_TRIANGLE_ALIGNMENT 16

// A corner in device memory: 4 · triangle + corner number, so that no division is needed.
#define APSL_CORNER_TRIANGLE(corner) ((corner) >> 2)

#endif

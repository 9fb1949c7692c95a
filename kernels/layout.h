// SPDX-License-Identifier: MIT
// What host and kernels share: the structs in device memory, byte for byte. Formulas are not shared with the host.
#ifndef APSLK_LAYOUT_H
#define APSLK_LAYOUT_H

#include "constants.h"

#ifdef __OPENCL_C_VERSION__
typedef uint apslk_uint;
typedef int apslk_int;

// Every helper of a kernel is inlined. With helpers left as calls, results on pocl 3.1 with several threads were wrong
// in about half of the runs under load, and in none with its single-threaded driver; inlined, in none. The cause is not
// known.
#define APSLK_INLINE static inline __attribute__((always_inline))
#else
#include <cstdint>
typedef std::uint32_t apslk_uint;
typedef std::int32_t apslk_int;
#endif

// Runs of the limiter's rest values: of A⁰, and with a stretch ceiling of M = [m₀₀ m₀₁; 0 m₁₁], F = [x₁ − x₀, x₂ − x₀]
// M, and of the ceiling, 0 where a triangle has none.
#define APSLK_REST_SHAPE_00 1
#define APSLK_REST_SHAPE_01 2
#define APSLK_REST_SHAPE_11 3
#define APSLK_CEILING 4

// Runs of the start's errors: of areas, and with a stretch ceiling of excesses, as they were and as they are held.
#define APSLK_START_EXCESS 1
#define APSLK_HELD_EXCESS 2

// Where a cloth lies in the limiter's arrays. Fixed when the limiter is built.
typedef struct {
    apslk_uint vertex_begin;
    apslk_uint vertex_count;
    apslk_uint triangle_begin;  // in the limiter's arrays: a multiple of APSLK_TRIANGLE_ALIGNMENT
    apslk_uint triangle_count;
    apslk_uint patch_begin;
    apslk_uint patch_count;
    apslk_uint rest_area_begin;  // in the caller's arrays
    apslk_uint run;              // entries of the limiter's triangle arrays, of all cloths together
} apslk_cloth;

// One cloth's apsl::Parameters for the current call.
typedef struct {
    float time_step;           // s
    float regularization;      // α, of the last sub-step
    float damping_step;        // log2 of (α − 1) of a sub-step over that of the next; 0 where α stays
    float target_area_change;  // |A − A⁰| / A⁰
    float tolerance_squared;
    apslk_int sub_steps;
    apslk_int max_iterations;
    apslk_int adaptive_threshold;  // 0: α stays as given
    apslk_int small_steps;         // sub-steps that move on by a part of Δt; 0: all correct at its end
    apslk_int enabled;             // 0: the cloth is left alone in this call
    apslk_int raises_masses;       // 0: every vertex weighs what was given
    float stretch_ceiling;         // 0: none
    apslk_int most_sub_steps;      // at least sub_steps: with a stretch ceiling the device may raise them to it
    float acceleration[3];         // m/s²
    float damping;                 // 1/s
    float bending;                 // N·m
    apslk_int bending_iterations;  // evaluations a small step
    apslk_int given_small_steps;   // before the device raised them: those of the step that nothing limits
    apslk_int padding[12];         // to a power of two, as a pattern that fills a buffer
} apslk_parameters;

// Parameters of consecutive cloths, as a kernel argument: below the 1024 bytes that every device takes.
#define APSLK_PARAMETER_BLOCK 7
typedef struct {
    apslk_parameters entry[APSLK_PARAMETER_BLOCK];
} apslk_parameter_block;

// apsl::Stats, written by the device.
typedef struct {
    apslk_int sub_steps;
    apslk_int iterations;
    float residual;
    float max_area_change;
    float rms_area_change;
    float initial_max_area_change;
    float initial_rms_area_change;
    apslk_int status;
    apslk_int offender;
    apslk_uint offender_index;
    apslk_uint raised_vertices;
    float greatest_mass_ratio;
    float max_stretch;
    float max_stretch_excess;
    float rms_stretch_excess;
    float initial_max_stretch_excess;
    float initial_rms_stretch_excess;
    apslk_uint stretch_rows;
    float energy_kept;
} apslk_stats;

#define APSLK_STATUS_OK 0
#define APSLK_STATUS_NOT_CONVERGED 1
#define APSLK_STATUS_WORSENED 2
#define APSLK_STATUS_DIVERGED 3
#define APSLK_STATUS_OFF 4

#define APSLK_OFFENDER_NONE 0
#define APSLK_OFFENDER_VERTEX 1
#define APSLK_OFFENDER_TRIANGLE 2

// Of the greatest coordinate: what moves a vertex of a 32-bit position, twice over.
#define APSLK_POSITION_RESOLUTION 2.4e-7f

// Where a cloth's solve stands. Each field is written by one work-group in a launch that does not read it elsewhere.
typedef struct {
    apslk_int stopped;               // no further sub-step in this call
    apslk_int discarded;             // the call did nothing, or worse: velocities stay, or are those of no limiter
    apslk_int iterating;             // this CG iteration does its work
    float initial_squared_residual;  // ‖b‖², m⁴
    float scaled_residual[2];        // γ = r̄·r̄ with r̄ = r/√(α diag G), of even and of odd iterations
    float step[2];                   // CG step length, of even and of odd iterations
    apslk_int solve_iterations;      // done in the present solve; at 0 there is no pressure to read
    float adaptive_factor;           // ≥ 1, multiplies α − 1; outlives the call
    float asked_sub_steps;           // by the tension of the calls before, for Parameters::most_sub_steps
    float initial_capped_rms;        // RMS area change at x̃ + Δt ṽ, each triangle's counted as at most 1
    float greatest_mass;             // of what a vertex may effectively weigh, kg
    float extent;                    // greatest |coordinate|, m; kept by filter_in_one_group alone
    float measured;                  // Σ A⁰, m²; likewise
    float drive[3];                  // m/s, the frame that the energy of a whole step is measured in
    float pins;                      // m/s, of pins there
    float mass;                      // kg, of vertices that move
    apslk_int flies;                 // nothing holds the cloth or is within its reach
    float speed_kept;                // share of all velocities there
    float gain_kept;                 // of what velocities of vertices that gained have more than at the free end
} apslk_solve_state;

// Partial results of the work-groups of a launch, one float a group for each of these.
#define APSLK_PARTIAL_RESIDUAL_EVEN 0  // ‖r‖² after an even number of iterations
#define APSLK_PARTIAL_RESIDUAL_ODD 1
#define APSLK_PARTIAL_SCALED_RESIDUAL_EVEN 2
#define APSLK_PARTIAL_SCALED_RESIDUAL_ODD 3
#define APSLK_PARTIAL_CURVATURE 4  // r̄·Ar̄
#define APSLK_PARTIAL_MAX_CHANGE 5
#define APSLK_PARTIAL_SQUARED_CHANGE 6
#define APSLK_PARTIAL_MEASURED 7  // sum of rest areas, m²
#define APSLK_PARTIAL_NOT_FINITE 8
#define APSLK_PARTIAL_GUESS 9  // r̄·y₀
#define APSLK_PARTIAL_BAD_VERTICES 10
#define APSLK_PARTIAL_CAPPED_CHANGE 11  // as the squared change, each triangle's counted as at most 1
#define APSLK_PARTIAL_LOG_MASSES 12     // Σ log₂ m over movable vertices, m in kg
#define APSLK_PARTIAL_MOVABLE 13        // vertices
#define APSLK_PARTIAL_RAISED 14         // vertices that weigh more than given
#define APSLK_PARTIAL_MASS_RATIO 15     // their greatest mass over the one given
#define APSLK_PARTIAL_EXTENT 16         // greatest |coordinate| at x̃ + Δt ṽ, m
#define APSLK_PARTIAL_MAX_STRETCH 17
#define APSLK_PARTIAL_MAX_EXCESS 18      // of stretch over the ceiling
#define APSLK_PARTIAL_SQUARED_EXCESS 19  // the capped change has those of the excess too
#define APSLK_PARTIAL_STRETCH_ROWS 20    // those with a multiplier above zero
#define APSLK_PARTIAL_MASS 21            // kg, of vertices that can move
#define APSLK_PARTIAL_MOMENTUM 22        // kg m/s, of those at the free end of the step; x, y and z
#define APSLK_PARTIAL_GREATEST_PIN 25    // m/s, velocity; x, y and z
#define APSLK_PARTIAL_LEAST_PIN 28       // likewise, with its sign turned
#define APSLK_PARTIAL_TOUCHES 31         // whether a body is within reach of a vertex
#define APSLK_PARTIAL_FREE_ENERGY 32     // Σ m |u|² at the free end of the step, in the frame of what drives the cloth
#define APSLK_PARTIAL_LEFT_ENERGY 33     // and as the small steps left it
#define APSLK_PARTIAL_GAINED_ENERGY 34   // of that, what vertices have more than at the free end
#define APSLK_PARTIAL_ADDED_ALONE 35     // kg m²/s², what bodies add to it, of vertices faster than their body
#define APSLK_PARTIAL_ADDED_ALONG 36     // and of those that their body pulls along
#define APSLK_PARTIAL_PULLING 37         // kg, of these
#define APSLK_PARTIAL_BENDING_ENERGY 38  // J, at the start of the step
#define APSLK_PARTIAL_BENDING_LEFT 39    // J, at the start of the last part of several
#define APSLK_PARTIAL_WORST_MISS 40      // by how much a triangle misses its limits, at the end or start of the step
#define APSLK_PARTIAL_KINDS 41

// Triangle arrays are padded with zeros to this many entries, so that vector loads need no remainder.
#define APSLK_TRIANGLE_ALIGNMENT 16

// A corner in device memory: 4 · triangle + corner number, so that no division is needed.
#define APSLK_CORNER_TRIANGLE(corner) ((corner) >> 2)

#endif

/* SPDX-License-Identifier: MIT */
#ifndef APSL_APSL_H
#define APSL_APSL_H

/** @file
 * The C interface: the objects of strain_limiter.hpp and topology.hpp behind handles, where their full contract is.
 *
 * Functions that can fail return an apsl_result, 0 for success; apsl_last_error() then says in one line what was wrong.
 * Nothing is thrown. One limiter per thread; a topology may be shared.
 *
 * Versions 1.x only add: functions, enumerators, and fields in what is `reserved` in structs, where 0 will stand for
 * what there was before. A program built with 1.0 runs with every later 1.x library. */

#include <apsl/export.hpp>
#include <apsl/version.hpp>

#include <CL/cl.h>

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a function that can fail returns. */
typedef enum apsl_result {
    APSL_SUCCESS = 0,
    APSL_ERROR_INVALID_ARGUMENT = 1, /**< a parameter, option or size out of its range, or a null pointer */
    APSL_ERROR_INVALID_MESH = 2,     /**< triangles that no topology can be built from */
    APSL_ERROR_OPENCL = 3,           /**< an OpenCL call failed */
    APSL_ERROR_KERNEL_BUILD = 4,     /**< a kernel did not compile */
    APSL_ERROR_UNSUPPORTED = 5,      /**< the device cannot do what was asked */
    APSL_ERROR_OUT_OF_MEMORY = 6,    /**< on the host */
    APSL_ERROR_INTERNAL = 7          /**< none of these: an error in apsl */
} apsl_result;

/** apsl::Matrix: which matrix couples the pressures. */
typedef enum apsl_matrix { APSL_MATRIX_CONSISTENT = 0, APSL_MATRIX_PRINTED = 1 } apsl_matrix;
/** apsl::Apply: how that matrix is applied inside Conjugate Gradient. */
typedef enum apsl_apply { APSL_APPLY_ASSEMBLED_CSR = 0, APSL_APPLY_MATRIX_FREE = 1 } apsl_apply;

/** How a call is divided over the device. */
typedef enum apsl_execution {
    APSL_EXECUTION_AUTOMATIC = 0,   /**< one group where the largest cloth is small, many otherwise */
    APSL_EXECUTION_MANY_GROUPS = 1, /**< each step of the filter is a launch over all of a cloth */
    APSL_EXECUTION_ONE_GROUP = 2 /**< one work-group a cloth, the whole call in one launch; consistent, matrix-free */
} apsl_execution;

/** How a call ended, apsl_stats.status. */
typedef enum apsl_status {
    APSL_STATUS_OK = 0,            /**< every solve met its tolerance */
    APSL_STATUS_NOT_CONVERGED = 1, /**< a solve used all its iterations; the best state reached stands */
    APSL_STATUS_WORSENED = 2,      /**< area change rose; of start and end the state with less RMS stands */
    APSL_STATUS_DIVERGED = 3,      /**< not finite, going in or on the way: velocities are as they were given */
    APSL_STATUS_OFF = 4            /**< enabled was 0: nothing was looked at */
} apsl_status;

/** What apsl_stats.offender_index counts. */
typedef enum apsl_offender {
    APSL_OFFENDER_NONE = 0,    /**< nothing */
    APSL_OFFENDER_VERTEX = 1,  /**< position, velocity or inverse mass is not finite, or the mass is negative */
    APSL_OFFENDER_TRIANGLE = 2 /**< diverged: rest area is negative or, like alpha or the area it came to, not finite;
                                    worsened: it has the greatest area change, and that rose */
} apsl_offender;

/** apsl::ProgramBinaryUse: what became of a program binary. Unless taken, the program was built from source. */
typedef enum apsl_program_binary_use {
    APSL_PROGRAM_BINARY_NONE_GIVEN = 0,       /**< no bytes */
    APSL_PROGRAM_BINARY_TAKEN = 1,            /**< nothing was compiled here */
    APSL_PROGRAM_BINARY_NOT_A_BINARY = 2,     /**< not one of apsl's, or of another format version */
    APSL_PROGRAM_BINARY_OTHER_PROGRAM = 3,    /**< of other kernels, options, device or driver */
    APSL_PROGRAM_BINARY_DAMAGED = 4,          /**< its bytes have changed */
    APSL_PROGRAM_BINARY_REFUSED_BY_DRIVER = 5 /**< sound as far as apsl can tell */
} apsl_program_binary_use;

/** Which positions each sub-step linearises about. */
typedef enum apsl_stepping {
    APSL_STEPPING_AUTOMATIC = 0,  /**< small steps from 20 sub-steps up */
    APSL_STEPPING_WHOLE_STEP = 1, /**< from the end of the time step, as Algorithm 1 */
    APSL_STEPPING_SMALL_STEPS = 2 /**< each moves on by an equal part of the time step; the last only corrects */
} apsl_stepping;

/** How the system of a sub-step is solved. */
typedef enum apsl_solver {
    APSL_SOLVER_CONJUGATE_GRADIENT = 0, /**< of the damped matrix, to the tolerance */
    APSL_SOLVER_CHEBYSHEV = 1,          /**< a fixed polynomial with the reach of alpha, no sums over the cloth */
    APSL_SOLVER_AUTOMATIC = 2           /**< Chebyshev with limits_stretch, Conjugate Gradient otherwise */
} apsl_solver;

/** apsl::Topology behind a handle: immutable, may be shared between limiters and threads. */
typedef struct apsl_topology apsl_topology;
/** apsl::StrainLimiter behind a handle: one thread at a time. */
typedef struct apsl_limiter apsl_limiter;

/** apsl::Options: what is compiled in. Begin with apsl_default_options(). */
typedef struct apsl_options {
    int32_t matrix;                       /**< apsl_matrix */
    int32_t apply;                        /**< apsl_apply */
    int32_t execution;                    /**< apsl_execution */
    uint32_t work_group_size;             /**< a power of two; 0 takes what suits the device */
    uint32_t position_stride;             /**< floats from one vertex to the next, >= 3; 1 and more with runs */
    uint32_t velocity_stride;             /**< likewise */
    uint32_t position_component_stride;   /**< floats from x to y to z: 1 side by side, else runs of their own */
    uint32_t velocity_component_stride;   /**< likewise */
    uint32_t inverse_mass_stride;         /**< floats from one to the next, >= 1 */
    int32_t positions_only;               /**< not 0: no velocities; positions are the end of the step, in and out */
    int32_t regularization_per_triangle;  /**< not 0: a regularization buffer is given with every call */
    uint32_t warm_start_sub_steps;        /**< sub-steps whose pressures the next call's solves start from */
    int32_t solver;                       /**< apsl_solver */
    uint32_t bound_interval;              /**< by Chebyshev, >= 1: sub-steps from one bound of the matrix to the next */
    int32_t limits_stretch;               /**< not 0: principal stretches are limited too; rest shapes are given */
    int32_t stretch_ceiling_per_triangle; /**< not 0: a stretch_ceilings buffer is given with every call */
    int32_t integrates;                   /**< not 0: a call is a whole time step, positions in and out */
    int32_t keeps_contacts;               /**< not 0: a contacts buffer is given with every call */
    int32_t bends;                        /**< not 0: hinges resist bending; rest hinges are given with every call */
    int32_t acceleration_per_vertex;      /**< not 0: an accelerations buffer is given with every call */
    uint32_t tethers_per_vertex;          /**< 0 to 4; with integrates: tether buffers are given with every call */
    uint32_t reserved[4];                 /**< zeros; room for fields to come, so that the size stays */
} apsl_options;

/** apsl::Parameters: what may change from call to call. Begin with apsl_default_parameters(). */
typedef struct apsl_parameters {
    float time_step;            /**< s, > 0 */
    float regularization;       /**< alpha >= 1, multiplies diag(G) */
    int32_t sub_steps;          /**< from 0 to 10000 */
    float target_area_change;   /**< |A - A0| / A0 >= 0 at which no further sub-step is done */
    float tolerance;            /**< in [0, 1), of a solve's residual */
    int32_t max_iterations;     /**< from 1 to 10000, of a solve */
    int32_t adaptive_threshold; /**< 0: alpha stays as given; else more iterations than this raise it */
    float first_regularization; /**< 0: alpha is the same in every sub-step; else > 1, that of the first */
    int32_t stepping;           /**< apsl_stepping */
    int32_t enabled;            /**< 0: the cloth is left alone in this call; 1 by default */
    float stretch_ceiling;      /**< 0, or >= 1.01: the greatest principal stretch, with limits_stretch */
    int32_t most_sub_steps;     /**< >= sub_steps: the device takes more where stretch asks; 0: automatic */
    float acceleration[3];      /**< m/s2, with integrates */
    float damping;              /**< 1/s >= 0, with integrates */
    float bending;              /**< N m >= 0, with bends: the rigidity of the cloth */
    int32_t bending_iterations; /**< >= 1, with bends: evaluations of bending a small step */
    uint32_t reserved[6];       /**< zeros; room for fields to come, so that the size stays */
} apsl_parameters;

/** apsl::BufferView: 32-bit numbers in a buffer of the caller's. */
typedef struct apsl_buffer_view {
    cl_mem buffer; /**< the caller's; must live until the calls that use it complete */
    size_t offset; /**< bytes, a multiple of 4 */
} apsl_buffer_view;

/** apsl::Buffers; several cloths follow one another. What a call writes shares no float with anything else. */
typedef struct apsl_buffers {
    apsl_buffer_view positions;      /**< m, [V] with position_stride; the start of the step; only read. With
                                        positions_only the end of the step, in and out */
    apsl_buffer_view velocities;     /**< m/s, [V] with velocity_stride; in and out; null with positions_only */
    apsl_buffer_view inverse_masses; /**< 1/kg, [V] with inverse_mass_stride, 0 pins a vertex */
    apsl_buffer_view rest_areas;     /**< m2, [T]; 0 leaves a triangle alone */
    apsl_buffer_view regularization; /**< alpha, [T]; only with regularization_per_triangle, else a null buffer */
    apsl_buffer_view rest_shapes;    /**< 1/m, 4 floats a triangle, [T]: inverse of the 2x2 matrix of rest edges, row by
                                        row; zeros: no ceiling there. Only with limits_stretch, else a null buffer */
    apsl_buffer_view stretch_ceilings; /**< >= 1.01, [T], 0: none; only with stretch_ceiling_per_triangle */
    apsl_buffer_view contacts;         /**< 8 floats a vertex, [V]: outward unit normal n (zeros: none), offset d, m
                                          (kept at n.x >= d), velocity of the body there, m/s, friction coefficient;
                                          only with keeps_contacts */
    apsl_buffer_view rest_hinges;   /**< 2 floats a hinge, [H]: its angle at rest, rad, and l2/(A0 + A1); an edge of two
                                       triangles is a hinge, in ascending order of its vertices. Only with bends */
    apsl_buffer_view accelerations; /**< m/s2, [V] laid out as positions are: beside the acceleration of all; only with
                                       acceleration_per_vertex */
    apsl_buffer_view tether_anchors; /**< uint32_t, tethers_per_vertex a vertex, [V]: pinned vertices of the same cloth,
                                        as they lie in the buffers; others hold nothing; only with tethers_per_vertex */
    apsl_buffer_view tether_lengths; /**< m, likewise: how far a vertex may be from each; 0, or what is no positive
                                        number: no tether */
} apsl_buffers;

/** apsl::Stats: what a call did to one cloth. */
typedef struct apsl_stats {
    int32_t sub_steps;     /**< solves done */
    int32_t iterations;    /**< over all solves: of Conjugate Gradient, or products with the matrix by Chebyshev */
    float residual;        /**< greatest relative residual at the end of a solve; 0 by Chebyshev */
    float max_area_change; /**< max |A - A0| / A0 of the state that stands */
    float rms_area_change; /**< weighted with A0 */
    float initial_max_area_change; /**< the greatest at x + dt v */
    float initial_rms_area_change; /**< and the weighted RMS there */
    int32_t status;                /**< apsl_status */
    int32_t offender;              /**< apsl_offender; none unless status is diverged or worsened */
    uint32_t offender_index;       /**< the first one, within its cloth */
    uint32_t raised_vertices;      /**< vertices that weighed more than given in the last sub-step */
    float greatest_mass_ratio;     /**< their greatest mass over the one given; 1 where none was raised */
    float max_stretch;        /**< greatest principal stretch; this and the next five are 0 without limits_stretch */
    float max_stretch_excess; /**< greatest max(0, principal stretch - ceiling) of the state that stands */
    float rms_stretch_excess; /**< weighted with A0 */
    float initial_max_stretch_excess; /**< the greatest at x + dt v */
    float initial_rms_stretch_excess; /**< and the weighted RMS there */
    uint32_t stretch_rows;            /**< triangles that the ceiling held in the last sub-step */
    float energy_kept; /**< the share of the cloth's kinetic energy, against what drives it, that the bound on energy
                          left; 1 where it took none, and without integrates */
} apsl_stats;

/** What went wrong in this thread's last failed call: one line, empty before the first. Valid until the next one. */
APSL_API const char* apsl_last_error(void);

/** The library's version as it runs, "major.minor.patch"; the headers' is APSL_VERSION_MAJOR and so on. */
APSL_API const char* apsl_version(void);
/** The same as one number, to compare with APSL_VERSION_NUMBER. */
APSL_API int32_t apsl_version_number(void);

/** The default options. */
APSL_API apsl_options apsl_default_options(void);
/** The default parameters. */
APSL_API apsl_parameters apsl_default_parameters(void);

/** triangles: 3 vertex indices each, counter-clockwise. *topology is null where this fails. */
APSL_API apsl_result apsl_topology_create(const uint32_t* triangles, size_t triangle_count, size_t vertex_count,
                                          apsl_topology** topology);
/** Null is allowed. Limiters made from it live on. */
APSL_API void apsl_topology_destroy(apsl_topology* topology);

/** *count is that of the sets of pinned vertices that edges connect: a vertex wants a tether to each. pinned: vertices,
 * in any order. 0 where this fails. */
APSL_API apsl_result apsl_pinned_piece_count(const apsl_topology* topology, const uint32_t* pinned, size_t pinned_count,
                                             size_t* count);
/** What apsl_buffers.tether_anchors and tether_lengths hold of one cloth: tethers to the nearest vertex of each of the
 * per_vertex nearest sets of pinned vertices, as long as the way there over the surface at rest times stretch, > 0.
 * rest_positions: m, 3 floats a vertex, [V]. anchors and lengths: per_vertex a vertex, [V]; left alone where this
 * fails. With several cloths in the buffers, add to the anchors what the vertices before them count. */
APSL_API apsl_result apsl_tethers_to_pins(const apsl_topology* topology, const float* rest_positions,
                                          const uint32_t* pinned, size_t pinned_count, uint32_t per_vertex,
                                          float stretch, uint32_t* anchors, float* lengths);

/** One cloth or many. options may be null: the defaults. *limiter is null where this fails. */
APSL_API apsl_result apsl_limiter_create(cl_context context, cl_device_id device, const apsl_topology* const* cloths,
                                         size_t cloth_count, const apsl_options* options, apsl_limiter** limiter);
/** The same, from what apsl_limiter_program_binary gave: size bytes, tried in place of compiling. */
APSL_API apsl_result apsl_limiter_create_from_binary(cl_context context, cl_device_id device,
                                                     const apsl_topology* const* cloths, size_t cloth_count,
                                                     const apsl_options* options, const void* binary, size_t size,
                                                     apsl_limiter** limiter);
/** The same in memory of the caller's: a place in a buffer, itself no sub-buffer, with what
 * apsl_limiter_required_scratch_bytes says from its offset on. Nobody else may write there while the limiter lives.
 * binary may be null with size 0. */
APSL_API apsl_result apsl_limiter_create_in_scratch(cl_context context, cl_device_id device,
                                                    const apsl_topology* const* cloths, size_t cloth_count,
                                                    const apsl_options* options, const void* binary, size_t size,
                                                    const apsl_buffer_view* scratch, apsl_limiter** limiter);
/** *bytes is what a limiter for these cloths and options needs of scratch at any offset; 0 where this fails. */
APSL_API apsl_result apsl_limiter_required_scratch_bytes(cl_device_id device, const apsl_topology* const* cloths,
                                                         size_t cloth_count, const apsl_options* options,
                                                         size_t* bytes);
/** For other topologies, without compiling where the compiled program fits. scratch as in
 * apsl_limiter_create_in_scratch, not overlapping the present one; null allocates. Where this fails the limiter stays
 * as it was. */
APSL_API apsl_result apsl_limiter_rebuild(apsl_limiter* limiter, const apsl_topology* const* cloths, size_t cloth_count,
                                          const apsl_buffer_view* scratch);
/** Null is allowed. */
APSL_API void apsl_limiter_destroy(apsl_limiter* limiter);

/** Device memory it holds; 0 for null. */
APSL_API size_t apsl_limiter_scratch_bytes(const apsl_limiter* limiter);

/** The compiled program; *size is its bytes, 0 where the driver gives none and on pocl 6 with LLVM 18, which may abort
 * the process over it and is not asked. Where binary is null only the size is asked for; else capacity bytes are there
 * for it, at least *size. Best asked for after a call has completed. */
APSL_API apsl_result apsl_limiter_program_binary(const apsl_limiter* limiter, void* binary, size_t capacity,
                                                 size_t* size);
/** An apsl_program_binary_use; none given for null. */
APSL_API apsl_program_binary_use apsl_limiter_program_binary_use(const apsl_limiter* limiter);

/** Queues one call; parameter_count is 1 or the number of cloths. The event completes with the call and is the caller's
 * to release; where event is null there is none. */
APSL_API apsl_result apsl_limiter_enqueue(apsl_limiter* limiter, cl_command_queue queue, const apsl_buffers* buffers,
                                          const apsl_parameters* parameters, size_t parameter_count, cl_uint wait_count,
                                          const cl_event* wait_list, cl_event* event);

/** Queues the areas of all triangles, m2, [T], at rest_positions (m, [V], laid out as options say of positions) into
 * rest_areas: once, before the first call that reads them. The event is as that of apsl_limiter_enqueue. */
APSL_API apsl_result apsl_limiter_enqueue_rest_areas(apsl_limiter* limiter, cl_command_queue queue,
                                                     const apsl_buffer_view* rest_positions,
                                                     const apsl_buffer_view* rest_areas, cl_uint wait_count,
                                                     const cl_event* wait_list, cl_event* event);

/** Queues apsl_buffers.rest_shapes at rest_positions likewise: 4 floats a triangle. Only with limits_stretch. */
APSL_API apsl_result apsl_limiter_enqueue_rest_shapes(apsl_limiter* limiter, cl_command_queue queue,
                                                      const apsl_buffer_view* rest_positions,
                                                      const apsl_buffer_view* rest_shapes, cl_uint wait_count,
                                                      const cl_event* wait_list, cl_event* event);

/** Queues apsl_buffers.rest_hinges at rest_positions likewise: 2 floats a hinge. Only with bends. */
APSL_API apsl_result apsl_limiter_enqueue_rest_hinges(apsl_limiter* limiter, cl_command_queue queue,
                                                      const apsl_buffer_view* rest_positions,
                                                      const apsl_buffer_view* rest_hinges, cl_uint wait_count,
                                                      const cl_event* wait_list, cl_event* event);

/** Queues a non-blocking read of the last call's statistics, stats_count the number of cloths. stats must live until
 * the event, which must not be null, completes. */
APSL_API apsl_result apsl_limiter_read_stats(const apsl_limiter* limiter, cl_command_queue queue, apsl_stats* stats,
                                             size_t stats_count, cl_uint wait_count, const cl_event* wait_list,
                                             cl_event* event);

#ifdef __cplusplus
}
#endif

#endif

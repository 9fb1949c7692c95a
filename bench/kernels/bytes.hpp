// SPDX-License-Identifier: MIT
//
// Bytes each kernel must move at least once, counted from the layouts (32-bit, strides of 3). Caches are taken to be
// perfect: what several triangles share (a position, a vertex's force, a neighbour's residual) counts once. Steps are
// whole, as the benchmarks take them; what small steps move besides, the kernels' headers say.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace apsl::bench {

/// What the counts are multiplied with.
struct Sizes {
    std::size_t vertices, triangles;
    std::size_t entries;  ///< of the matrix's pattern, diagonal included
};

struct Traffic {
    std::string_view kernel;
    double per_vertex, per_triangle, per_entry;
    double per_triangle_saved_first = 0;  ///< what the first iteration of a solve need not read
    double per_stretch_row = 0;           ///< what a triangle's second row adds with a stretch ceiling
};

// An index, an offset or a float is 4 bytes; position with inverse mass (float4) 16; a caller's vector 12;
// the record of three corner gradients 32, of which the gradients alone 24; the corners of a triangle, as its vertices
// list them, 12. Names as in the kernels' arguments.
constexpr std::array traffic_table{
    // vertex_order, position, velocity, inverse mass read; moved written
    Traffic{"predict_positions", 48, 0, 0},
    // triangle_order, rest area read, ordered rest area written
    Traffic{"order_triangle_values", 0, 12, 0},
    // moved; indices 12, ordered rest area read; record, residual, scaled_diagonal written. The second row: rest shape
    // with ceiling 16 and excess of the start read, excess held read and written, gradients and right-hand side written
    Traffic{"assemble_gradients", 16, 56, 0, 0, 56},
    // moved, motion; indices 12, ordered rest area read, start error written
    Traffic{"measure_step", 32, 20, 0},
    // vertex_order, motion, velocity read; moved, motion, total_correction written
    Traffic{"start_small_steps", 80, 0, 0},
    // corner offset, bound written; corners 12, gradients 24 read
    Traffic{"bound_vertices", 8, 36, 0, 0, 24},
    // corner offset, patch_vertices; corners 12, gradients 24, local_triangles 6, right-hand side, y and the y before
    // read, y after written; the first two products find no y before, the first no y either
    Traffic{"chebyshev_step", 8, 58, 0, 12, 40},
    // row offset, record read; column 4 and shared code 1 read, value written
    Traffic{"assemble_pressure_csr", 0, 36, 9},
    // row offset, residual read, product written; value and column read
    Traffic{"csr_spmv_dot", 0, 12, 8},
    // corner offset, patch_vertices; corners 12, record, residual, local_triangles 6 read, product written. The rims of
    // the patches, which several patches read, are counted once.
    Traffic{"matrix_free_apply_dot", 8, 58, 0},
    // residual, direction, direction_product, pressure read and written, product, scaled_diagonal read; the first
    // iteration finds no direction, direction_product and pressure to read
    Traffic{"cg_update", 0, 40, 0, 12},
    // corner offset, moved read and written; corners 12, gradients 24, pressure read
    Traffic{"gather_displacements", 36, 40, 0, 0, 28},
    // moved; indices 12, ordered rest area read
    Traffic{"measure_area_change", 16, 16, 0},
    // vertex_order, moved, position, velocity read, velocity written
    Traffic{"update_velocities", 56, 0, 0},
    // vertex_order, moved, motion, position, velocity read
    Traffic{"measure_energy", 60, 0, 0},
    // vertex_order, moved, motion, position, velocity read, position and velocity written
    Traffic{"store_step", 84, 0, 0},
};

/// Bytes of one launch for the consistent matrix, on average over a solve of `iterations`; none for a kernel that the
/// table does not hold.
constexpr std::optional<double> bytes_moved(std::string_view kernel, const Sizes& sizes, int iterations) {
    for (const Traffic& traffic : traffic_table)
        if (traffic.kernel == kernel)
            return traffic.per_vertex * static_cast<double>(sizes.vertices) +
                   (traffic.per_triangle - traffic.per_triangle_saved_first / iterations) *
                       static_cast<double>(sizes.triangles) +
                   traffic.per_entry * static_cast<double>(sizes.entries);
    return std::nullopt;
}

/// One CG iteration of an assembled float CSR matrix with the Jacobi preconditioner, for the peers: entries 8, row
/// offset 4, and the same vectors as csr_spmv_dot and cg_update, which no peer does with less.
constexpr double csr_iteration_bytes(const Sizes& sizes) {
    return 8.0 * static_cast<double>(sizes.entries) + 52.0 * static_cast<double>(sizes.triangles);
}

}  // namespace apsl::bench

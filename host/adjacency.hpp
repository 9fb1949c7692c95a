// SPDX-License-Identifier: MIT
#pragma once

#include "kernels/layout.h"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace apsl::host {

/// The adjacency of all cloths one after another, in the layout the kernels read. Host memory, before the upload.
struct Adjacency {
    std::vector<apslk_cloth> cloths;
    std::vector<std::uint32_t> vertex_order;    ///< [V], place in the limiter's arrays -> place in the caller's
    std::vector<std::uint32_t> triangle_order;  ///< [T'], likewise
    std::vector<std::uint32_t> triangles;       ///< [3 T'], T' padded for each cloth to APSLK_TRIANGLE_ALIGNMENT
    std::vector<std::uint32_t> corner_offsets;  ///< [V + 1]
    std::vector<std::uint32_t> corners;         ///< [3 T], 4 · triangle + corner number
    std::vector<std::uint32_t> row_offsets;     ///< [T' + 1], empty without a pattern
    std::vector<std::uint32_t> columns;
    std::vector<std::uint8_t> shared;
    std::vector<cl_uint2> patches;               ///< first triangle and first patch vertex; one more closes a cloth's
    std::vector<std::uint32_t> patch_vertices;   ///< places of vertices
    std::vector<std::uint16_t> local_triangles;  ///< [3 T'], as numbers in the patch's vertices
    std::vector<cl_uint4> hinges;                ///< [H], places of vertices; none where nothing bends
    std::vector<std::uint32_t> hinge_offsets;    ///< [cloths + 1], the first hinge of each
    std::vector<std::uint32_t> hinge_order;      ///< [H], place -> place in the caller's arrays
    std::vector<std::uint32_t> hinge_corner_offsets;  ///< [V + 1]
    std::vector<std::uint32_t> hinge_corners;         ///< [4 H], 4 · hinge + number of the vertex in it
    std::uint32_t max_patch_vertices = 1;
    std::uint32_t vertex_count = 0;     ///< V
    std::uint32_t triangle_count = 0;   ///< T', padding included
    std::uint32_t rest_area_count = 0;  ///< T, of the caller's arrays
};

/// `with_pattern`: also the CSR pattern of `matrix`. `with_hinges`: also the hinges. Throws Error(invalid_argument)
/// where the cloths together exceed 32-bit indices.
Adjacency build_adjacency(std::span<const std::shared_ptr<const Topology>> cloths, Matrix matrix, bool with_pattern,
                          bool with_hinges, std::uint32_t patch_triangles);

}  // namespace apsl::host

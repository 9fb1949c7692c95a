// SPDX-License-Identifier: MIT
#pragma once

#include "device_facts.hpp"

#include <apsl/strain_limiter.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace apsl::host {

/// Triangles of the largest cloth.
std::size_t largest_triangle_count(std::span<const std::shared_ptr<const Topology>> cloths);

/// Options with every zero and every `automatic` replaced by what suits the device and the cloths. Throws
/// Error(invalid_argument) for options out of range, Error(unsupported) for what the device cannot do.
Options resolve(Options options, const DeviceFacts& facts, std::span<const std::shared_ptr<const Topology>> cloths);

/// Whether the matrix's CSR pattern is needed.
bool uses_pattern(const Options& options);

/// The files of kernels/ that the options need, and no others.
std::vector<std::string_view> kernel_files(const Options& options);

/// Vertices of a patch to compile for, from those of the largest: rounded up, so that a mesh whose topology changes
/// a little needs no other program. On a CPU, where local memory is ordinary memory and only what is touched of it
/// costs, nearly all meshes get the same room, so that what a driver's cache holds of one mesh's program serves the
/// next.
std::uint32_t room_for_patches(const DeviceFacts& facts, std::uint32_t largest);

/// `patch_vertices`: what a patch has room for.
std::string build_options(const Options& options, std::uint32_t patch_vertices);

/// Triangles a patch at most. On a CPU a patch's gradients and forces stay in the first cache; on a GPU a patch is two
/// triangles a work-item. Small cloths are cut finer, so that every compute unit has patches.
std::uint32_t patch_triangles(const DeviceFacts& facts, const Options& options, std::size_t largest);

/// Work-groups a launch for cloths of up to `largest` triangles or vertices: enough to fill the device and to share the
/// load, few enough that every group can sum all groups' partial results itself. 1 with Execution::one_group.
std::uint32_t group_count(const DeviceFacts& facts, const Options& options, std::uint32_t largest);

}  // namespace apsl::host

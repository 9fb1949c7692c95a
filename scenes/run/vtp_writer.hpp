// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"

#include <filesystem>
#include <span>

namespace apsl::scenes {

/// One frame for ParaView and VTK: XML PolyData with raw appended arrays: 64-bit points, cell data `area_change` ([T],
/// as in FrameReport), point data `velocity` (m/s, [V]). Throws InputError where the file cannot be written.
void write_vtp(const std::filesystem::path& file, const ClothState& cloth, std::span<const double> area_changes);

/// Names the frames of a sequence for ParaView, with their times: `frames` files frame_0000.vtp and so on in the folder
/// of `file`, `seconds_per_frame` s apart.
void write_pvd(const std::filesystem::path& file, int frames, double seconds_per_frame);

/// "frame_0007.vtp".
std::filesystem::path vtp_name(int frame);

}  // namespace apsl::scenes

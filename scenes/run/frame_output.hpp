// SPDX-License-Identifier: MIT
#pragma once

#include "run/blender_writer.hpp"
#include "run/input_files.hpp"

#include <filesystem>
#include <span>

namespace apsl::scenes {

/// What `--out DIR` leaves behind: frame_0000.vtp ... and cloth.pvd for ParaView, cloth.obj and cloth.pc2 for Blender.
/// Frames stand as soon as they are written; what names them all appears when the run is over.
class FrameOutput {
public:
    /// Takes out what an earlier run left under these names, report.json too, so that nothing old mixes with the new.
    FrameOutput(std::filesystem::path folder, const ClothState& cloth, double seconds_per_frame);

    void add_frame(const ClothState& cloth, std::span<const double> area_changes);
    void finish();

private:
    std::filesystem::path folder_;
    double seconds_per_frame_;
    int frames_ = 0;
    PointCache point_cache_;
};

/// Throws InputError where FrameOutput and the report beside it would take out or overwrite an input in `folder`.
void check_no_input_in(const std::filesystem::path& folder, std::span<const InputFile> inputs);

/// Throws InputError where a report at `report` would take the place of one of FrameOutput's files in `folder`.
void check_report_apart(const std::filesystem::path& report, const std::filesystem::path& folder);

}  // namespace apsl::scenes

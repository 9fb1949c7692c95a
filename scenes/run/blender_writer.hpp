// SPDX-License-Identifier: MIT
#pragma once

#include "pipeline/cloth_state.hpp"
#include "run/whole_file.hpp"

#include <cstdint>
#include <filesystem>

namespace apsl::scenes {

/// The cloth at rest as Wavefront OBJ. Throws InputError where the file cannot be written.
void write_rest_obj(const std::filesystem::path& file, const ClothState& cloth);

/// A PC2 point cache: the places of all vertices, frame by frame, 32-bit floats. Blender plays it on the OBJ by a Mesh
/// Cache modifier. Sample 0 belongs to frame 0 of the report.
class PointCache {
public:
    PointCache(const std::filesystem::path& file, const ClothState& cloth);

    void add_frame(const ClothState& cloth);
    /// Enters the number of frames and puts the file in its place.
    void commit();

private:
    WholeFile file_;
    std::int32_t samples_ = 0;
};

}  // namespace apsl::scenes

// SPDX-License-Identifier: MIT
#include "run/blender_writer.hpp"

#include <limits>
#include <sstream>
#include <string_view>
#include <vector>

namespace apsl::scenes {

void write_rest_obj(const std::filesystem::path& file, const ClothState& cloth) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    for (std::size_t k = 0; k < cloth.rest_positions.size(); k += 3) {
        text << "v " << cloth.rest_positions[k] << ' ' << cloth.rest_positions[k + 1] << ' '
             << cloth.rest_positions[k + 2] << '\n';
    }
    for (const Triangle& triangle : cloth.topology->triangles())
        text << "f " << triangle[0] + 1 << ' ' << triangle[1] + 1 << ' ' << triangle[2] + 1 << '\n';
    WholeFile output(file);
    output.write(text.str());
    output.commit();
}

// Header of the format: name, version, vertices, first frame, frames a sample, samples; numbers are little-endian.
PointCache::PointCache(const std::filesystem::path& file, const ClothState& cloth) : file_(file) {
    file_.write(std::string_view("POINTCACHE2\0", 12));
    file_.write_value(std::int32_t{1});
    file_.write_value(static_cast<std::int32_t>(cloth.topology->vertex_count()));
    file_.write_value(0.0f);
    file_.write_value(1.0f);
    file_.write_value(samples_);
}

void PointCache::add_frame(const ClothState& cloth) {
    const std::vector<float> points(cloth.positions.begin(), cloth.positions.end());
    file_.write({reinterpret_cast<const char*>(points.data()), points.size() * sizeof(float)});
    ++samples_;
}

void PointCache::commit() {
    constexpr std::int64_t samples_offset = 28;
    file_.overwrite(samples_offset, {reinterpret_cast<const char*>(&samples_), sizeof samples_});
    file_.commit();
}

}  // namespace apsl::scenes

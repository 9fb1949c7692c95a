// SPDX-License-Identifier: MIT
#include "run/vtp_writer.hpp"

#include "pipeline/measures.hpp"
#include "run/whole_file.hpp"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace apsl::scenes {
namespace {

// The arrays of one file: their tags, which name an offset, and the bytes that lie there, each array after its size.
class AppendedArrays {
public:
    template <class Value>
    std::string add(const std::string& name, const std::string& type, int components,
                    const std::vector<Value>& values) {
        const std::string tag = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                                std::to_string(components) + "\" format=\"appended\" offset=\"" +
                                std::to_string(bytes_.size()) + "\"/>\n";
        const std::uint64_t size = values.size() * sizeof(Value);
        bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
        bytes_.append(reinterpret_cast<const char*>(values.data()), size);
        return tag;
    }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

}  // namespace

std::filesystem::path vtp_name(int frame) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "frame_%04d.vtp", frame);
    return name.data();
}

void write_vtp(const std::filesystem::path& file, const ClothState& cloth, std::span<const double> area_changes) {
    const Topology& topology = *cloth.topology;
    std::vector<std::int64_t> connectivity;
    std::vector<std::int64_t> offsets;
    for (const Triangle& triangle : topology.triangles()) {
        connectivity.insert(connectivity.end(), triangle.begin(), triangle.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    }
    const std::vector<float> velocities(cloth.velocities.begin(), cloth.velocities.end());
    const std::vector<float> changes(area_changes.begin(), area_changes.end());

    std::vector<float> stretches;
    for (const PrincipalStretch& stretch : principal_stretches(cloth))
        stretches.push_back(static_cast<float>(stretch.max));

    AppendedArrays arrays;
    const char* byte_order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
    std::string text =
        std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"") + byte_order +
        "\" header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" + std::to_string(topology.vertex_count()) +
        "\" NumberOfPolys=\"" + std::to_string(topology.triangle_count()) + "\">\n";
    text += "<PointData Vectors=\"velocity\">\n" + arrays.add("velocity", "Float32", 3, velocities) + "</PointData>\n";
    text += "<CellData Scalars=\"area_change\">\n" + arrays.add("area_change", "Float32", 1, changes) +
            arrays.add("principal_stretch", "Float32", 1, stretches) + "</CellData>\n";
    text += "<Points>\n" + arrays.add("Points", "Float64", 3, cloth.positions) + "</Points>\n";
    text += "<Polys>\n" + arrays.add("connectivity", "Int64", 1, connectivity) +
            arrays.add("offsets", "Int64", 1, offsets) + "</Polys>\n";
    text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

    WholeFile output(file);
    output.write(text);
    output.write(arrays.bytes());
    output.write("\n</AppendedData>\n</VTKFile>\n");
    output.commit();
}

void write_pvd(const std::filesystem::path& file, int frames, double seconds_per_frame) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
    for (int frame = 0; frame < frames; ++frame) {
        // A frame shows the cloth at its end.
        text << "<DataSet timestep=\"" << (frame + 1) * seconds_per_frame << "\" file=\"" << vtp_name(frame).string()
             << "\"/>\n";
    }
    text << "</Collection>\n</VTKFile>\n";
    WholeFile output(file);
    output.write(text.str());
    output.commit();
}

}  // namespace apsl::scenes

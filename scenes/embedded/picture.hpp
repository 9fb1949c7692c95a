// SPDX-License-Identifier: MIT
#pragma once

#include "mesh.hpp"

#include <filesystem>
#include <fstream>
#include <iomanip>
#include <stdexcept>
#include <string>
#include <vector>

/// Writes folder/frame_N.vtp, the cloth with the area change of each triangle, and folder/cloth.pvd, the index that
/// scenes/pictures/render.py opens. Throws std::runtime_error.
inline void write_picture(const std::filesystem::path& folder, int frame, const SquareMesh& rest,
                          const std::vector<float>& positions) {
    const apsl::Topology& topology = *rest.topology;
    const std::string name = "frame_" + std::to_string(frame) + ".vtp";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "cloth.pvd") << "<VTKFile type=\"Collection\"><Collection>"
                                           "<DataSet timestep=\"0\" file=\""
                                        << name << "\"/></Collection></VTKFile>\n";
    std::ofstream file(folder / name);
    file << "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"" << topology.vertex_count()
         << "\" NumberOfPolys=\"" << topology.triangle_count() << "\">\n<Points><DataArray type=\"Float32\" "
         << "Name=\"positions\" NumberOfComponents=\"3\" format=\"ascii\">\n"
         << std::setprecision(9);
    for (const float x : positions) file << x << ' ';
    file << "</DataArray></Points>\n<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
    for (const apsl::Triangle& t : topology.triangles()) file << t[0] << ' ' << t[1] << ' ' << t[2] << ' ';
    file << "</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    for (std::size_t end = 3; end <= 3 * topology.triangle_count(); end += 3) file << end << ' ';
    file << "</DataArray></Polys>\n<CellData><DataArray type=\"Float32\" Name=\"area_change\" format=\"ascii\">\n";
    for (const apsl::Triangle& t : topology.triangles())
        file << std::abs(area(positions, t) / area(rest.positions, t) - 1.0f) << ' ';
    file << "</DataArray></CellData></Piece></PolyData></VTKFile>\n";
    if (!file.flush()) throw std::runtime_error((folder / name).string() + ": cannot be written");
}

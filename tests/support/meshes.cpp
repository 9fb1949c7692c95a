// SPDX-License-Identifier: MIT
#include "support/meshes.hpp"

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>

namespace apsl::test {

Mesh grid(std::uint32_t columns, std::uint32_t rows, double size_x, double size_z, Diagonals diagonals,
          std::uint32_t seed) {
    Mesh mesh;
    mesh.positions.reserve(std::size_t{3} * columns * rows);
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            mesh.positions.push_back(size_x * (c / (columns - 1.0) - 0.5));
            mesh.positions.push_back(0.0);
            mesh.positions.push_back(size_z * (r / (rows - 1.0) - 0.5));
        }
    std::mt19937 random(seed);
    mesh.triangles.reserve(std::size_t{2} * (columns - 1) * (rows - 1));
    for (std::uint32_t r = 0; r + 1 < rows; ++r)
        for (std::uint32_t c = 0; c + 1 < columns; ++c) {
            const std::uint32_t v = r * columns + c;
            const bool turned = (diagonals == Diagonals::alternating && (r + c) % 2 == 1) ||
                                (diagonals == Diagonals::random && random() % 2 == 1);
            if (turned) {
                mesh.triangles.push_back({v, v + columns, v + columns + 1});
                mesh.triangles.push_back({v, v + columns + 1, v + 1});
            } else {
                mesh.triangles.push_back({v, v + columns, v + 1});
                mesh.triangles.push_back({v + 1, v + columns, v + columns + 1});
            }
        }
    return mesh;
}

Mesh right_triangle() {
    return {{{0, 1, 2}}, {0, 0, 0, 2, 0, 0, 0, 1, 0}};
}

Mesh tetrahedron() {
    return {{{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}, {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1}};
}

Mesh book(std::uint32_t pages) {
    Mesh mesh{{}, {0, 0, 0, 0, 0, 1}};
    for (std::uint32_t p = 0; p < pages; ++p) {
        const double angle = 2.0 * std::numbers::pi * p / pages;
        mesh.positions.insert(mesh.positions.end(), {std::cos(angle), std::sin(angle), 0.5});
        mesh.triangles.push_back({0, 1, p + 2});
    }
    return mesh;
}

Mesh fan(std::uint32_t blades) {
    Mesh mesh{{}, {0, 0, 0}};
    for (std::uint32_t b = 0; b <= blades; ++b) {
        const double angle = std::numbers::pi * 25.0 / 180.0 * b;
        mesh.positions.insert(mesh.positions.end(), {std::cos(angle), std::sin(angle), 0.0});
        if (b > 0) mesh.triangles.push_back({0, b, b + 1});
    }
    return mesh;
}

Mesh together(const Mesh& first, const Mesh& second) {
    Mesh mesh = first;
    const auto offset = static_cast<std::uint32_t>(first.vertex_count());
    for (const Triangle& t : second.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    for (std::size_t n = 0; n < second.positions.size(); ++n)
        mesh.positions.push_back(second.positions[n] + (n % 3 == 0 ? 10.0 : 0.0));
    return mesh;
}

std::vector<double> wavy(const std::vector<double>& positions, double amplitude, std::uint32_t seed) {
    std::mt19937 random(seed);
    // Not std::uniform_real_distribution: its results differ between standard libraries.
    const auto jitter = [&] { return 0.1 * amplitude * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
    std::vector<double> result(positions);
    for (std::size_t v = 0; v < positions.size() / 3; ++v) {
        const double x = positions[3 * v];
        const double z = positions[3 * v + 2];
        result[3 * v] += jitter();
        result[3 * v + 1] += amplitude * std::sin(7.0 * x + 0.3) * std::cos(5.0 * z) + jitter();
        result[3 * v + 2] += jitter();
    }
    return result;
}

Mesh read_obj(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    Mesh mesh;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            double x = 0.0;
            double y = 0.0;
            double z = 0.0;
            words >> x >> y >> z;
            mesh.positions.insert(mesh.positions.end(), {x, y, z});
        } else if (word == "f") {
            std::vector<std::uint32_t> polygon;
            // Each corner reads vertex/texture/normal; stoul stops at the first slash.
            while (words >> word) polygon.push_back(static_cast<std::uint32_t>(std::stoul(word) - 1));
            for (std::size_t k = 2; k < polygon.size(); ++k)
                mesh.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
        }
    }
    return mesh;
}

}  // namespace apsl::test

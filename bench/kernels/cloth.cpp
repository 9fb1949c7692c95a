// SPDX-License-Identifier: MIT
#include "cloth.hpp"

#include <apsl/reference.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <stdexcept>

namespace apsl::bench {
namespace {

constexpr double density = 0.2;  // kg/m²

struct Surface {
    std::vector<Triangle> triangles;
    std::vector<double> positions;  // [3V], at rest
};

Surface grid(std::uint32_t columns, std::uint32_t rows) {
    Surface surface;
    const double cell = 1.0 / (std::max(columns, rows) - 1.0);
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c)
            surface.positions.insert(surface.positions.end(), {cell * c, 0.0, cell * r});
    for (std::uint32_t r = 0; r + 1 < rows; ++r)
        for (std::uint32_t c = 0; c + 1 < columns; ++c) {
            const std::uint32_t v = r * columns + c;
            if ((r + c) % 2 == 1) {
                surface.triangles.push_back({v, v + columns, v + columns + 1});
                surface.triangles.push_back({v, v + columns + 1, v + 1});
            } else {
                surface.triangles.push_back({v, v + columns, v + 1});
                surface.triangles.push_back({v + 1, v + columns, v + columns + 1});
            }
        }
    return surface;
}

Surface read_obj(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be read");
    Surface surface;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "v") {
            double x = 0.0, y = 0.0, z = 0.0;
            words >> x >> y >> z;
            surface.positions.insert(surface.positions.end(), {x, y, z});
        } else if (word == "f") {
            std::vector<std::uint32_t> polygon;
            // Each corner reads vertex/texture/normal; stoul stops at the first slash.
            while (words >> word) polygon.push_back(static_cast<std::uint32_t>(std::stoul(word) - 1));
            for (std::size_t k = 2; k < polygon.size(); ++k)
                surface.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
        }
    }
    // 1 m tall, as the scenes have it.
    double lowest = surface.positions.at(1), highest = lowest;
    for (std::size_t n = 1; n < surface.positions.size(); n += 3) {
        lowest = std::min(lowest, surface.positions[n]);
        highest = std::max(highest, surface.positions[n]);
    }
    for (double& x : surface.positions) x /= highest - lowest;
    return surface;
}

double mean_edge(const Topology& topology, const std::vector<double>& positions) {
    double sum = 0.0;
    for (const VertexPair& edge : topology.edges()) {
        double squared = 0.0;
        for (std::size_t d = 0; d < 3; ++d) {
            const double difference = positions[3 * edge[1] + d] - positions[3 * edge[0] + d];
            squared += difference * difference;
        }
        sum += std::sqrt(squared);
    }
    return sum / static_cast<double>(topology.edges().size());
}

/// Stretched and compressed by 3 % in waves of 16 edges, whatever the mesh, so that CG has as far to reach on a fine
/// mesh as on a coarse one; waved out of its plane, and each vertex off by a little.
std::vector<double> stretched(const Topology& topology, const std::vector<double>& rest) {
    std::mt19937 random(1);
    const double edge = mean_edge(topology, rest);
    const double wave_number = 2.0 * std::numbers::pi / (16.0 * edge);
    // Not std::uniform_real_distribution: its results differ between standard libraries.
    const auto jitter = [&] { return 0.01 * edge * (static_cast<double>(random()) / 2147483648.0 - 1.0); };
    std::vector<double> positions(rest.size());
    for (std::size_t v = 0; v < rest.size() / 3; ++v) {
        const double x = rest[3 * v], z = rest[3 * v + 2];
        positions[3 * v] = x + 0.03 / wave_number * std::sin(wave_number * x) + jitter();
        positions[3 * v + 1] = rest[3 * v + 1] + 0.005 * std::sin(7.0 * x + 0.3) * std::cos(5.0 * z) + jitter();
        positions[3 * v + 2] = z + 0.03 / wave_number * std::sin(wave_number * z) + jitter();
    }
    return positions;
}

std::vector<float> in_float(const std::vector<double>& numbers) {
    std::vector<float> result(numbers.size());
    std::transform(numbers.begin(), numbers.end(), result.begin(), [](double x) { return static_cast<float>(x); });
    return result;
}

}  // namespace

Cloth make_cloth(const Mesh& mesh) {
    const Surface surface = mesh.file.empty() ? grid(mesh.columns, mesh.rows) : read_obj(mesh.file);
    Cloth cloth;
    cloth.topology = Topology::build(surface.triangles, surface.positions.size() / 3);
    const std::vector<double> rest_areas = reference::areas<double>(*cloth.topology, surface.positions);
    std::vector<double> inverse_masses = reference::inverse_masses<double>(*cloth.topology, rest_areas, density);
    inverse_masses.front() = 0.0;
    inverse_masses[mesh.file.empty() ? mesh.columns - 1 : inverse_masses.size() - 1] = 0.0;
    cloth.positions = in_float(stretched(*cloth.topology, surface.positions));
    cloth.inverse_masses = in_float(inverse_masses);
    cloth.rest_areas = in_float(rest_areas);
    return cloth;
}

}  // namespace apsl::bench

// SPDX-License-Identifier: MIT
#include "run/weld.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>

namespace apsl::scenes {
namespace {

/// A cube of space, eight times the distance wide: what lies within the distance of a vertex mostly lies in one of
/// them, at most in eight.
using Cell = std::array<double, 3>;  // whole numbers, as doubles so that no place is too far away

struct CellHash {
    std::size_t operator()(const Cell& cell) const {
        std::uint64_t hash = 0;
        for (const double coordinate : cell) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 32;
        }
        return static_cast<std::size_t>(hash);
    }
};

// + 0.0: −0 and 0 are one cell.
double cell_coordinate(double coordinate, double width) {
    return std::floor(coordinate / width) + 0.0;
}

bool within(std::span<const double> positions, std::size_t a, std::size_t b, double distance) {
    return std::hypot(positions[3 * a] - positions[3 * b], positions[3 * a + 1] - positions[3 * b + 1],
                      positions[3 * a + 2] - positions[3 * b + 2]) <= distance;
}

}  // namespace

std::vector<std::uint32_t> first_within(std::span<const double> positions, double distance) {
    constexpr std::uint32_t none = ~0u;
    const std::size_t vertex_count = positions.size() / 3;
    const double width = 8.0 * distance;
    std::unordered_map<Cell, std::uint32_t, CellHash> newest;  // of a cell; the others follow in `older`
    std::vector<std::uint32_t> older(vertex_count, none);
    std::vector<std::uint32_t> first(vertex_count);
    newest.reserve(vertex_count);
    for (std::size_t v = 0; v < vertex_count; ++v) {
        Cell low, high;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            low[axis] = cell_coordinate(positions[3 * v + axis] - distance, width);
            high[axis] = cell_coordinate(positions[3 * v + axis] + distance, width);
        }
        std::uint32_t found = none;
        for (unsigned corner = 0; corner < 8; ++corner) {
            Cell cell = low;
            bool is_new = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (((corner >> axis) & 1) == 0) continue;
                cell[axis] = high[axis];
                is_new = is_new && high[axis] != low[axis];
            }
            if (!is_new) continue;
            const auto entry = newest.find(cell);
            for (std::uint32_t u = entry == newest.end() ? none : entry->second; u != none; u = older[u])
                if (u < found && within(positions, u, v, distance)) found = u;
        }
        first[v] = found == none ? static_cast<std::uint32_t>(v) : found;
        if (found != none) continue;
        Cell home;
        for (std::size_t axis = 0; axis < 3; ++axis) home[axis] = cell_coordinate(positions[3 * v + axis], width);
        const auto [entry, is_new] = newest.try_emplace(home, static_cast<std::uint32_t>(v));
        if (!is_new) older[v] = std::exchange(entry->second, static_cast<std::uint32_t>(v));
    }
    return first;
}

std::vector<std::uint32_t> weld(PolygonMesh& mesh, double distance) {
    std::vector<std::uint32_t> number = first_within(mesh.positions, distance);
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
        if (number[v] != v) {
            number[v] = number[number[v]];  // an earlier one, numbered anew already
            continue;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) mesh.positions[3 * kept + axis] = mesh.positions[3 * v + axis];
        number[v] = kept++;
    }
    mesh.positions.resize(std::size_t{3} * kept);
    for (std::uint32_t& vertex : mesh.vertices) vertex = number[vertex];
    return number;
}

}  // namespace apsl::scenes

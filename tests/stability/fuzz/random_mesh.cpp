// SPDX-License-Identifier: MIT
#include "stability/fuzz/random_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace apsl::test {
namespace {

Mesh random_grid(Random& random) {
    const auto diagonals = random.one_of({Diagonals::uniform, Diagonals::alternating, Diagonals::random});
    return grid(random.from_to(2, 12), random.from_to(2, 12), random.number(0.3, 1.0), random.number(0.3, 1.0),
                diagonals, random.from_to(1, 1000));
}

// Rolled up along x and sewn together.
Mesh tube(std::uint32_t around, std::uint32_t rings) {
    Mesh mesh;
    for (std::uint32_t r = 0; r < rings; ++r)
        for (std::uint32_t s = 0; s < around; ++s) {
            const double angle = 2.0 * std::numbers::pi * s / around;
            mesh.positions.insert(mesh.positions.end(),
                                  {0.3 * std::cos(angle), 0.1 * static_cast<double>(r), 0.3 * std::sin(angle)});
        }
    for (std::uint32_t r = 0; r + 1 < rings; ++r)
        for (std::uint32_t s = 0; s < around; ++s) {
            const std::uint32_t v = r * around + s, w = r * around + (s + 1) % around;
            mesh.triangles.push_back({v, v + around, w});
            mesh.triangles.push_back({w, v + around, w + around});
        }
    return mesh;
}

// Any three vertices: edges with many triangles, triangles named twice, both ways round.
Mesh soup(Random& random) {
    Mesh mesh;
    const std::uint32_t vertices = random.from_to(3, 60);
    for (std::uint32_t n = 0; n < 3 * vertices; ++n) mesh.positions.push_back(random.number(-0.5, 0.5));
    for (std::uint32_t t = random.from_to(1, 100); t > 0; --t) {
        const std::uint32_t a = random.from_to(0, vertices - 1);
        const std::uint32_t b = (a + random.from_to(1, vertices - 1)) % vertices;
        std::uint32_t c = random.from_to(0, vertices - 1);
        while (c == a || c == b) c = (c + 1) % vertices;
        mesh.triangles.push_back({a, b, c});
    }
    return mesh;
}

Mesh one_piece(Random& random) {
    switch (random.below(8)) {
        case 0:
            return tube(random.from_to(3, 16), random.from_to(2, 8));
        case 1:
            return fan(random.from_to(1, 14));
        case 2:
            return book(random.from_to(1, 12));
        case 3:
            return soup(random);
        case 4:
            return random.chance(0.5) ? tetrahedron() : right_triangle();
        case 5: {
            Mesh mesh = random_grid(random);  // with holes
            std::erase_if(mesh.triangles, [&](const Triangle&) { return random.chance(0.25); });
            if (mesh.triangles.empty()) mesh.triangles.push_back({0, 1, 2});
            return mesh;
        }
        default:
            return random_grid(random);
    }
}

}  // namespace

Mesh random_mesh(Random& random) {
    Mesh mesh = random.chance(0.15) ? together(one_piece(random), one_piece(random)) : one_piece(random);
    if (random.chance(0.15))
        for (std::uint32_t n = 3 * random.from_to(1, 3); n > 0; --n) mesh.positions.push_back(random.number(-1.0, 1.0));
    return mesh;
}

Mesh loose_triangles(std::uint32_t count) {
    Mesh mesh;
    for (std::uint32_t t = 0; t < count; ++t) {
        const double x = 0.1 * static_cast<double>(t % 20), z = 0.1 * static_cast<double>(t / 20);
        mesh.positions.insert(mesh.positions.end(), {x, 0.0, z, x, 0.0, z + 0.08, x + 0.08, 0.0, z});
        mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    return mesh;
}

}  // namespace apsl::test

// SPDX-License-Identifier: MIT
// Edges, unit normal, area and diagonal entry of a triangle. Reference: apsl::reference, geometry.
#ifndef APSLK_TRIANGLE_GEOMETRY_H
#define APSLK_TRIANGLE_GEOMETRY_H

#include "lanes.h"

typedef struct {
    lanes4 edge[3];         // the one opposite each corner
    lanes inverse_mass[3];  // of each corner, 1/kg
    lanes4 normal;          // unit, or zero where the triangle has no area
    lanes area;             // m²
    lanes diagonal;         // Eq. (3): D = ½ Σ w |e|², m²/kg
} apslk_triangle_geometry;

APSLK_INLINE apslk_triangle_geometry triangle_geometry(lanes4 x0, lanes4 x1, lanes4 x2) {
    apslk_triangle_geometry t;
    t.edge[0] = minus(x2, x1);
    t.edge[1] = minus(x0, x2);
    t.edge[2] = minus(x1, x0);
    t.inverse_mass[0] = x0.w;
    t.inverse_mass[1] = x1.w;
    t.inverse_mass[2] = x2.w;
    const lanes4 doubled = cross_product(t.edge[2], minus(x2, x0));
    const lanes length_of_doubled = sqrt(squared_length(doubled));
    const lanes inverse_length = select((lanes)(0.0f), 1.0f / length_of_doubled, length_of_doubled > 0.0f);
    t.normal.x = doubled.x * inverse_length;
    t.normal.y = doubled.y * inverse_length;
    t.normal.z = doubled.z * inverse_length;
    t.normal.w = 0.0f;
    t.area = 0.5f * length_of_doubled;
    t.diagonal = 0.5f * (t.inverse_mass[0] * squared_length(t.edge[0]) + t.inverse_mass[1] * squared_length(t.edge[1]) +
                         t.inverse_mass[2] * squared_length(t.edge[2]));
    return t;
}

APSLK_INLINE apslk_triangle_geometry load_triangles(__global const uint* triangles, __global const float4* moved,
                                                    uint first) {
    return triangle_geometry(load_corner_vertices(triangles, moved, first, 0),
                             load_corner_vertices(triangles, moved, first, 1),
                             load_corner_vertices(triangles, moved, first, 2));
}

#endif

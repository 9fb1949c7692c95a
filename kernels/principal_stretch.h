// SPDX-License-Identifier: MIT
// The greatest principal stretch of a triangle against its rest shape: the greatest singular value s₁ of the
// deformation gradient F = [x₁ − x₀, x₂ − x₀] M, in closed form. Reference: apsl::reference::principal_stretch.
#ifndef APSLK_PRINCIPAL_STRETCH_H
#define APSLK_PRINCIPAL_STRETCH_H

#include "lanes.h"
#include "layout.h"
#include "triangle_geometry.h"

typedef struct {
    lanes m00, m01, m11;  // 1/m; zero where there is no ceiling
    lanes ceiling;        // 0: none
} apslk_rest_shape;

typedef struct {
    lanes value;                   // s₁
    lanes material_x, material_y;  // v₁, of length 1
    lanes4 spatial;                // u₁, of length 1; zero where s₁ is
} apslk_principal_stretch;

// `rest`: the limiter's rest values, run by run.
APSLK_INLINE apslk_rest_shape load_rest_shape(apslk_cloth cloth, __global const float* rest, uint first) {
    apslk_rest_shape shape;
    shape.m00 = load_lanes(rest + APSLK_REST_SHAPE_00 * cloth.run, first);
    shape.m01 = load_lanes(rest + APSLK_REST_SHAPE_01 * cloth.run, first);
    shape.m11 = load_lanes(rest + APSLK_REST_SHAPE_11 * cloth.run, first);
    shape.ceiling = load_lanes(rest + APSLK_CEILING * cloth.run, first);
    return shape;
}

// a p + b q.
APSLK_INLINE lanes4 combined(lanes a, lanes4 p, lanes b, lanes4 q) {
    lanes4 sum;
    sum.x = a * p.x + b * q.x;
    sum.y = a * p.y + b * q.y;
    sum.z = a * p.z + b * q.z;
    sum.w = 0.0f;
    return sum;
}

APSLK_INLINE lanes4 scaled(lanes a, lanes4 p) {
    lanes4 product;
    product.x = a * p.x;
    product.y = a * p.y;
    product.z = a * p.z;
    product.w = 0.0f;
    return product;
}

APSLK_INLINE lanes scalar_product(lanes4 a, lanes4 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

APSLK_INLINE apslk_principal_stretch principal_stretch(apslk_triangle_geometry t, apslk_rest_shape shape) {
    // x₁ − x₀ is edge 2 and x₂ − x₀ less edge 1.
    const lanes4 f0 = scaled(shape.m00, t.edge[2]);
    const lanes4 f1 = combined(shape.m01, t.edge[2], -shape.m11, t.edge[1]);
    // FᵀF = [p q; q r]: its eigenvalues are mean ± radius, and twice the angle of v₁ is that of (half, q).
    const lanes p = squared_length(f0), q = scalar_product(f0, f1), r = squared_length(f1);
    const lanes mean = 0.5f * (p + r), half_width = 0.5f * (p - r);
    const lanes radius = sqrt(half_width * half_width + q * q);
    const lanes cosine = select((lanes)(1.0f), half_width / radius, radius > 0.0f);
    apslk_principal_stretch stretch;
    stretch.value = sqrt(mean + radius);
    stretch.material_x = sqrt(fmax(0.5f + 0.5f * cosine, (lanes)(0.0f)));
    stretch.material_y = copysign(sqrt(fmax(0.5f - 0.5f * cosine, (lanes)(0.0f))), q);
    const lanes inverse = select((lanes)(0.0f), 1.0f / stretch.value, stretch.value > 0.0f);
    stretch.spatial = combined(inverse * stretch.material_x, f0, inverse * stretch.material_y, f1);
    return stretch;
}

// max(0, s₁ − ceiling); 0 where there is none.
APSLK_INLINE lanes stretch_excess(lanes stretch, lanes ceiling) {
    const lanes excess = stretch - ceiling;
    return select(select(excess, (lanes)(0.0f), excess < 0.0f), (lanes)(0.0f), ceiling == 0.0f);  // a NaN stays
}

#endif

// SPDX-License-Identifier: MIT
// The second row of a triangle: its greatest principal stretch s₁ is to end at or below a ceiling c. With C = A⁰ (s₁ −
// c) and ∂C/∂x_k = A⁰ (v₁·b_k) u₁, the row is what this demands beyond the triangle's area row: r = ⟨∇C, ∇A⟩ / ⟨∇A, ∇A⟩
// times that is taken off (docs/formulation.md, Stretch ceiling).
// Reference: apsl::reference, stretch_rows and stretch_limiting.
#ifndef APSLK_STRETCH_ROWS_H
#define APSLK_STRETCH_ROWS_H

#include "gradients.h"
#include "layout.h"
#include "principal_stretch.h"

// One kind of row of APSLK_LANES triangles, with doubled gradients g = 2 ∂C/∂x, as those of areas are.
typedef struct {
    lanes4 gradient[3];
    lanes value;  // what a sub-step is to take of it
    lanes share;  // r
} apslk_stretch_row;

// ½ w g·g of a corner, of the plain row with itself and with the area row.
typedef struct {
    lanes size, mixed;
} apslk_row_products;

// `length`: of the plain row's gradient at the corner, along `spatial`.
APSLK_INLINE apslk_row_products row_products(lanes inverse_mass, lanes length, lanes4 spatial, lanes4 area_gradient) {
    apslk_row_products products;
    products.size = 0.5f * inverse_mass * length * length;
    products.mixed = 0.5f * inverse_mass * length * scalar_product(spatial, area_gradient);
    return products;
}

APSLK_INLINE lanes4 zero_unless(lanes_int condition, lanes4 v) {
    v.x = select((lanes)(0.0f), v.x, condition);
    v.y = select((lanes)(0.0f), v.y, condition);
    v.z = select((lanes)(0.0f), v.z, condition);
    return v;
}

APSLK_INLINE lanes unless_pinned(lanes value, lanes inverse_mass) {
    return select((lanes)(0.0f), value, inverse_mass > 0.0f);
}

// The excess over a ceiling that the next of `small_steps` sub-steps lets stand, from what this one lets stand and what
// there is before it, and was at the start of the step. `asked_again`: a step (excess_asked_again).
APSLK_INLINE lanes next_held_excess(lanes held, lanes excess, lanes start, int small_steps, float asked_again) {
    const float part = 1.0f / (float)small_steps;
    const lanes could_not = excess - APSLK_EXCESS_TAKEN * (excess - held) - asked_again * part;
    return fmax(exp(-APSLK_EXCESS_LEAD * part) * held, fmin(could_not, start));
}

// What a row is asked for of its demand `value`, where of its |∇C|² `size` this much is `left` beyond the area row, or
// to corners that can move: all of it, or, of a weak row, less. Where next to nothing is left no motion brings the
// triangle below its ceiling and keeps its area, and the one that is asked for goes far, to the side.
APSLK_INLINE lanes asked_of_row(lanes value, lanes left, lanes size) {
    const lanes share = fmin(left / (APSLK_WEAK_ROW_SHARE * size), 1.0f);
    return fmin(value, share * share * value);
}

// Likewise an area row of its right-hand side `excess`, where one corner is pinned or more. Pins that come near to one
// another leave the other corner a short edge: it would have to go far to mend the area.
APSLK_INLINE lanes asked_of_area_row(apslk_triangle_geometry t, lanes rest_area, lanes excess) {
    // |2 ∂A/∂x| is the length of the edge.
    const lanes movable = 0.25f * (unless_pinned(squared_length(t.edge[0]), t.inverse_mass[0]) +
                                   unless_pinned(squared_length(t.edge[1]), t.inverse_mass[1]) +
                                   unless_pinned(squared_length(t.edge[2]), t.inverse_mass[2]));
    const lanes share = fmin(movable / (APSLK_WEAK_AREA_ROW_SHARE * rest_area), 1.0f);
    const lanes least = fmin(t.inverse_mass[0], fmin(t.inverse_mass[1], t.inverse_mass[2]));
    return select(share * share * excess, excess, least > 0.0f);
}

// `stretch`: of the triangles now. What takes no part is zero. `area_excess`: the area row's right-hand side.
// `ceiling`: for this sub-step. Corner by corner, not as a loop: where LLVM unrolls one, it leaves an intrinsic that
// Oclgrind does not have.
APSLK_INLINE apslk_stretch_row stretch_row(apslk_triangle_geometry t, apslk_rest_shape shape,
                                           apslk_principal_stretch stretch, lanes rest_area, lanes area_excess,
                                           lanes ceiling) {
    // 2 A⁰ v₁·b_k.
    const lanes l1 = 2.0f * rest_area * (shape.m00 * stretch.material_x + shape.m01 * stretch.material_y);
    const lanes l2 = 2.0f * rest_area * (shape.m11 * stretch.material_y);
    const lanes l0 = -(l1 + l2);
    const lanes4 a0 = cross_product(t.normal, t.edge[0]), a1 = cross_product(t.normal, t.edge[1]);
    const lanes4 a2 = cross_product(t.normal, t.edge[2]);
    const apslk_row_products p0 = row_products(t.inverse_mass[0], l0, stretch.spatial, a0);
    const apslk_row_products p1 = row_products(t.inverse_mass[1], l1, stretch.spatial, a1);
    const apslk_row_products p2 = row_products(t.inverse_mass[2], l2, stretch.spatial, a2);
    const lanes size = p0.size + p1.size + p2.size, mixed = p0.mixed + p1.mixed + p2.mixed;
    const lanes share = select((lanes)(0.0f), mixed / t.diagonal, t.area > 0.0f && t.diagonal > 0.0f);
    const lanes4 g0 = combined(l0, stretch.spatial, -share, a0), g1 = combined(l1, stretch.spatial, -share, a1);
    const lanes4 g2 = combined(l2, stretch.spatial, -share, a2);
    const lanes left = 0.5f * (t.inverse_mass[0] * squared_length(g0) + t.inverse_mass[1] * squared_length(g1) +
                               t.inverse_mass[2] * squared_length(g2));
    const lanes all = l0 * l0 + l1 * l1 + l2 * l2;
    const lanes movable = unless_pinned(l0 * l0, t.inverse_mass[0]) + unless_pinned(l1 * l1, t.inverse_mass[1]) +
                          unless_pinned(l2 * l2, t.inverse_mass[2]);
    const lanes demand = APSLK_EXCESS_TAKEN * (rest_area * (stretch.value - ceiling) - share * area_excess);
    const lanes value = asked_of_row(demand, fmin(movable * size, all * left), all * size);
    const lanes_int part =
        shape.ceiling > 0.0f && stretch.value > ceiling - APSLK_STRETCH_MARGIN && left > APSLK_LEAST_ROW_SHARE * size;
    apslk_stretch_row row;
    row.value = select((lanes)(0.0f), value, part);
    row.share = select((lanes)(0.0f), share, part);
    row.gradient[0] = zero_unless(part, g0);
    row.gradient[1] = zero_unless(part, g1);
    row.gradient[2] = zero_unless(part, g2);
    return row;
}

#endif

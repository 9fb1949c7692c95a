// SPDX-License-Identifier: MIT
// The angle of two triangles at their common edge, and its gradients (docs/formulation.md, Bending).
// Reference: apsl::reference, hinges.
#ifndef APSLK_HINGES_H
#define APSLK_HINGES_H

#include "layout.h"

// Number of a vertex in its hinge: the two of the edge, then the two opposite.
#define APSLK_HINGE(corner) ((corner) >> 2)
#define APSLK_HINGE_NUMBER(corner) ((corner) & 3u)

// Gradients at the vertices opposite the edge, and in w where along the edge these lie, 0 to 1. Those at the edge's
// vertices follow: a hinge neither pushes nor turns.
typedef struct {
    float4 at_first, at_second;  // ∂θ/∂x, 1/m, times what they are scaled by
} apslk_hinge_gradients;

typedef struct {
    float angle;  // rad, in (−π, π]
    apslk_hinge_gradients gradients;
} apslk_hinge_geometry;

// All zero where one of the triangles has no area.
APSLK_INLINE apslk_hinge_geometry hinge_geometry(float3 e0, float3 e1, float3 o0, float3 o1) {
    const float3 edge = e1 - e0, to_first = o0 - e0, to_second = o1 - e0;
    const float3 n0 = cross(edge, to_first), n1 = cross(to_second, edge);
    const float squared_length = dot(edge, edge), squared0 = dot(n0, n0), squared1 = dot(n1, n1);
    apslk_hinge_geometry hinge = {0.0f, {(float4)(0.0f), (float4)(0.0f)}};
    if (squared_length > 0.0f && squared0 > 0.0f && squared1 > 0.0f) {
        const float length = sqrt(squared_length);
        hinge.angle = atan2(dot(cross(n0, n1), edge) / length, dot(n0, n1));
        hinge.gradients.at_first = (float4)(-length / squared0 * n0, dot(to_first, edge) / squared_length);
        hinge.gradients.at_second = (float4)(-length / squared1 * n1, dot(to_second, edge) / squared_length);
    }
    return hinge;
}

// The share of an opposite vertex's gradient in that of vertex `number`, `along` being where along the edge it lies;
// `own`: its own number.
APSLK_INLINE float share_of_gradient(uint number, uint own, float along) {
    return number == own ? 1.0f : number == 0u ? along - 1.0f : number == 1u ? -along : 0.0f;
}

// ∂θ/∂x of vertex `number`.
APSLK_INLINE float3 hinge_gradient(apslk_hinge_gradients gradients, uint number) {
    return share_of_gradient(number, 2u, gradients.at_first.w) * gradients.at_first.xyz +
           share_of_gradient(number, 3u, gradients.at_second.w) * gradients.at_second.xyz;
}

#endif

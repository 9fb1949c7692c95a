// SPDX-License-Identifier: MIT
// What a vertex touches, and how it is kept outside (docs/formulation.md, Contact). Reference: apsl::reference,
// contact.
#ifndef APSLK_CONTACT_H
#define APSLK_CONTACT_H

#include "layout.h"

#ifndef APSLK_KEEPS_CONTACTS
#define APSLK_KEEPS_CONTACTS 0
#endif

// A vertex at some moment of a step, and how it came there.
typedef struct {
    float3 position;   // m
    float3 motion;     // m, Δt times its velocity
    float3 travelled;  // m, its way since it was last looked at
    bool touches;
} apslk_moving_vertex;

typedef struct {
    float time_step;   // s
    float share_left;  // of the step, to come
    float share;       // of the step, since the vertex was last looked at
} apslk_moment;

// Of a vertex last looked at when the step began.
APSLK_INLINE apslk_moment end_of_the_step(float time_step) {
    const apslk_moment moment = {time_step, 0.0f, 1.0f};
    return moment;
}

APSLK_INLINE float3 along_surface(float3 v, float3 normal) {
    return v - dot(v, normal) * normal;
}

// Out of the body that the vertex touches: to its surface, with no speed into it, and slowed along it by Coulomb
// friction. `contacts`: Buffers::contacts.
APSLK_INLINE apslk_moving_vertex kept_outside(apslk_moving_vertex at, __global const float* contacts, uint vertex,
                                              apslk_moment moment) {
#if APSLK_KEEPS_CONTACTS
    const float4 plane = vload4(2ul * vertex, contacts), surface = vload4(2ul * vertex + 1ul, contacts);
    const float3 normal = plane.xyz, body = moment.time_step * surface.xyz;
    const float depth = plane.w - moment.share_left * dot(normal, body) - dot(normal, at.position);
    at.touches = !(depth <= 0.0f) && any(normal != 0.0f);  // what is not finite ends the call
    if (!at.touches) return at;
    const float3 relative = at.motion - body, slip = along_surface(relative, normal);
    const float into = fmax(-dot(relative, normal), 0.0f);
    const float slipped = sqrt(dot(slip, slip)), most = fmax(surface.w, 0.0f) * into;
    const float rubbed = slipped > most ? most / slipped : 1.0f;
    at.motion += into * normal - rubbed * slip;
    at.position += depth * normal - rubbed * along_surface(at.travelled - moment.share * body, normal);
#else
    (void)contacts;
    (void)vertex;
    (void)moment;
#endif
    return at;
}

#endif

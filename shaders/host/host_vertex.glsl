/* SPDX-License-Identifier: MIT
 * Vertex inputs and the transform that every geometry pass shares: the forward pass tests for equal depth, so
 * all of them must round alike. */
#include "host/host_shared.h"

layout(push_constant) uniform host_push_block
{
    host_push push;
};

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_color;

invariant gl_Position;

vec3 position_from_object()
{
    const vec4 p = vec4(in_position, 1.0);
    return vec3(dot(push.model[0], p), dot(push.model[1], p), dot(push.model[2], p));
}

vec4 clip_from_position(vec3 position)
{
    const vec4 p = vec4(position, 1.0);
    return vec4(dot(push.clip[0], p), dot(push.clip[1], p), dot(push.clip[2], p), dot(push.clip[3], p));
}

vec3 direction_from_object(vec3 d)
{
    return vec3(dot(push.model[0].xyz, d), dot(push.model[1].xyz, d), dot(push.model[2].xyz, d));
}

/* The cofactor matrix is the inverse transpose times the determinant; its sign comes with the push constants.
 */
vec3 normal_from_object(vec3 n)
{
    const vec3 r0 = push.model[0].xyz, r1 = push.model[1].xyz, r2 = push.model[2].xyz;
    return push.params.x * vec3(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
}

/* SPDX-License-Identifier: MIT
 * What all draws of a frame share. */
#include "host/host_shared.h"

/* The only one, as lib/on_cpu.glsl asks. */
layout(set = HOST_SET_FRAME, binding = 0, std140) uniform host_frame_block
{
    host_frame_data frames[1];
};
#define frame frames[SDFGI_ZERO]

layout(set = HOST_SET_FRAME, binding = 1, std430) readonly buffer host_light_block
{
    host_light_data lights[];
};
layout(set = HOST_SET_FRAME, binding = 2, std430) readonly buffer host_layer_block
{
    host_layer_data layers[];
};
layout(set = HOST_SET_FRAME, binding = 3) uniform sampler2DArray sun_map;
layout(set = HOST_SET_FRAME, binding = 4) uniform sampler2DArray punctual_map;

/* ---- The camera. Rays through the picture start at its point, or in the near plane of an orthographic one.
 * Places in the picture are ndc, with y down. */

vec3 camera_aside(vec2 ndc)
{
    return ndc.x * frame.camera_right.xyz - ndc.y * frame.camera_up.xyz;
}

vec3 camera_ray_start(vec2 ndc)
{
    return frame.camera_position.xyz + frame.camera_forward.w * camera_aside(ndc);
}

/* 1 m along the camera's axis. */
vec3 camera_ray(vec2 ndc)
{
    return frame.camera_forward.xyz + (1.0 - frame.camera_forward.w) * camera_aside(ndc);
}

/* From the start of the ray that shows it to a position. */
vec3 camera_offset(vec3 position)
{
    const vec3 offset = position - frame.camera_position.xyz, forward = frame.camera_forward.xyz;
    return frame.camera_forward.w > 0.0 ? dot(offset, forward) * forward : offset;
}

/* Metres along the axis from there. */
float camera_distance_of_depth(float depth)
{
    return frame.camera_forward.w > 0.0 ? (1.0 - min(depth, 1.0)) * frame.camera_range.y
                                        : frame.camera_range.x / depth;
}

/* ---- Lights and sky */

/* Share of a lamp's intensity that it sends in a direction: the spot's cone, and a hard end at the range,
 * where one is given. */
float light_share(host_light_data light, vec3 to_light, float distance2)
{
    if (distance2 * light.position.w * light.position.w > 1.0)
        return 0.0;
    const float cone = clamp((dot(light.direction.xyz, -to_light) - light.cone.x) * light.cone.y, 0.0, 1.0);
    return cone * cone;
}

vec3 sky_radiance(vec3 direction)
{
    const vec3 pole = direction.y >= 0.0 ? frame.sky_zenith.rgb : frame.sky_ground.rgb;
    return mix(frame.sky_horizon.rgb, pole, abs(direction.y));
}

/* SPDX-License-Identifier: MIT
 * What all draws of a frame share. */
#include "host/host_shared.h"

layout(set = HOST_SET_FRAME, binding = 0, std140) uniform host_frame_block
{
    host_frame_data frame;
};
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

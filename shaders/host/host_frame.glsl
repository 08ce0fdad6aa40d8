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

vec3 sky_radiance(vec3 direction)
{
    const vec3 pole = direction.y >= 0.0 ? frame.sky_zenith.rgb : frame.sky_ground.rgb;
    return mix(frame.sky_horizon.rgb, pole, abs(direction.y));
}

/* SPDX-License-Identifier: MIT
 * Background where no surface was drawn. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "host/host_frame.glsl"
#ifdef HOST_FOG
#include "host/host_fog.glsl"
#endif

layout(location = 0) in vec2 in_ndc;
layout(location = 0) out vec4 out_radiance;

void main()
{
    const vec3 direction = normalize(camera_ray(in_ndc));
    out_radiance = vec4(sky_radiance(direction), 1.0);
#ifdef HOST_FOG
    out_radiance.rgb = fog_before(out_radiance.rgb, FOG_SKY_M * direction);
#endif
}

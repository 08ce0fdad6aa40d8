/* SPDX-License-Identifier: MIT
 * Background where no surface was drawn. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_NEVER (gl_FragCoord.z > 2.0)
#include "lib/on_cpu.glsl"
#include "host/host_frame.glsl"
#ifdef HOST_FOG
#include "host/host_fog.glsl"
#endif

#ifdef HOST_ENVIRONMENT
layout(set = HOST_SET_GI, binding = 0) uniform sampler2D environment;

/* Rows go from up to down, columns around, with -Z in the middle: struct host_environment. */
vec3 background(vec3 direction)
{
    const float pi = 3.14159265359;
    const float around = atan(direction.x, -direction.z) / (2.0 * pi) + 0.5;
    const float down = acos(clamp(direction.y, -1.0, 1.0)) / pi;
    return textureLod(environment, vec2(around, down), 0.0).rgb;
}
#else
#define background sky_radiance
#endif

layout(location = 0) in vec2 in_ndc;
layout(location = 0) out vec4 out_radiance;

void main()
{
    const vec3 direction = normalize(camera_ray(in_ndc));
    out_radiance = vec4(background(direction), 1.0);
#ifdef HOST_FOG
    out_radiance.rgb = fog_before(out_radiance.rgb, FOG_SKY_M * direction);
#endif
}

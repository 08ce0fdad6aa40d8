/* SPDX-License-Identifier: MIT
 * Per element: cosine to the viewer, roughness, square of the sine of the light's height and its azimuth from
 * beyond the viewer; a height below 0: of even light. What a rough lobe answers in w, if light comes from
 * there alone, or from that height all around where the azimuth is below 0. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/lib/rough_lobe.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer data_buffer
{
    vec4 data[];
};
layout(push_constant) uniform push
{
    uint count;
};

/* In the frame of the surface, as a light cell keeps it. */
sdfgi_low_light light_of(vec3 normal, vec3 forward, vec4 d)
{
    const float low = d.z < 0.0 ? SDFGI_LOW_OF_EVEN : sdfgi_low_share(1.0 - d.z);
    const vec3 side = cross(normal, forward), dir = cos(d.w) * forward + sin(d.w) * side;
    const vec4 around = sdfgi_low_around(dir * sdfgi_low_frame(normal, 2u));
    return sdfgi_low_unpack(
        sdfgi_low_pack(sdfgi_low_light(low, d.z < 0.0 || d.w < 0.0 ? vec4(0.0) : low * around), 0.5));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const vec4 d = data[i];
    const vec3 normal = vec3(0.0, 1.0, 0.0),
               view = vec3(-0.6, 0.0, 0.8) * sqrt(max(1.0 - d.x * d.x, 0.0)) + d.x * normal;
    const sdfgi_rough_lobe lobe = sdfgi_rough_lobe_of(normal, view, d.y);
    data[i].w = sdfgi_rough_lobe_answer(lobe, light_of(normal, lobe.forward, d), 2u);
}

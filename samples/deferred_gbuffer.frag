/* SPDX-License-Identifier: MIT
 * The G-buffer: base colour and metal, normal, roughness, and what surfaces emit, where the light of the
 * picture is added up. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "sample_push.glsl"

layout(location = 0) in vec3 normal_in;
layout(location = 0) out vec4 color_metal;
layout(location = 1) out vec4 normal;
layout(location = 2) out float roughness;
layout(location = 3) out vec4 radiance;

void main()
{
    color_metal = base_color;
    normal = vec4(normalize(normal_in), 0.0);
    roughness = base_color.a > 0.5 ? -glow.a : glow.a; /* of metal below 0 */
    radiance = vec4(glow.rgb, 1.0);
}

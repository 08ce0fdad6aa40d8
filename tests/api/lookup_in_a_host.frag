/* SPDX-License-Identifier: MIT
 * A host's shader as the README has it, with nothing switched on for the library's sake but the include
 * directive. The test compiles it for each GLSL version that hosts use. */
#extension GL_GOOGLE_include_directive : require

const float PI = 3.14159265;

/* Names that hosts have, too: the include brings none without its prefix. */
vec2 octahedral_encode(vec3 direction)
{
    return direction.xz;
}

uint rgbe_encode(vec3 color)
{
    return uint(color.r);
}

uint cell_index(uint cascade)
{
    return cascade;
}

vec3 trace_ray(vec3 direction)
{
    return direction * float(cell_index(rgbe_encode(direction))) + vec3(octahedral_encode(direction), 0.0);
}

#define SDFGI_SET 1
#include "sdfgi.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(push_constant) uniform host_push
{
    vec4 eye, albedo;
};
layout(location = 0) out vec4 color;

void main()
{
    color =
        vec4(albedo.rgb / PI * sdfgi_irradiance(position, normal, eye.xyz - position), trace_ray(normal).x);
}

/* SPDX-License-Identifier: MIT
 * Looks at a floor and a red wall without drawing them: one ray per pixel, met analytically. What matters is
 * sdfgi_irradiance(), the library's answer, which a host calls with any position and normal it has. */
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_GOOGLE_include_directive : require

#define SDFGI_SET 0
#include "sdfgi.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(buffer_reference) writeonly buffer picture_buffer { uint texels[]; };
layout(push_constant) uniform constants { picture_buffer picture; };

const ivec2 SIZE = ivec2(320, 180); /* as in minimal_host.c, like the scene below */
const vec3 TO_SUN = normalize(vec3(0.5, 0.7, 0.4)), SUN_IRRADIANCE = vec3(10, 9.4, 8.5);
const float WALL_Z = -2, WALL_HEIGHT = 3, WALL_HALF = 3, FLOOR_HALF = 6, PI = 3.14159265;

float wall_distance(vec3 from, vec3 dir)
{
    const float t = (WALL_Z - from.z) / dir.z;
    const vec3 at = from + t * dir;
    return t > 0 && abs(at.x) < WALL_HALF && at.y > 0 && at.y < WALL_HEIGHT ? t : -1;
}

float floor_distance(vec3 from, vec3 dir)
{
    const float t = -from.y / dir.y;
    return t > 0 && all(lessThan(abs(from.xz + t * dir.xz), vec2(FLOOR_HALF))) ? t : -1;
}

vec3 shade(vec3 position, vec3 normal, vec3 to_eye, vec3 albedo)
{
    const float lit = wall_distance(position + 1e-3 * normal, TO_SUN) < 0 ? max(dot(normal, TO_SUN), 0) : 0;
    return albedo / PI * (lit * SUN_IRRADIANCE + sdfgi_irradiance(position, normal, to_eye));
}

vec3 look(vec3 eye, vec3 dir)
{
    const float to_wall = wall_distance(eye, dir), to_floor = floor_distance(eye, dir);
    if (to_wall > 0 && (to_floor < 0 || to_wall < to_floor))
        return shade(eye + to_wall * dir, vec3(0, 0, -sign(dir.z)), -to_wall * dir, vec3(0.7, 0.1, 0.08));
    if (to_floor > 0)
        return shade(eye + to_floor * dir, vec3(0, 1, 0), -to_floor * dir, vec3(0.7));
    return mix(vec3(1), dir.y < 0 ? vec3(0.3) : vec3(0.3, 0.6, 1), abs(dir.y));
}

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, SIZE)))
        return;
    const vec2 at = (vec2(pixel) + 0.5 - 0.5 * vec2(SIZE)) / float(SIZE.y);
    const vec3 eye = vec3(-2, 2, 5.5), forward = normalize(vec3(0, 0.9, 0) - eye);
    const vec3 right = normalize(cross(forward, vec3(0, 1, 0))), up = cross(right, forward);
    const vec3 radiance = look(eye, normalize(forward + at.x * right - at.y * up));
    /* An exponential curve, and a gamma close to that of sRGB, are enough here. */
    const vec3 display = pow(1 - exp(-0.45 * radiance), vec3(1 / 2.2));
    picture.texels[pixel.y * SIZE.x + pixel.x] = packUnorm4x8(vec4(display, 1));
}

/* SPDX-License-Identifier: MIT
 * Lookups at points, and the texels of the irradiance atlas: read, or set to zero. Row 0 of the buffer holds
 * the number of points and whether to clear. Then come three rows a point, as in gi_lookup.comp, and one a
 * texel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_SET 0
#include "sdfgi.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = SDFGI_BINDING_IRRADIANCE_STORE, rgba16f) uniform image2DArray atlas;
layout(std430, set = 1, binding = 0) buffer rows_buffer { uvec4 rows[]; };
layout(push_constant) uniform push { uint count; };

void look(uint first)
{
    const vec4 position = uintBitsToFloat(rows[first]), normal = uintBitsToFloat(rows[first + 1u]);
    const vec3 to_eye = vec3(position.w, normal.w, uintBitsToFloat(rows[first + 2u].w));
    rows[first + 2u].xyz = floatBitsToUint(sdfgi_irradiance(position.xyz, normal.xyz, to_eye));
}

void main()
{
    const uint i = gl_GlobalInvocationID.x, points = rows[0].x;
    if (i >= count)
        return;
    if (i < points) {
        look(1u + 3u * i);
        return;
    }
    const uint texel = i - points;
    const uvec3 size = uvec3(imageSize(atlas));
    const ivec3 at = ivec3(texel % size.x, texel / size.x % size.y, texel / (size.x * size.y));
    if (rows[0].y != 0u)
        imageStore(atlas, at, vec4(0));
    else
        rows[1u + 3u * points + texel] = floatBitsToUint(imageLoad(atlas, at));
}

/* SPDX-License-Identifier: MIT
 * Indirect diffuse irradiance of a whole picture, from its depths and normals. A thread per pixel. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../include/sdfgi.glsl"
#include "../shared/args.h"

layout(local_size_x = SDFGI_GROUP_PIXELS, local_size_y = SDFGI_GROUP_PIXELS) in;
layout(push_constant) uniform sdfgi_push
{
    sdfgi_gather_args args;
};
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_GATHER_DEPTH) uniform sampler2D depth_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_GATHER_NORMAL) uniform sampler2D normal_image;
layout(set = SDFGI_SET_VIEW, binding = SDFGI_BINDING_GATHER_OUTPUT,
       rgba16f) uniform writeonly image2D output_image;

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(args.width) || pixel.y >= int(args.height))
        return;
    const float depth = texelFetch(depth_image, pixel, 0).r;
    vec3 irradiance = vec3(0.0);
    if (depth != args.background_depth) {
        const vec2 ndc = (vec2(pixel) + 0.5) / vec2(args.width, args.height) * 2.0 - 1.0;
        const mat4 to_position = mat4(args.inverse_view_projection[0], args.inverse_view_projection[1],
                                      args.inverse_view_projection[2], args.inverse_view_projection[3]);
        const vec4 position = to_position * vec4(ndc, depth, 1.0);
        const vec3 normal = normalize(texelFetch(normal_image, pixel, 0).xyz);
        /* A point on the near plane: the vector to it leads towards the viewer. */
        const vec4 near = to_position * vec4(ndc, 1.0 - args.background_depth, 1.0);
        const vec3 pos = position.xyz / position.w;
        irradiance = sdfgi_irradiance(pos, normal, near.xyz / near.w - pos);
    }
    imageStore(output_image, pixel, vec4(irradiance, 1.0));
}

/* SPDX-License-Identifier: MIT
 * Adds the light that the surface of each pixel reflects. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "sample_frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2) uniform sampler2D color_metal_image;
layout(set = 0, binding = 3) uniform sampler2D normal_image;
layout(set = 0, binding = 4) uniform sampler2D depth_image;
layout(set = 0, binding = 5, rgba16f) uniform image2D radiance_image;
/* GI begins */
layout(set = 1, binding = 0) uniform sampler2D irradiance_image;
/* GI with views begins */
layout(set = 1, binding = 1) uniform sampler2D reflection_image;
/* GI with views ends */
/* GI ends */

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(radiance_image);
    const float depth = texelFetch(depth_image, pixel, 0).r;
    if (any(greaterThanEqual(pixel, size)) || depth == 1.0)
        return;
    const vec4 world = world_from_clip * vec4((vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0, depth, 1.0);
    const vec3 normal = texelFetch(normal_image, pixel, 0).xyz;
    const vec4 color_metal = texelFetch(color_metal_image, pixel, 0);
    vec3 irradiance = lamp_irradiance(world.xyz / world.w, normal), reflection = vec3(0.0);
    /* GI begins */
    irradiance += texelFetch(irradiance_image, pixel, 0).rgb;
    /* GI with views begins */
    reflection += texelFetch(reflection_image, pixel, 0).rgb;
    /* GI with views ends */
    /* GI ends */
    const vec3 light = mix(irradiance / PI, reflection, color_metal.a);
    const vec4 radiance = imageLoad(radiance_image, pixel);
    imageStore(radiance_image, pixel, radiance + vec4(color_metal.rgb * light, 0.0));
}

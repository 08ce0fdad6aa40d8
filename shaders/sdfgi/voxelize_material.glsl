/* SPDX-License-Identifier: MIT
 * What the voxeliser reads of a material: constants and textures. */
#ifndef SDFGI_VOXELIZE_MATERIAL_GLSL
#define SDFGI_VOXELIZE_MATERIAL_GLSL

#include "voxelize_mesh.glsl"

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_MATERIALS) readonly buffer sdfgi_materials_buffer
{
    sdfgi_material_params sdfgi_materials[];
};
#ifdef SDFGI_VOXELIZE_TEXTURED
layout(set = SDFGI_SET_MATERIAL, binding = SDFGI_BINDING_MATERIAL_ALBEDO) uniform sampler2D albedo_texture;
layout(set = SDFGI_SET_MATERIAL,
       binding = SDFGI_BINDING_MATERIAL_EMISSION) uniform sampler2D emission_texture;
#endif

struct surface_sample {
    vec4 albedo;
    vec3 emission;
    uint flags;
};

#ifdef SDFGI_VOXELIZE_TEXTURED
/* Level at which one texel covers about one sub-voxel. */
float texture_level(vec2 uvs[3], float area2, vec4 rows[2], vec2 size)
{
    const vec2 b = uvs[1] - uvs[0], c = uvs[2] - uvs[0];
    const float scale = abs(rows[0].x * rows[1].y - rows[0].y * rows[1].x);
    const float texels = abs(b.x * c.y - b.y * c.x) * scale * size.x * size.y;
    return 0.5 * log2(max(texels / max(area2, 1e-6), 1.0));
}

vec2 texture_uv(vec4 rows[2], vec2 uv)
{
    return vec2(dot(rows[0].xyz, vec3(uv, 1.0)), dot(rows[1].xyz, vec3(uv, 1.0)));
}

/* Linear RGB, and alpha. */
vec4 texel_decode(vec4 texel, bool encoded)
{
    /* A loop, because software drivers run what is under a condition in any case. */
    for (uint i = 0u; i < uint(encoded); i++)
        texel.rgb = sdfgi_srgb_decode(texel.rgb);
    return texel;
}
#endif

/* The material at a point of a triangle. `area2` is twice the area of its projection along an axis, in
 * sub-voxels^2: as many points of it are sampled. */
surface_sample material_sample(uint index[3], vec3 bary, float area2)
{
    const sdfgi_material_params m = sdfgi_materials[drawn.material];
    surface_sample s = surface_sample(vec4(m.albedo, m.alpha), m.emission, m.flags);
    if (args.color_fetch != 0u)
        s.albedo *= mesh_color(index, bary);
#ifdef SDFGI_VOXELIZE_TEXTURED
    const vec2 corners[3] = corner_uvs(index);
    const vec2 uv = bary[0] * corners[0] + bary[1] * corners[1] + bary[2] * corners[2];
    if ((m.flags & SDFGI_MATERIAL_ALBEDO_TEXTURE) != 0u) {
        const float level = texture_level(corners, area2, m.albedo_uv, vec2(textureSize(albedo_texture, 0)));
        s.albedo *= texel_decode(textureLod(albedo_texture, texture_uv(m.albedo_uv, uv), level),
                                 (m.flags & SDFGI_MATERIAL_ALBEDO_SRGB) != 0u);
    }
    if ((m.flags & SDFGI_MATERIAL_EMISSION_TEXTURE) != 0u) {
        const float level =
            texture_level(corners, area2, m.emission_uv, vec2(textureSize(emission_texture, 0)));
        s.emission *= texel_decode(textureLod(emission_texture, texture_uv(m.emission_uv, uv), level),
                                   (m.flags & SDFGI_MATERIAL_EMISSION_SRGB) != 0u)
                          .rgb;
    }
#endif
    s.albedo.rgb += m.specular_albedo;
    return s;
}

#endif

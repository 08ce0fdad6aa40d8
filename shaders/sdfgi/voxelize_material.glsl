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

/* What a triangle's points share of its material. It is loaded once: loads take most of the time that a
 * point takes. */
struct triangle_material {
    sdfgi_material_params params;
    vec4 colors[3]; /* of its corners, if the mesh has any */
#ifdef SDFGI_VOXELIZE_TEXTURED
    vec2 uvs[3]; /* of its corners */
    float albedo_level, emission_level;
#endif
};

/* `area2` is twice the area of the triangle's projection along an axis, in sub-voxels^2: as many points of it
 * are sampled. */
triangle_material material_load(uint index[3], float area2)
{
    triangle_material m;
    m.params = sdfgi_materials_at(drawn.material);
    m.colors = corner_colors(index);
#ifdef SDFGI_VOXELIZE_TEXTURED
    m.uvs = corner_uvs(index);
    m.albedo_level = texture_level(m.uvs, area2, m.params.albedo_uv, vec2(textureSize(albedo_texture, 0)));
    m.emission_level =
        texture_level(m.uvs, area2, m.params.emission_uv, vec2(textureSize(emission_texture, 0)));
#endif
    return m;
}

/* The material at a point of the triangle. */
surface_sample material_sample(triangle_material m, vec3 bary)
{
    surface_sample s =
        surface_sample(vec4(m.params.albedo, m.params.alpha), m.params.emission, m.params.flags);
    if (args.color_fetch != 0u)
        s.albedo *= bary[0] * m.colors[0] + bary[1] * m.colors[1] + bary[2] * m.colors[2];
#ifdef SDFGI_VOXELIZE_TEXTURED
    const vec2 uv = bary[0] * m.uvs[0] + bary[1] * m.uvs[1] + bary[2] * m.uvs[2];
    if ((s.flags & SDFGI_MATERIAL_ALBEDO_TEXTURE) != 0u)
        s.albedo *=
            texel_decode(textureLod(albedo_texture, texture_uv(m.params.albedo_uv, uv), m.albedo_level),
                         (s.flags & SDFGI_MATERIAL_ALBEDO_SRGB) != 0u);
    if ((s.flags & SDFGI_MATERIAL_EMISSION_TEXTURE) != 0u)
        s.emission *=
            texel_decode(textureLod(emission_texture, texture_uv(m.params.emission_uv, uv), m.emission_level),
                         (s.flags & SDFGI_MATERIAL_EMISSION_SRGB) != 0u)
                .rgb;
#endif
    s.albedo.rgb += m.params.specular_albedo;
    return s;
}

#endif

/* SPDX-License-Identifier: MIT
 * A material's textures and factors. */
#include "host/host_shared.h"

/* The only one, as lib/on_cpu.glsl asks. */
layout(set = HOST_SET_MATERIAL, binding = 0, std140) uniform host_material_block
{
    host_material_data materials[1];
};
#define material materials[SDFGI_ZERO]

layout(set = HOST_SET_MATERIAL, binding = 1) uniform sampler2D base_map;
layout(set = HOST_SET_MATERIAL, binding = 2) uniform sampler2D surface_map;
layout(set = HOST_SET_MATERIAL, binding = 3) uniform sampler2D normal_map;
layout(set = HOST_SET_MATERIAL, binding = 4) uniform sampler2D emissive_map;

bool material_has(uint flag)
{
    return (material.flags.x & flag) != 0u;
}

vec2 material_uv(int index, vec4 uv_sets)
{
    const vec4 row = material.uv[2 * index];
    const vec3 uv = vec3(row.w > 0.5 ? uv_sets.zw : uv_sets.xy, 1.0);
    return vec2(dot(row.xyz, uv), dot(material.uv[2 * index + 1].xyz, uv));
}

vec4 material_base_color(vec4 uv_sets, vec4 vertex_color)
{
    vec4 color = material.base_color * vertex_color;
    if (material_has(HOST_MATERIAL_BASE_MAP))
        color *= texture(base_map, material_uv(0, uv_sets));
    return color;
}

vec3 material_emission(vec4 uv_sets)
{
    vec3 emission = material.emissive.rgb;
    if (material_has(HOST_MATERIAL_EMISSIVE_MAP))
        emission *= texture(emissive_map, material_uv(3, uv_sets)).rgb;
    return emission;
}

/* x: metallic, y: roughness */
vec2 material_surface(vec4 uv_sets)
{
    vec2 surface = material.surface.xy;
    if (material_has(HOST_MATERIAL_SURFACE_MAP))
        surface *= texture(surface_map, material_uv(1, uv_sets)).bg;
    return surface;
}

/* Roughness as the library has it: of metal below 0. */
float material_signed_roughness(float metallic, float roughness)
{
    return metallic > 0.5 ? -roughness : roughness;
}

/* Unit normal on the side from which the surface is seen. */
vec3 material_normal(vec4 uv_sets, vec3 vertex_normal, vec4 tangent, bool front_facing)
{
    const vec3 n = normalize(vertex_normal);
    vec3 result = n;
    if (material_has(HOST_MATERIAL_NORMAL_MAP)) {
        vec3 m = texture(normal_map, material_uv(2, uv_sets)).xyz * 2.0 - 1.0;
        m.xy *= material.surface.z;
        const vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
        const float t2 = dot(t, t);
        if (t2 > 1e-12 && dot(m, m) > 1e-12) {
            const vec3 unit_t = t * inversesqrt(t2);
            result = normalize(m.x * unit_t + m.y * tangent.w * cross(n, unit_t) + m.z * n);
        }
    }
    return front_facing ? result : -result;
}

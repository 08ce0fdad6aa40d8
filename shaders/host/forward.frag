/* SPDX-License-Identifier: MIT
 * Forward shading: direct light with shadows, emission, and the library's indirect light. With HOST_GI it is
 * looked up here, with HOST_GATHERED it is read from pictures of it. Outgoing radiance of a Lambertian
 * surface is albedo * E / pi for an irradiance E. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_NEVER (gl_FragCoord.z > 2.0)
#include "lib/on_cpu.glsl"
#include "host/host_frame.glsl"
#include "host/host_material.glsl"
#include "host/host_brdf.glsl"
#include "host/host_shadow.glsl"
#ifdef HOST_FOG
#include "host/host_fog.glsl"
#endif
#ifdef HOST_GI
#define SDFGI_SET HOST_SET_GI
#ifdef HOST_RAYS
layout(constant_id = 1) const uint lobe_rays = 1u;
#define SDFGI_REFLECTION_RAYS lobe_rays
/* Neighbouring pixels take other directions of a lobe. */
#define SDFGI_REFLECTION_SHIFT bitfieldReverse(uint(gl_FragCoord.x) & 3u | (uint(gl_FragCoord.y) & 3u) << 2u)
#include "sdfgi_reflection.glsl"
#else
#include "sdfgi.glsl"
#endif
#endif
#ifdef HOST_GATHERED
layout(set = HOST_SET_GI, binding = 0) uniform sampler2D irradiance_image;
layout(set = HOST_SET_GI, binding = 1) uniform sampler2D reflection_image;
#endif

layout(push_constant) uniform host_push_block
{
    host_push pushes[1];
};
#define push pushes[SDFGI_ZERO]

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_color;
layout(location = 0) out vec4 out_radiance;

/* The triangle's own normal, towards the viewer: shadows follow the geometry, whatever the shading normal
 * says. */
vec3 face_normal()
{
    const vec3 n = cross(dFdx(in_position), dFdy(in_position));
    const vec3 view = -camera_offset(in_position);
    const float n2 = dot(n, n);
    return n2 > 0.0 ? n * (sign(dot(n, view)) * inversesqrt(n2)) : normalize(view);
}

vec3 light_from_suns(brdf_surface s, vec3 face)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(frame.counts.x); i++) {
        const vec3 light = frame.suns[i].direction.xyz;
        if (dot(s.normal, light) > 0.0 && dot(face, light) > 0.0)
            sum += frame.suns[i].irradiance.rgb * brdf_evaluate(s, light) * shadow_sun(i, in_position, face);
    }
    return sum;
}

vec3 light_from_punctual(brdf_surface s, vec3 face)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < int(frame.counts.y); i++) {
        const host_light_data light = lights[i];
        const vec3 to_light = light.position.xyz - in_position;
        const float distance2 = max(dot(to_light, to_light), 1e-8);
        const vec3 direction = to_light * inversesqrt(distance2);
        const float attenuation = light_share(light, direction, distance2) / distance2;
        if (attenuation > 0.0 && dot(s.normal, direction) > 0.0 && dot(face, direction) > 0.0)
            sum += light.intensity.rgb * attenuation * brdf_evaluate(s, direction) *
                   shadow_punctual(light, -to_light, face);
    }
    return sum;
}

brdf_surface surface_here(vec4 base_color, bool front_facing, out float metallic)
{
    const vec2 metallic_roughness = material_surface(in_uv);
    const bool lambert = material_has(HOST_MATERIAL_LAMBERT);
    metallic = lambert ? 0.0 : metallic_roughness.x;
    brdf_surface s;
    s.normal = material_normal(in_uv, in_normal, in_tangent, front_facing);
    s.view = -normalize(camera_offset(in_position));
    s.diffuse = base_color.rgb * (1.0 - metallic);
    s.f0 = mix(vec3(SDFGI_GGX_DIELECTRIC_F0), base_color.rgb, metallic);
    /* Smoother lobes than this cannot be hit by point lights and overflow the HDR target. */
    s.alpha = max(metallic_roughness.y * metallic_roughness.y, 1e-3);
    s.specular = lambert ? 0.0 : 1.0;
    return s;
}

float perceptual_roughness(brdf_surface s)
{
    return s.specular > 0.0 ? sqrt(s.alpha) : 1.0;
}

/* Light that comes round corners: irradiance, and what the specular lobe reflects of it. */
void indirect_light(brdf_surface s, float metallic, out vec3 irradiance, out vec3 reflection)
{
    irradiance = reflection = vec3(0.0);
#if defined(HOST_RAYS)
    const vec3 to_eye = -camera_offset(in_position);
    const float roughness = material_signed_roughness(metallic, perceptual_roughness(s));
    const sdfgi_surface_light light = sdfgi_lighting(in_position, s.normal, to_eye, roughness);
    irradiance = light.irradiance;
    reflection = light.reflection * s.specular * brdf_specular_albedo(s);
#elif defined(HOST_GI)
    irradiance = sdfgi_irradiance(in_position, s.normal, -camera_offset(in_position));
    reflection = irradiance / BRDF_PI * s.specular * brdf_specular_albedo(s);
#elif defined(HOST_GATHERED)
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    irradiance = texelFetch(irradiance_image, pixel, 0).rgb;
    reflection =
        frame.camera_position.w > 0.0 ? texelFetch(reflection_image, pixel, 0).rgb : irradiance / BRDF_PI;
    reflection *= s.specular * brdf_specular_albedo(s);
#endif
}

vec3 shown_value(brdf_surface s, vec3 direct, vec3 irradiance, vec3 reflection, vec3 emission)
{
    const vec3 indirect = irradiance * s.diffuse * brdf_diffuse_transmission(s) / BRDF_PI;
    switch (frame.counts.z) {
    case HOST_SHOW_DIRECT:
        return direct;
    case HOST_SHOW_DIFFUSE_INDIRECT:
        return indirect;
    case HOST_SHOW_IRRADIANCE:
        return irradiance;
    case HOST_SHOW_REFLECTION:
        return reflection;
    case HOST_SHOW_NORMAL:
        return s.normal;
    case HOST_SHOW_DEPTH:
        return vec3(dot(frame.camera_forward.xyz, in_position - frame.camera_position.xyz) +
                    frame.camera_forward.w * frame.camera_range.x);
    case HOST_SHOW_ALBEDO:
        return s.diffuse;
    case HOST_SHOW_ROUGHNESS:
        return vec3(perceptual_roughness(s));
    default:
        return direct + indirect + reflection + emission;
    }
}

void main()
{
    const bool front_facing = gl_FrontFacing == (push.params.x > 0.0);
    const vec4 base_color = material_base_color(in_uv, in_color);
    float metallic;
    brdf_surface s = surface_here(base_color, front_facing, metallic);
    const vec3 face = face_normal();

    vec3 direct = vec3(0.0), irradiance = vec3(0.0), reflection = vec3(0.0);
    vec3 emission = front_facing || material.emissive.w > 0.0 ? material_emission(in_uv) : vec3(0.0);
    const uint shown = frame.counts.z;
    if (material_has(HOST_MATERIAL_UNLIT)) {
        emission = base_color.rgb;
        s.diffuse = vec3(0.0);
    } else {
        if (shown <= HOST_SHOW_DIRECT)
            direct = light_from_suns(s, face) + light_from_punctual(s, face);
        if (shown == HOST_SHOW_COLOR ||
            (shown >= HOST_SHOW_DIFFUSE_INDIRECT && shown <= HOST_SHOW_REFLECTION))
            indirect_light(s, metallic, irradiance, reflection);
    }
    const float alpha = material_has(HOST_MATERIAL_BLEND) ? base_color.a : 1.0;
    out_radiance = vec4(shown_value(s, direct, irradiance, reflection, emission), alpha);
#ifdef HOST_FOG
    if (shown == HOST_SHOW_COLOR)
        out_radiance.rgb = fog_before(out_radiance.rgb, camera_offset(in_position));
#endif
}

/* SPDX-License-Identifier: MIT
 * What the sample hosts' shaders share: the view, and the light of their lamp. */
#extension GL_GOOGLE_include_directive : require

const float PI = 3.14159265;

/* struct sample_view */
layout(std140, set = 0, binding = 0) uniform view_block
{
    mat4 clip_from_world, world_from_clip, lamp_clip_from_world;
    vec4 eye;
    vec4 lamp_position, lamp_direction;
    vec4 lamp_intensity;
    vec4 sky;
};
layout(set = 0, binding = 1) uniform sampler2D shadow_map;

float lamp_visibility(vec3 position)
{
    const vec4 clip = lamp_clip_from_world * vec4(position, 1.0);
    const vec3 at = clip.xyz / clip.w;
    return clip.w > 0.0 && at.z <= texture(shadow_map, 0.5 * at.xy + 0.5).r ? 1.0 : 0.0;
}

/* Irradiance from the lamp, W/m^2, at a point that faces `normal`. */
vec3 lamp_irradiance(vec3 position, vec3 normal)
{
    const vec3 to_lamp = lamp_position.xyz - position, towards = normalize(to_lamp);
    const float inner = lamp_position.w, outer = lamp_direction.w,
                cone = clamp((dot(-towards, lamp_direction.xyz) - outer) / (inner - outer), 0.0, 1.0);
    const float cosine = max(dot(normal, towards), 0.0);
    return lamp_intensity.rgb * (cone * cone * cosine * lamp_visibility(position) / dot(to_lamp, to_lamp));
}

/* SPDX-License-Identifier: MIT
 * A forward shader: the lamp's light, and what it and the sky send from elsewhere. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "sample_frame.glsl"
#include "sample_push.glsl"
/* GI begins */
#define SDFGI_SET 1
#include "sdfgi_reflection.glsl"
/* GI ends */

layout(location = 0) in vec3 normal_in;
layout(location = 1) in vec3 position;
layout(location = 0) out vec4 radiance;

void main()
{
    const vec3 normal = normalize(normal_in);
    const float metal = base_color.a, roughness = glow.a;
    vec3 irradiance = lamp_irradiance(position, normal), reflection = vec3(0.0);
    /* GI begins */
    /* Metal alone reflects here: its roughness is given below 0. */
    const sdfgi_surface_light light = sdfgi_lighting(position, normal, eye.xyz - position, -roughness);
    irradiance += light.irradiance;
    reflection += light.reflection;
    /* GI ends */
    radiance = vec4(base_color.rgb * mix(irradiance / PI, reflection, metal) + glow.rgb, 1.0);
}

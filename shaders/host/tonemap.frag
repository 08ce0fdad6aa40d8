/* SPDX-License-Identifier: MIT
 * HDR radiance to display sRGB. Each sample of a pixel is mapped before they are averaged, so that edges
 * against bright light stay smooth. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_NEVER (gl_FragCoord.z > 2.0)
#include "lib/on_cpu.glsl"
#include "host/host_exposure.glsl"

layout(location = 0) out vec4 out_srgb;

/* Saturated light moves towards white as it brightens if the curve runs in slightly mixed primaries. */
const float TONE_MIX = 0.12;
/* Contrast around middle grey, which maps to itself. */
const float TONE_POWER = 1.25;
const float TONE_GREY = 0.18;

/* Hill's response curve: x^p / (x^p + s^p). */
vec3 tone_curve(vec3 rgb)
{
    const vec3 mixed = mix(rgb, vec3((rgb.r + rgb.g + rgb.b) / 3.0), TONE_MIX);
    const vec3 x = pow(clamp(mixed / TONE_GREY, 0.0, 1e7), vec3(TONE_POWER));
    const vec3 y = x / (x + (1.0 - TONE_GREY) / TONE_GREY);
    const vec3 mean = vec3((y.r + y.g + y.b) / 3.0);
    return clamp(mean + (y - mean) / (1.0 - 0.75 * TONE_MIX), 0.0, 1.0);
}

vec3 srgb_encode(vec3 linear)
{
    return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055,
               greaterThan(linear, vec3(0.0031308)));
}

void main()
{
    const float factor = tone.exposure > 0.0 ? tone.exposure : auto_exposure;
    const ivec2 base = (ivec2(gl_FragCoord.xy) - ivec2(tone.first_column, 0)) * tone.supersample;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < tone.supersample; y++) {
        for (int x = 0; x < tone.supersample; x++) {
            const vec3 rgb = max(texelFetch(hdr, base + ivec2(x, y), 0).rgb, 0.0);
            sum += tone.exposure < 0.0 ? min(rgb, 1.0) : tone_curve(rgb * factor);
        }
    }
    out_srgb = vec4(srgb_encode(sum / float(tone.supersample * tone.supersample)), 1.0);
}

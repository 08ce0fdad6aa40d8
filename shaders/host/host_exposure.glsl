/* SPDX-License-Identifier: MIT
 * Inputs of the passes that follow the HDR target. */
#include "host/host_shared.h"

layout(set = 0, binding = 0) uniform sampler2D hdr;
layout(set = 0, binding = 1, std430) buffer host_exposure_block
{
    float auto_exposure;
};
struct host_tone {
    float exposure; /* 0: automatic; below 0: colours are shown as they are */
    int supersample;
    int first_column; /* of the picture that is filled */
};
/* The only ones, as lib/on_cpu.glsl asks. */
layout(push_constant) uniform host_tone_block
{
    host_tone tones[1];
};
#define tone tones[SDFGI_ZERO]

float luminance(vec3 rgb)
{
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

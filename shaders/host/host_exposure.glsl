/* SPDX-License-Identifier: MIT
 * Inputs of the passes that follow the HDR target. */
#include "host/host_shared.h"

layout(set = 0, binding = 0) uniform sampler2D hdr;
layout(set = 0, binding = 1, std430) buffer host_exposure_block
{
    float auto_exposure;
};
layout(push_constant) uniform host_tone_block
{
    float exposure; /* 0: automatic; below 0: colours are shown as they are */
    int supersample;
    int first_column; /* of the picture that is filled */
};

float luminance(vec3 rgb)
{
    return dot(rgb, vec3(0.2126, 0.7152, 0.0722));
}

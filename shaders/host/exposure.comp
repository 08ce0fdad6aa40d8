/* SPDX-License-Identifier: MIT
 * Exposure that brings the geometric mean of a grid of samples to middle grey. One group. Pixels that are
 * quite black do not count: behind a thing without a sky there is nothing, and without global illumination
 * most of an interior is black. What is lit would burn out. What is darker than 1/32 of the arithmetic mean
 * counts as that. */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/on_cpu.glsl"
#include "host/host_exposure.glsl"

layout(local_size_x = HOST_EXPOSURE_THREADS) in;

shared float partial[HOST_EXPOSURE_THREADS];

float sample_luminance(int i)
{
    const ivec2 size = textureSize(hdr, 0);
    const ivec2 cell = ivec2(i % HOST_EXPOSURE_SAMPLES, i / HOST_EXPOSURE_SAMPLES);
    const float value =
        luminance(texelFetch(hdr, (2 * cell + 1) * size / (2 * HOST_EXPOSURE_SAMPLES), 0).rgb);
    return value >= 0.0 && value < 1e30 ? value : 0.0;
}

float group_sum(float value)
{
    const uint thread = gl_LocalInvocationIndex;
    barrier();
    partial[thread] = value;
    barrier();
    for (uint step = HOST_EXPOSURE_THREADS / 2; step > 0u; step /= 2u) {
        if (thread < step)
            partial[thread] += partial[thread + step];
        barrier();
    }
    return partial[0];
}

void main()
{
    const int samples = HOST_EXPOSURE_SAMPLES * HOST_EXPOSURE_SAMPLES;
    float sum = 0.0, lit = 0.0;
    for (int i = int(gl_LocalInvocationIndex); i < samples; i += HOST_EXPOSURE_THREADS) {
        sum += sample_luminance(i);
        lit += sample_luminance(i) > 0.0 ? 1.0 : 0.0;
    }
    const float count = max(group_sum(lit), 1.0), mean = group_sum(sum) / count;

    float sum_log = 0.0;
    for (int i = int(gl_LocalInvocationIndex); i < samples; i += HOST_EXPOSURE_THREADS)
        if (sample_luminance(i) > 0.0)
            sum_log += log2(max(sample_luminance(i), max(mean / 32.0, 1e-12)));
    const float geometric = exp2(group_sum(sum_log) / count);
    if (gl_LocalInvocationIndex == 0u)
        auto_exposure = mean > 1e-9 ? clamp(0.18 / geometric, 1e-9, 1e9) : 1.0;
}

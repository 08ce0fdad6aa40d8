/* SPDX-License-Identifier: MIT
 * From where a surface gets its light, as far as lobes of rough dielectrics ask. By Fresnel's law they
 * reflect most of what comes at a small angle to the surface, from beyond the viewer. So five moments are
 * kept of the luminance of low light: how much of all light it is, and the cosines and sines of its azimuth
 * and of twice that (a Fourier series; Ramamoorthi and Hanrahan 2001, "An Efficient Representation for
 * Irradiance Environment Maps", keep light in the same way). Light counts as low by (1 - z^2)^5, where z is
 * the cosine to the normal: a fit of constants and this power to the lobes of GGX and Schlick's term is the
 * closest. */
#ifndef SDFGI_LOW_LIGHT_GLSL
#define SDFGI_LOW_LIGHT_GLSL

/* Of light from everywhere, the part that is low. */
const float SDFGI_LOW_OF_EVEN = 1.0 / 6.0;

struct sdfgi_low_light {
    float low;   /* the part of all light that is low, 0 to 1 */
    vec4 around; /* times the cosine and sine of the azimuth, and those of twice that */
};

/* The two directions along a surface from which azimuths are counted, as columns. `axis` is that of the light
 * cell's surface, to which the normal belongs. */
mat2x3 sdfgi_low_frame(vec3 normal, uint axis)
{
    const uint major = axis >> 1u;
    const vec3 next = vec3(major == 2u, major == 0u, major == 1u), along = next - normal * dot(normal, next);
    const vec3 first = along * inversesqrt(max(dot(along, along), 1e-12));
    return mat2x3(first, cross(normal, first));
}

/* The cosine and sine of an azimuth, and those of twice that; of a direction along the normal, any. */
vec4 sdfgi_low_around(vec2 along)
{
    const float square = dot(along, along);
    const vec2 t = square > 1e-12 ? along * inversesqrt(square) : vec2(1.0, 0.0);
    return vec4(t, t.x * t.x - t.y * t.y, 2.0 * t.x * t.y);
}

/* How low light is, by the square of the sine of its angle to the normal. */
float sdfgi_low_share(float sine2)
{
    const float square = sine2 * sine2;
    return square * square * sine2;
}

/* 0: nothing is known. Each part is rounded at random, so that small steps count in the mean. */
uint sdfgi_low_pack(sdfgi_low_light light, float rounding)
{
    const float low = clamp(light.low, 0.0, 1.0);
    const uvec4 around = uvec4(clamp(light.around / max(low, 1e-6), -1.0, 1.0) * 31.0 + 31.0 + rounding);
    const uvec4 m = min(around, uvec4(62u));
    return max(
        min(uint(sqrt(low) * 255.0 + rounding), 255u) | m.x << 8u | m.y << 14u | m.z << 20u | m.w << 26u, 1u);
}

sdfgi_low_light sdfgi_low_unpack(uint packed)
{
    const float root = float(packed & 255u) / 255.0, low = root * root;
    const vec4 around = vec4(packed >> 8u & 63u, packed >> 14u & 63u, packed >> 20u & 63u, packed >> 26u);
    return sdfgi_low_light(low, low * (around / 31.0 - 1.0));
}

#endif

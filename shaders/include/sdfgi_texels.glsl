/* SPDX-License-Identifier: MIT
 * How the buffers of the LOOKUP set are read: sdfgi_<name>_at(i) is element i. Software drivers read a
 * storage buffer for one thread after another, and wait each time; they read a texel buffer for all at once.
 * In shaders for them (SDFGI_SOFTWARE) each buffer is read as the texel buffer that shows the same memory. A
 * pass that writes a buffer defines SDFGI_WRITES_<NAME>, and reads it as what it is. */
#ifndef SDFGI_TEXELS_GLSL
#define SDFGI_TEXELS_GLSL

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_BITS)
layout(set = SDFGI_SET,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_BITS) uniform usamplerBuffer sdfgi_bits_view;
#define sdfgi_bits_at(i) texelFetch(sdfgi_bits_view, int(i)).xy
#else
#define sdfgi_bits_at(i) sdfgi_bits[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_DISTANCE)
layout(set = SDFGI_SET,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_DISTANCE) uniform usamplerBuffer sdfgi_distance_view;
#define sdfgi_distances_at(i) texelFetch(sdfgi_distance_view, int(i)).x
#else
#define sdfgi_distances_at(i) sdfgi_distances[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_LIGHT)
layout(set = SDFGI_SET,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_LIGHT) uniform usamplerBuffer sdfgi_light_view;
#define sdfgi_light_at(i) texelFetch(sdfgi_light_view, int(i)).x
#else
#define sdfgi_light_at(i) sdfgi_light[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_PROBES)
layout(set = SDFGI_SET,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_PROBES) uniform usamplerBuffer sdfgi_probes_view;
#define sdfgi_probes_at(i) texelFetch(sdfgi_probes_view, int(i)).x
#else
#define sdfgi_probes_at(i) sdfgi_probes[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_IRRADIANCE)
layout(set = SDFGI_SET, binding = SDFGI_BINDING_TEXELS +
                                  SDFGI_BINDING_IRRADIANCE) uniform usamplerBuffer sdfgi_irradiance_view;
#define sdfgi_irradiance_texels_at(i) texelFetch(sdfgi_irradiance_view, int(i)).xy
#else
#define sdfgi_irradiance_texels_at(i) sdfgi_irradiance_texels[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_LIGHT_BLOCKS)
layout(set = SDFGI_SET, binding = SDFGI_BINDING_TEXELS +
                                  SDFGI_BINDING_LIGHT_BLOCKS) uniform usamplerBuffer sdfgi_light_blocks_view;
#define sdfgi_light_blocks_at(i) texelFetch(sdfgi_light_blocks_view, int(i)).xy
#else
#define sdfgi_light_blocks_at(i) sdfgi_light_blocks[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SURFACES)
layout(set = SDFGI_SET,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_SURFACES) uniform usamplerBuffer sdfgi_surfaces_view;
#define sdfgi_surfaces_at(i) texelFetch(sdfgi_surfaces_view, int(i)).x
#else
#define sdfgi_surfaces_at(i) sdfgi_surfaces[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_EMISSION)
layout(set = SDFGI_SET,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_EMISSION) uniform usamplerBuffer sdfgi_emission_view;
#define sdfgi_emission_at(i) texelFetch(sdfgi_emission_view, int(i)).xy
#else
#define sdfgi_emission_at(i) sdfgi_emission[i]
#endif

#endif

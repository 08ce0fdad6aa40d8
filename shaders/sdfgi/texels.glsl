/* SPDX-License-Identifier: MIT
 * How passes read the buffers of the WORK set: as ../include/sdfgi_texels.glsl does those of LOOKUP. A pass
 * may write words of GATHERED, RAYS, SUMS and PREVIOUS, and still read texels of them, as long as no thread
 * reads a word that has been written in the same dispatch. A texel is read for all threads of a group, even
 * if few of them ask. */
#ifndef SDFGI_WORK_TEXELS_GLSL
#define SDFGI_WORK_TEXELS_GLSL

#include "../shared/instances.h"

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SCRATCH)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_SCRATCH) uniform usamplerBuffer sdfgi_scratch_view;
#define sdfgi_scratch_at(i) texelFetch(sdfgi_scratch_view, int(i)).x
#else
#define sdfgi_scratch_at(i) sdfgi_scratch[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SURFACE)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_ALBEDO) uniform usamplerBuffer sdfgi_albedo_view;
#define sdfgi_albedo_at(i) texelFetch(sdfgi_albedo_view, int(i)).xy
#else
#define sdfgi_albedo_at(i) sdfgi_albedo[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SURFACE)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_NORMALS) uniform usamplerBuffer sdfgi_normals_view;
#define sdfgi_normals_at(i) texelFetch(sdfgi_normals_view, int(i)).x
#else
#define sdfgi_normals_at(i) sdfgi_normals[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_LIGHT_CELLS)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS +
                 SDFGI_BINDING_LIGHT_CELLS) uniform usamplerBuffer sdfgi_light_cells_view;
#define sdfgi_light_cells_at(i) texelFetch(sdfgi_light_cells_view, int(i)).x
#else
#define sdfgi_light_cells_at(i) sdfgi_light_cells[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_DIRECT)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_DIRECT) uniform usamplerBuffer sdfgi_direct_view;
#define sdfgi_direct_at(i) texelFetch(sdfgi_direct_view, int(i)).x
#else
#define sdfgi_direct_at(i) sdfgi_direct[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_RAYS)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_RAYS) uniform usamplerBuffer sdfgi_rays_view;
#define sdfgi_rays_at(i) texelFetch(sdfgi_rays_view, int(i)).x
#else
#define sdfgi_rays_at(i) sdfgi_rays[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SUMS)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_SUMS) uniform samplerBuffer sdfgi_sums_view;
#define sdfgi_sums_at(i) texelFetch(sdfgi_sums_view, int(i))
#else
#define sdfgi_sums_at(i) sdfgi_sums[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_PREVIOUS)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_PREVIOUS) uniform usamplerBuffer sdfgi_previous_view;
#define sdfgi_previous_at(i) texelFetch(sdfgi_previous_view, int(i)).xy
#else
#define sdfgi_previous_at(i) sdfgi_previous[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_MASKS)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_MASKS) uniform usamplerBuffer sdfgi_masks_view;
#define sdfgi_masks_at(i) texelFetch(sdfgi_masks_view, int(i)).x
#else
#define sdfgi_masks_at(i) sdfgi_masks[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_OCCLUSION)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_OCCLUSION) uniform usamplerBuffer sdfgi_occlusion_view;
#define sdfgi_occlusion_at(i) texelFetch(sdfgi_occlusion_view, int(i)).x
#else
#define sdfgi_occlusion_at(i) sdfgi_occlusion[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_GATHERED)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_GATHERED) uniform usamplerBuffer sdfgi_gathered_view;
#define sdfgi_gathered_at(i) texelFetch(sdfgi_gathered_view, int(i)).x
#else
#define sdfgi_gathered_at(i) sdfgi_gathered[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_EMITTERS)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_EMITTERS) uniform usamplerBuffer sdfgi_emitters_view;
#define sdfgi_emitters_at(i) texelFetch(sdfgi_emitters_view, int(i)).x
#else
#define sdfgi_emitters_at(i) sdfgi_emitters[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SEEN)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_SEEN) uniform usamplerBuffer sdfgi_seen_view;
#define sdfgi_seen_at(i) texelFetch(sdfgi_seen_view, int(i)).x
#else
#define sdfgi_seen_at(i) sdfgi_seen[i]
#endif

#if defined(SDFGI_SOFTWARE) && !defined(SDFGI_WRITES_SEARCH)
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_SEARCH) uniform usamplerBuffer sdfgi_search_view;
#define sdfgi_search_at(i) texelFetch(sdfgi_search_view, int(i)).x
#else
#define sdfgi_search_at(i) sdfgi_search[i]
#endif

/* ---- What the host writes. A light is four texels, a material seven, and an instance 16, behind the list of
 * draws. */

#ifdef SDFGI_SOFTWARE
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_LIGHTS) uniform usamplerBuffer sdfgi_lights_view;
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_MATERIALS) uniform usamplerBuffer sdfgi_materials_view;
layout(set = SDFGI_SET_WORK,
       binding = SDFGI_BINDING_TEXELS + SDFGI_BINDING_INSTANCES) uniform usamplerBuffer sdfgi_instances_view;
#define sdfgi_draws_at(i) texelFetch(sdfgi_instances_view, int(i)).x

sdfgi_light_params sdfgi_lights_at(uint i)
{
    uvec4 t[4];
    for (int k = 0; k < 4; k++)
        t[k] = texelFetch(sdfgi_lights_view, int(4u * i) + k);
    return sdfgi_light_params(uintBitsToFloat(t[0].xyz), uintBitsToFloat(t[0].w), uintBitsToFloat(t[1].xyz),
                              uintBitsToFloat(t[1].w), uintBitsToFloat(t[2].xyz), uintBitsToFloat(t[2].w),
                              t[3].x, t[3].y, t[3].z, t[3].w);
}

sdfgi_material_params sdfgi_materials_at(uint i)
{
    uvec4 t[7];
    for (int k = 0; k < 7; k++)
        t[k] = texelFetch(sdfgi_materials_view, int(7u * i) + k);
    return sdfgi_material_params(uintBitsToFloat(t[0].xyz), uintBitsToFloat(t[0].w),
                                 uintBitsToFloat(t[1].xyz), uintBitsToFloat(t[1].w),
                                 vec4[2](uintBitsToFloat(t[2]), uintBitsToFloat(t[3])),
                                 vec4[2](uintBitsToFloat(t[4]), uintBitsToFloat(t[5])), t[6].x,
                                 uintBitsToFloat(t[6].y), t[6].z, t[6].w);
}

sdfgi_instance_params sdfgi_instances_at(uint i)
{
    uvec4 t[4];
    for (int k = 0; k < 16; k++)
        t[k >> 2][k & 3] = sdfgi_draws_at(uint(SDFGI_MAX_DRAWS) + 16u * i + uint(k));
    return sdfgi_instance_params(uintBitsToFloat(t[0].xyz), t[0].w, uintBitsToFloat(t[1].xyz), t[1].w,
                                 uintBitsToFloat(t[2].xyz), t[2].w, ivec3(t[3].xyz), t[3].w);
}
#else
#define sdfgi_lights_at(i)    sdfgi_lights[i]
#define sdfgi_materials_at(i) sdfgi_materials[i]
#define sdfgi_draws_at(i)     sdfgi_draws[i]
#define sdfgi_instances_at(i) sdfgi_instances[i]
#endif

#endif

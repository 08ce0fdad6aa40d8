/* SPDX-License-Identifier: MIT
 * Finds the albedo blocks of a cascade in which something emits, in any order: emitter_list puts them in
 * order. One thread per block. */
#version 460
#extension GL_GOOGLE_include_directive : require
#define SDFGI_WRITES_EMISSION
#define SDFGI_WRITES_SCRATCH
#include "../lib/on_cpu.glsl"
#include "emitters.glsl"
#include "workgroup.glsl"

layout(local_size_x = SDFGI_GROUP_LINEAR) in;
SDFGI_PUSH(sdfgi_cascade_args);

bool is_to_be_listed(uint block)
{
    const uvec3 texel = sdfgi_albedo_block_texel(block);
    return emitter_shape_fill(sdfgi_emitters_at(emitter_shape_word(args.cascade, block))) > 0.0 &&
           sdfgi_cell_is_valid(args.cascade, sdfgi_cell_from_texel(args.cascade, texel));
}

void main()
{
    const uint block = workgroup_index() * SDFGI_GROUP_LINEAR + gl_LocalInvocationIndex;
    if (block >= sdfgi_albedo_block_count())
        return;
    const uint index = block + args.cascade * sdfgi_albedo_block_count();
    const uvec2 emission = sdfgi_emission_at(index);
    if (emission == uvec2(0u))
        return;
    sdfgi_emission[index].y = emission.y & ~SDFGI_EMISSION_IS_LISTED;
    if (emission.x != 0u && is_to_be_listed(block))
        sdfgi_scratch[SDFGI_SCRATCH_EMITTERS + atomicAdd(sdfgi_scratch[0], 1u)] = block;
}

/* SPDX-License-Identifier: MIT
 * The instance whose triangle a thread voxelises. */
#ifndef SDFGI_VOXELIZE_INSTANCE_GLSL
#define SDFGI_VOXELIZE_INSTANCE_GLSL

#include "pass.glsl"

SDFGI_PUSH(sdfgi_voxelize_args);

layout(std430, set = SDFGI_SET_WORK, binding = SDFGI_BINDING_INSTANCES) readonly buffer sdfgi_instances_buffer
{
    uint sdfgi_draws[SDFGI_MAX_DRAWS];
    sdfgi_instance_params sdfgi_instances[];
};

struct drawn_instance {
    vec4 rows[3]; /* object space to sub-voxels from the anchor: row-major 3x4 */
    ivec3 anchor; /* the sub-voxel of the cascade in which the instance's origin lies */
    uint material;
    bool reversed; /* once transformed, fronts are clockwise */
    bool checked;  /* its triangles have been checked in this frame */
};

drawn_instance drawn;

/* A place less the cascade's low corner, in parts of sub-voxels of cascade 0, becomes a whole number of
 * sub-voxels of the cascade and the rest as a fraction. It is rounded to parts of the cascade's sub-voxels,
 * alike wherever the cascade stands, because that enters as a whole number. Beyond 2^30 sub-voxels, where
 * nothing of an instance can be in the cascade, the place is clamped. */
ivec3 anchor_of(uvec3 place_low, ivec3 place_high, out vec3 rest)
{
    const int part = int(args.cascade) + 1, whole = part + SDFGI_PLACE_BITS - 1;
    uvec3 borrow, carry;
    uvec3 low = usubBorrow(place_low, uvec3(args.corner_low), borrow);
    ivec3 high = place_high - args.corner_high - ivec3(borrow);
    low = uaddCarry(low, uvec3(1u << uint(part - 1)), carry);
    high += ivec3(carry);
    const uint parts = 1u << uint(SDFGI_PLACE_BITS - 1);
    rest = vec3(low >> part & (parts - 1u)) / float(parts);
    const int most = 1 << (whole - 2);
    high = clamp(high, ivec3(-most), ivec3(most - 1));
    return high << (32 - whole) | ivec3(low >> whole);
}

/* Takes the instance that stands at `index` in this dispatch. */
void instance_load(uint index)
{
    const uint draw = sdfgi_draws_at(args.first_draw + index);
    const sdfgi_instance_params p = sdfgi_instances_at(draw & ~SDFGI_DRAW_CHECKED);
    const float scale = 1.0 / float(1u << args.cascade);
    vec3 rest;
    drawn.anchor = anchor_of(uvec3(p.place_low_x, p.place_low_y, p.place_low_z), p.place_high, rest);
    drawn.rows[0] = vec4(p.row_x * scale, rest.x);
    drawn.rows[1] = vec4(p.row_y * scale, rest.y);
    drawn.rows[2] = vec4(p.row_z * scale, rest.z);
    drawn.material = p.material & ~SDFGI_INSTANCE_REVERSED;
    drawn.reversed = (p.material & SDFGI_INSTANCE_REVERSED) != 0u;
    drawn.checked = (draw & SDFGI_DRAW_CHECKED) != 0u;
}

/* Bounds of the instance in sub-voxels from its anchor, as the host gave them for its mesh. */
void instance_bounds(out vec3 low, out vec3 high)
{
    for (int i = 0; i < 3; i++) {
        const vec3 a = drawn.rows[i].xyz * args.bounds_min, b = drawn.rows[i].xyz * args.bounds_max,
                   least = min(a, b), most = max(a, b);
        low[i] = drawn.rows[i].w + least.x + least.y + least.z;
        high[i] = drawn.rows[i].w + most.x + most.y + most.z;
    }
}

#endif

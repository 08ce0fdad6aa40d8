/* SPDX-License-Identifier: MIT
 * Fog in front of what is drawn, from the froxels that fog_integrate.comp has filled. Needs host_frame.glsl.
 */
#include "host/host_fog_space.glsl"

layout(set = HOST_SET_FRAME, binding = HOST_FOG_BINDING) uniform sampler3D fog_volume;

/* What is left of the radiance of something, seen through fog. `offset` leads to it from the start of its
 * ray. Froxels tell the mean of what the fog on the way scatters; how much fog there is follows exactly. */
vec3 fog_before(vec3 radiance, vec3 offset)
{
    if (frame.fog_density.x == 0.0)
        return radiance;
    const float distance_m = max(dot(frame.camera_forward.xyz, offset), 1e-6);
    const float near_m = min(distance_m, frame.fog_slices.z);
    const vec3 ray = offset / distance_m, size = vec3(textureSize(fog_volume, 0)),
               eye = camera_ray_start(2.0 * gl_FragCoord.xy / frame.fog_grid.xy - 1.0);
    const vec2 at = (gl_FragCoord.xy / frame.fog_grid.z + 0.5) / size.xy;
    /* Texel k holds what is seen at the far side of slice k. */
    const float texel = clamp(fog_slice(near_m) - 0.5, 0.5, float(HOST_FOG_SLICES) - 0.5);
    const vec4 fog = textureLod(fog_volume, vec3(at, texel / size.z), 0.0);
    const vec3 mean = fog.a > 0.0 ? fog.rgb / fog.a : vec3(0.0);
    /* Beyond the grid light is that of its far end, which the last texel holds. */
    const vec3 beyond = textureLod(fog_volume, vec3(at, 1.0), 0.0).rgb;
    const float through_near = exp(-fog_optical_depth(eye, eye + near_m * ray)),
                through_far = exp(-fog_optical_depth(eye + near_m * ray, eye + offset));
    const vec3 scattered = (1.0 - through_near) * mean + through_near * (1.0 - through_far) * beyond;
    return radiance * (through_near * through_far) + scattered / frame.fog_density.w;
}

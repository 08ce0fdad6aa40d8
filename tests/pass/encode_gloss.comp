/* SPDX-License-Identifier: MIT
 * Per element: cosine to the viewer, alpha and f0; the directional albedo of the host's specular lobe in w.
 */
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../../shaders/host/host_brdf.glsl"

layout(local_size_x = 64) in;
layout(std430, set = 1, binding = 0) buffer data_buffer
{
    vec4 data[];
};
layout(push_constant) uniform push
{
    uint count;
};

void main()
{
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count)
        return;
    const vec4 d = data[i];
    const vec3 view = vec3(sqrt(max(1.0 - d.x * d.x, 0.0)), 0.0, d.x);
    data[i].w =
        brdf_specular_albedo(brdf_surface(vec3(0.0, 0.0, 1.0), view, vec3(0.0), vec3(d.z), d.y, 1.0)).x;
}

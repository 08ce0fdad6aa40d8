/* SPDX-License-Identifier: MIT
 * A host's lookups in HLSL, with the include that docs/integration.md makes. Per point four rows of four
 * floats: position, normal, the way to the eye. The answers take their places. */
#include "sdfgi.hlsl"

RWByteAddressBuffer points : register(u0, space1);
struct push_constants
{
    uint count;
};
[[vk::push_constant]] ConstantBuffer<push_constants> push;

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    const uint row = 64u * id.x;
    if (id.x >= push.count)
        return;
    const float3 position = asfloat(points.Load3(row)), normal = asfloat(points.Load3(row + 16u)),
                 to_eye = asfloat(points.Load3(row + 32u));
    const sdfgi_surface_light mirrored = sdfgi_lighting(position, normal, to_eye, 0.1);
    points.Store3(row, asuint(mirrored.irradiance));
    points.Store3(row + 16u, asuint(sdfgi_irradiance_air(position, normal)));
    points.Store4(row + 32u, asuint(float4(mirrored.reflection, mirrored.distance_m)));
}

/* SPDX-License-Identifier: MIT */
#include "host_albedo.h"

/* As in host_brdf.glsl: reflectance of a dielectric along its normal, and the share of even light that gets
 * through its interface: 1 - (f0 + (1 - f0) / 21), the mean of Schlick's term over all directions. */
static const float DIELECTRIC_F0 = 0.04f, TRANSMITTED = 0.9143f;

/* Share of even light that the specular lobe sends back: a fit to the mean of brdf_specular_albedo over all
 * directions, within 0.01. Rough facets see little of Fresnel's rise, and send light to one another. */
static float specular_albedo(float f0, float roughness)
{
    const float rise = 0.055f * (1 - roughness), lost = 0.6f * roughness * roughness;
    return (f0 + (1 - f0) * rise) * (1 - lost * (1 - f0));
}

struct host_albedo host_albedo_of(const float base_color[static 3], float metallic, float roughness)
{
    struct host_albedo albedo = { .specular = (1 - metallic) * specular_albedo(DIELECTRIC_F0, roughness) };
    for (int i = 0; i < 3; i++)
        albedo.color[i] = (1 - metallic) * TRANSMITTED * base_color[i] +
                          metallic * specular_albedo(base_color[i], roughness);
    return albedo;
}

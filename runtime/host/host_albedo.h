/* SPDX-License-Identifier: MIT
 * What the library is told of a surface's reflectance. To it all light that a surface sends back is diffuse.
 */
#ifndef HOST_ALBEDO_H
#define HOST_ALBEDO_H

struct host_albedo {
    float color[3]; /* share of even light that metal and what is below an interface send back, [0, 1] */
    float specular; /* share that a dielectric's interface sends back, of any colour, [0, 1] */
};

/* `roughness` and `metallic` in [0, 1]. */
struct host_albedo host_albedo_of(const float base_color[static 3], float metallic, float roughness);

#endif

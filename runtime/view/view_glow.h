/* SPDX-License-Identifier: MIT
 * How much light a scene's own emission makes. */
#ifndef RUNTIME_VIEW_GLOW_H
#define RUNTIME_VIEW_GLOW_H

struct gltf_scene;

/* What all emitters brighter than 1 W/(m^2 sr) send out together, W, over the area of all surfaces, m^2: a
 * mean irradiance, in which each emissive texture counts by its mean. */
double view_glow_irradiance(const struct gltf_scene *scene);

#endif

/* SPDX-License-Identifier: MIT */
#include "view_glow.h"

#include <base/vec.h>
#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
/* Texels of a texture that its mean is made of, and triangles of a scene that its area is made of. */
enum { TEXELS_READ = 4096, TRIANGLES_READ = 1 << 20 };

static double luminance(const double c[3])
{
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

/* Near enough to sRGB's curve for a mean. */
static double linear(uint8_t srgb)
{
    const double x = srgb / 255.0;
    return x * x * (0.7 + 0.3 * x);
}

static void texture_mean(const struct gltf_image *image, double mean[3])
{
    const uint64_t count = (uint64_t)image->width * image->height, step = count / TEXELS_READ + 1;
    uint64_t read = 0;
    for (int c = 0; c < 3; c++)
        mean[c] = 0;
    for (uint64_t i = 0; i < count; i += step, read++)
        for (int c = 0; c < 3; c++)
            mean[c] += linear(image->texels[4 * i + (uint64_t)c]);
    for (int c = 0; c < 3; c++)
        mean[c] /= (double)read;
}

/* Without KHR_materials_emissive_strength nothing is brighter, and nothing is meant to light a room: screens,
 * labels, the lamps of a car. */
static const double lamp_radiance = 1;

/* Mean radiance that leaves the material, if it is a lamp's. */
static double glow_of(const struct gltf_scene *scene, const struct gltf_material *material)
{
    double color[3];
    for (int c = 0; c < 3; c++)
        color[c] = (double)material->emissive[c];
    if (!(fmax(fmax(color[0], color[1]), color[2]) > lamp_radiance))
        return 0;
    if (material->emissive_texture.texture < 0)
        return luminance(color);
    double mean[3];
    texture_mean(&scene->images[scene->textures[material->emissive_texture.texture].image], mean);
    for (int c = 0; c < 3; c++)
        color[c] *= mean[c];
    return luminance(color);
}

static double triangle_area(const struct gltf_instance *instance, const struct gltf_primitive *p,
                            const uint32_t *corners)
{
    const double *const m = instance->transform;
    double world[3][3], a[3], b[3], normal[3];
    for (int k = 0; k < 3; k++) {
        const float *const v = p->positions + 3 * (size_t)corners[k];
        for (int i = 0; i < 3; i++)
            world[k][i] = m[i] * (double)v[0] + m[4 + i] * (double)v[1] + m[8 + i] * (double)v[2];
    }
    base_vec3d_sub(world[1], world[0], a);
    base_vec3d_sub(world[2], world[0], b);
    base_vec3d_cross(a, b, normal);
    return base_vec3d_length(normal) / 2;
}

static uint64_t triangle_count(const struct gltf_scene *scene)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        count += scene->primitives[scene->instances[i].primitive].index_count / 3;
    return count;
}

double view_glow_irradiance(const struct gltf_scene *scene)
{
    const uint64_t step = triangle_count(scene) / TRIANGLES_READ + 1;
    double area = 0, power = 0;
    uint64_t turn = 0;
    double *const glow = calloc((size_t)scene->material_count + 1, sizeof *glow);
    for (uint32_t i = 0; glow && i < scene->material_count; i++)
        glow[i] = glow_of(scene, &scene->materials[i]);
    for (uint32_t i = 0; glow && i < scene->instance_count; i++) {
        const struct gltf_instance *const instance = &scene->instances[i];
        const struct gltf_primitive *const p = &scene->primitives[instance->primitive];
        for (uint32_t k = 0; k + 2 < p->index_count; k += 3) {
            if (turn++ % step != 0)
                continue;
            const double part = triangle_area(instance, p, p->indices + k);
            area += part;
            power += pi * part * glow[p->material];
        }
    }
    free(glow);
    return area > 0 ? power / area : 0;
}

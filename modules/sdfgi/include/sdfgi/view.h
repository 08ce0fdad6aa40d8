/* SPDX-License-Identifier: MIT
 * Views: what belongs to one picture. A view holds the pictures of light that it resolves, and what it needs
 * to make them. Each eye and each part of a split screen has a view of its own; all views of a context share
 * its volumes, so that an update serves them all. Conventions as in sdfgi.h, which includes this. */
#ifndef SDFGI_VIEW_H
#define SDFGI_VIEW_H

#include <sdfgi/sdfgi.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sdfgi_view sdfgi_view;

struct sdfgi_view_desc {
    uint32_t width, height; /* pixels: 1 to the device's maxImageDimension2D */
    /* At which diffuse light is looked up, and at which rays are sent; 0: SDFGI_GATHER_FULL. Reflections
     * interpolate as sdfgi_gather does, but by surface alone: edges of surfaces stay sharp, and those of what
     * a mirror shows are softer by two or four pixels. */
    enum sdfgi_gather_resolution diffuse, reflection;
    bool reflections; /* makes what reflections need at once, so that no resolve has to */
};

/* Creates a view: its picture of diffuse light takes 8 bytes a pixel. What reflections need, 20 bytes a
 * pixel, is added by the first sdfgi_view_resolve that asks for it while a material is smooth, unless
 * `reflections` asks for it here. */
SDFGI_API enum sdfgi_result sdfgi_view_create(sdfgi *gi, const struct sdfgi_view_desc *desc,
                                              sdfgi_view **out);

/* Destroys a view once no frame in flight can use it. NULL is accepted. sdfgi_destroy destroys all views. */
SDFGI_API void sdfgi_view_destroy(sdfgi *gi, sdfgi_view *view);

/* What the host has drawn of the picture. Depth and normal as in struct sdfgi_gather_desc. */
struct sdfgi_resolve_desc {
    VkImageView depth, normal;
    /* Any sampled float. Red: roughness in [0, 1], and that of metal times -1. VK_NULL_HANDLE: no
     * reflections. A view of the normals that maps alpha to red will do. What is rough reflects more of what
     * comes at a small angle, but metal its irradiance; all that is not below 0 counts as dielectric. */
    VkImageView roughness;
    VkImageLayout input_layout;        /* of these; UNDEFINED (0): SHADER_READ_ONLY_OPTIMAL */
    float inverse_view_projection[16]; /* as in struct sdfgi_gather_desc */
    float background_depth;            /* pixels with exactly this depth get 0 */
    float scale;                       /* factor on light, >= 0 and finite; 0 means 1 */
};

/* Records the resolve of a picture into `cmd`, after sdfgi_update in the same queue. Synchronisation is that
 * of sdfgi_gather, and so is what it does while GI is not active. Reflections are made only while a material
 * with a roughness (1 - `smoothness`) below sdfgi_settings::reflection_end is registered: rays run only in
 * tiles of 8 x 8 pixels that show something as smooth. Settings are those of the last sdfgi_update. */
SDFGI_API enum sdfgi_result sdfgi_view_resolve(sdfgi *gi, sdfgi_view *view, VkCommandBuffer cmd,
                                               const struct sdfgi_resolve_desc *desc);

/* Pictures of a view, R16G16B16A16_SFLOAT in VK_IMAGE_LAYOUT_GENERAL, as the last resolve has left them. They
 * live as long as the view. */
struct sdfgi_view_images {
    VkImageView diffuse;    /* rgb: irradiance E, W/m^2, not times albedo */
    VkImageView reflection; /* rgb: radiance, W/(m^2 sr), the mean over the specular lobe, where
                               surfaces that are not metal reflect more at small angles: times the
                               directional albedo of the specular BRDF it is reflected light. a: metres to
                               what is reflected, 65504 for the sky, 0 where a surface is too rough for a ray.
                               VK_NULL_HANDLE: the last resolve made none; all surfaces reflect E / pi */
};

SDFGI_API void sdfgi_view_get_images(const sdfgi_view *view, struct sdfgi_view_images *images);

#ifdef __cplusplus
}
#endif
#endif

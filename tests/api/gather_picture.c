/* SPDX-License-Identifier: MIT */
#include "gather_picture.h"

#include "require.h"
#include "test_memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void picture_scene_show(struct picture_scene *scene, struct test_mesh mesh)
{
    REQUIRE_CMP(scene->count, <, (int)PICTURE_MAX_OBJECTS);
    scene->objects[scene->count++] = mesh;
}

void picture_scene_add(struct picture_scene *scene, struct gi_test *t, struct test_mesh mesh, float albedo,
                       float emission)
{
    const sdfgi_material material =
        gi_test_material(t, (float[]){ albedo, albedo, albedo }, (float[]){ emission, emission, emission });
    gi_test_add(t, &mesh, material);
    picture_scene_show(scene, mesh);
}

void picture_scene_finish(struct picture_scene *scene)
{
    for (int i = 0; i < scene->count; i++)
        test_mesh_destroy(&scene->objects[i]);
}

/* ---- Rays */

struct hit {
    double range; /* in lengths of the ray's direction */
    double normal[3];
    int object;
};

static double dot(const double a[static 3], const double b[static 3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[static 3], const double b[static 3], double out[static 3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Moeller and Trumbore, 1997. Both sides are seen; the normal faces the viewer. */
static void meet_triangle(const struct test_mesh *mesh, uint32_t triangle, const double origin[static 3],
                          const double direction[static 3], int object, struct hit *hit)
{
    double a[3], u_edge[3], v_edge[3], from_a[3], p[3], q[3], normal[3];
    const uint32_t *corner = &mesh->indices[3 * triangle];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)mesh->positions[3 * corner[0] + k];
        u_edge[k] = (double)mesh->positions[3 * corner[1] + k] - a[k];
        v_edge[k] = (double)mesh->positions[3 * corner[2] + k] - a[k];
        from_a[k] = origin[k] - a[k];
    }
    cross(direction, v_edge, p);
    cross(from_a, u_edge, q);
    const double determinant = dot(u_edge, p);
    if (fabs(determinant) < 1e-12)
        return;
    const double u = dot(from_a, p) / determinant, v = dot(direction, q) / determinant,
                 range = dot(v_edge, q) / determinant;
    if (u < 0 || v < 0 || u + v > 1 || range < 1 || range >= hit->range)
        return;
    cross(u_edge, v_edge, normal);
    const double length = sqrt(dot(normal, normal)) * (dot(normal, direction) > 0 ? -1 : 1);
    *hit = (struct hit){ range, { normal[0] / length, normal[1] / length, normal[2] / length }, object };
}

static struct hit meet_scene(const struct picture_scene *scene, const double origin[static 3],
                             const double direction[static 3])
{
    struct hit hit = { .range = INFINITY, .object = PICTURE_NOTHING };
    for (int i = 0; i < scene->count; i++)
        for (uint32_t k = 0; k < scene->objects[i].triangle_count; k++)
            meet_triangle(&scene->objects[i], k, origin, direction, i, &hit);
    return hit;
}

/* ---- Pictures */

/* Columns: a clip position (x, y, z, 1) goes to (z camera + near (x right tan_x - y up tan_y + forward), z).
 */
static void fill_matrix(const struct picture_camera *c, float m[static 16])
{
    for (int k = 0; k < 3; k++) {
        m[k] = (float)(c->near_m * c->tan_x * c->right[k]);
        m[4 + k] = (float)(-c->near_m * c->tan_y * c->up[k]);
        m[8 + k] = (float)c->position[k];
        m[12 + k] = (float)(c->near_m * c->forward[k]);
    }
    m[3] = m[7] = m[15] = 0;
    m[11] = 1;
}

struct picture picture_draw(const struct picture_scene *scene, const struct picture_camera *c, uint32_t width,
                            uint32_t height)
{
    const uint32_t pixels = width * height;
    struct picture p = { .width = width,
                         .height = height,
                         .depth = test_array_alloc(pixels, sizeof *p.depth),
                         .normals = test_array_alloc(pixels, sizeof *p.normals),
                         .objects = test_array_alloc(pixels, sizeof *p.objects) };
    fill_matrix(c, p.desc.inverse_view_projection);
    p.desc.width = width;
    p.desc.height = height;
    for (uint32_t i = 0; i < pixels; i++) {
        const double x = 2 * (i % width + 0.5) / width - 1, y = 2 * (i / width + 0.5) / height - 1;
        double ray[3];
        for (int k = 0; k < 3; k++)
            ray[k] = c->near_m * (x * c->tan_x * c->right[k] - y * c->tan_y * c->up[k] + c->forward[k]);
        const struct hit hit = meet_scene(scene, c->position, ray);
        p.depth[i] = (float)(1 / hit.range);
        p.objects[i] = hit.object;
        for (int k = 0; k < 4; k++)
            p.normals[i][k] = k < 3 ? (float)hit.normal[k] : 0;
    }
    return p;
}

void picture_finish(struct picture *picture)
{
    free(picture->depth);
    free(picture->normals);
    free(picture->objects);
}

/* ---- Gathers */

float (*picture_gather(struct gi_test *t, const struct picture *p,
                       enum sdfgi_gather_resolution resolution))[3]
{
    const uint32_t pixels = p->width * p->height;
    uint16_t(*halves)[4] = test_array_alloc(pixels, sizeof *halves);
    float(*light)[3] = test_array_alloc(pixels, sizeof *light);
    struct gpu_test_image depth =
                              gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, p->width, p->height, p->depth),
                          normal = gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, p->width,
                                                        p->height, p->normals),
                          output = gi_test_gather_image(t, VK_FORMAT_R16G16B16A16_SFLOAT, 8, p->width,
                                                        p->height, NULL);
    struct sdfgi_gather_desc desc = p->desc;
    desc.depth = depth.view;
    desc.normal = normal.view;
    desc.output = output.view;
    desc.resolution = resolution;
    gi_test_gather(t, &desc);
    gpu_test_image_read(&t->gpu, output.image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        output.extent, 8, halves);
    for (uint32_t i = 0; i < 3 * pixels; i++)
        light[i / 3][i % 3] = gi_test_half(halves[i / 3][i % 3]);
    gpu_test_image_destroy(&t->gpu, &depth);
    gpu_test_image_destroy(&t->gpu, &normal);
    gpu_test_image_destroy(&t->gpu, &output);
    free(halves);
    return light;
}

void picture_reflect(struct gi_test *t, const struct picture *p, const float *roughness,
                     uint16_t (*texels)[4])
{
    struct gpu_test_image images[] = {
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, p->width, p->height, p->depth),
        gi_test_gather_image(t, VK_FORMAT_R32G32B32A32_SFLOAT, 16, p->width, p->height, p->normals),
        gi_test_gather_image(t, VK_FORMAT_R32_SFLOAT, 4, p->width, p->height, roughness),
    };
    struct sdfgi_resolve_desc desc = { .depth = images[0].view,
                                       .normal = images[1].view,
                                       .roughness = images[2].view,
                                       .background_depth = p->desc.background_depth };
    memcpy(desc.inverse_view_projection, p->desc.inverse_view_projection,
           sizeof desc.inverse_view_projection);
    const struct sdfgi_view_desc size = { .width = p->width, .height = p->height };
    sdfgi_view *view = NULL;
    REQUIRE_CMP((int)sdfgi_view_create(t->gi, &size, &view), ==, (int)SDFGI_OK);
    gi_test_resolve(t, view, &desc);
    gpu_test_image_read(&t->gpu, view->reflection.handle, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_ASPECT_COLOR_BIT,
                        (VkExtent3D){ p->width, p->height, 1 }, 8, texels);
    for (int i = 0; i < 3; i++)
        gpu_test_image_destroy(&t->gpu, &images[i]);
    sdfgi_view_destroy(t->gi, view);
}

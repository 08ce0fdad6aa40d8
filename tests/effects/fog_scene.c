/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "fog_scene.h"

#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <string.h>

enum { MAX_BOXES = 16, VERTICES = 24, INDICES = 36, MAX_FRAMES = 16 };

/* A cube of side 1, which all boxes share, with a primitive and a material for each. */
struct cube {
    float positions[VERTICES][3], normals[VERTICES][3], tangents[VERTICES][4], uv[VERTICES][2];
    uint32_t indices[INDICES];
};

static void cube_fill(struct cube *cube)
{
    static const uint32_t corners[6] = { 0, 1, 2, 0, 2, 3 };
    *cube = (struct cube){ 0 };
    for (uint32_t face = 0; face < 6; face++) {
        const uint32_t axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        const float side = face % 2 ? -1.0f : 1.0f;
        for (uint32_t i = 0; i < 4; i++) {
            float *p = cube->positions[4 * face + i];
            p[axis] = 0.5f * side;
            p[u] = 0.5f * side * (i == 1 || i == 2 ? 1.0f : -1.0f);
            p[v] = i >= 2 ? 0.5f : -0.5f;
            cube->normals[4 * face + i][axis] = side;
            cube->tangents[4 * face + i][u] = cube->tangents[4 * face + i][3] = 1.0f;
        }
        for (uint32_t i = 0; i < 6; i++)
            cube->indices[6 * face + i] = 4 * face + corners[i];
    }
}

static struct gltf_material material_of(const struct fog_box *box)
{
    const struct gltf_texture_ref none = { .texture = -1 };
    struct gltf_material m = { .roughness = 1 - box->smoothness,
                               .metallic = box->metal,
                               .normal_scale = 1,
                               .emissive = { box->emission, box->emission, box->emission },
                               .alpha_mode = box->color[3] < 1 ? GLTF_ALPHA_BLEND : GLTF_ALPHA_OPAQUE,
                               .base_color_texture = none,
                               .metallic_roughness_texture = none,
                               .normal_texture = none,
                               .occlusion_texture = none,
                               .emissive_texture = none };
    memcpy(m.base_color, box->color, sizeof m.base_color);
    return m;
}

static struct gltf_instance instance_of(const struct fog_box *box, uint32_t index)
{
    struct gltf_instance instance = { .primitive = index, .transform = { [15] = 1 } };
    for (int i = 0; i < 3; i++) {
        instance.transform[5 * i] = box->size[i];
        instance.transform[12 + i] = box->center[i];
    }
    return instance;
}

static struct host_scene *scene_create(struct host_device *device, const struct fog_scene *scene)
{
    static struct cube cube;
    struct gltf_material materials[MAX_BOXES];
    struct gltf_primitive primitives[MAX_BOXES];
    struct gltf_instance instances[MAX_BOXES];
    cube_fill(&cube);
    assert_in_range(scene->box_count, 0, MAX_BOXES);
    for (uint32_t i = 0; i < scene->box_count; i++) {
        materials[i] = material_of(&scene->boxes[i]);
        instances[i] = instance_of(&scene->boxes[i], i);
        primitives[i] = (struct gltf_primitive){ .vertex_count = VERTICES,
                                                 .index_count = INDICES,
                                                 .positions = &cube.positions[0][0],
                                                 .normals = &cube.normals[0][0],
                                                 .tangents = &cube.tangents[0][0],
                                                 .uv0 = &cube.uv[0][0],
                                                 .indices = cube.indices,
                                                 .material = (int32_t)i,
                                                 .bounds_min = { -0.5f, -0.5f, -0.5f },
                                                 .bounds_max = { 0.5f, 0.5f, 0.5f } };
    }
    const struct gltf_scene gltf = { .materials = materials,
                                     .primitives = primitives,
                                     .instances = instances,
                                     .material_count = scene->box_count,
                                     .primitive_count = scene->box_count,
                                     .instance_count = scene->box_count };
    return host_scene_create(device, &gltf, &scene->view);
}

struct fog_scene fog_scene_empty(float density)
{
    struct fog_scene scene = { 0 };
    host_view_default(&scene.view);
    memset(scene.view.camera.position, 0, sizeof scene.view.camera.position);
    scene.view.camera.look_at[2] = -1;
    scene.view.materials = HOST_MATERIALS_LAMBERT;
    scene.view.fog = (struct host_fog){ .density = density, .albedo = { 1, 1, 1 } };
    return scene;
}

void fog_stage_open(struct fog_stage *stage, struct host_device *device, const struct fog_scene *scene)
{
    const enum host_lookup lookup = scene->forward ? HOST_LOOKUP_FORWARD : HOST_LOOKUP_FULL;
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    settings.enabled = scene->gi;
    settings.cascades = 1;
    settings.resolution = 32;
    settings.min_cell_size_m = 0.25f;
    settings.ray_count = 64;
    settings.cell_rays = 64;
    settings.frames_to_converge = 4;
    const struct host_renderer_desc desc = {
        .width = scene->eye_distance_m > 0 ? 2 * FOG_WIDTH : FOG_WIDTH,
        .height = FOG_HEIGHT,
        .supersample = scene->supersample,
        .settings = &settings,
        .lookups = { lookup, lookup },
        .eye_distance_m = scene->eye_distance_m,
    };
    const struct host_until_desc until = { .frames = scene->frames, .max_frames = MAX_FRAMES };
    stage->camera = scene->view.camera;
    stage->scene = scene_create(device, scene);
    stage->renderer = stage->scene ? host_renderer_create(device, stage->scene, &desc) : NULL;
    if (!stage->renderer || !host_render_until(stage->renderer, &stage->camera, &until, NULL))
        fail_msg("%s", host_device_error(device));
}

void fog_stage_close(struct fog_stage *stage)
{
    host_renderer_destroy(stage->renderer);
    host_scene_destroy(stage->scene);
}

void fog_stage_read(struct fog_stage *stage, float rgba[4 * FOG_PIXELS])
{
    assert_true(host_renderer_read_aov(stage->renderer, HOST_AOV_COLOR, rgba));
    for (int i = 0; i < 4 * FOG_PIXELS; i++)
        assert_true(isfinite(rgba[i]));
}

void fog_scene_draw(struct host_device *device, const struct fog_scene *scene, float rgba[4 * FOG_PIXELS])
{
    struct fog_stage stage;
    fog_stage_open(&stage, device, scene);
    fog_stage_read(&stage, rgba);
    fog_stage_close(&stage);
}

void fog_ray(const struct host_view *view, int x, int y, double ray[3])
{
    const double tan_y = tan((double)view->camera.yfov_rad / 2);
    const double right = ((x + 0.5) / FOG_WIDTH * 2 - 1) * tan_y * FOG_WIDTH / FOG_HEIGHT,
                 up = (1 - (y + 0.5) / FOG_HEIGHT * 2) * tan_y;
    const double rise = view->camera.look_at[1], length = sqrt(1 + rise * rise);
    ray[0] = right;
    ray[1] = (rise + up) / length;
    ray[2] = (rise * up - 1) / length;
}

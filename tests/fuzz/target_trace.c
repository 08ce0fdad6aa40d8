/* SPDX-License-Identifier: MIT
 * What the importer lets through is traced: a few paths through the scene, as its own camera sees it. */
#include "fuzz.h"

#include "gltf_scene.h"
#include "raycast.h"
#include "require.h"
#include "view/view_file.h"

enum { SIDE = 4, INDICES_MAX = 30000 };

static bool is_small(const struct gltf_scene *scene)
{
    uint64_t indices = 0;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        indices += scene->primitives[scene->instances[i].primitive].index_count;
    return indices <= INDICES_MAX;
}

static struct raycast_view view_of(const struct gltf_scene *scene)
{
    struct host_view from;
    struct raycast_view to = { .punctual_scale = 1,
                               .emissive_scale = 1,
                               .sky = { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } },
                               .sun = { { 0, -1, 0 }, { 1, 1, 1 }, 0 },
                               .default_albedo = { 0.5f, 0.5f, 0.5f } };
    view_file_from_scene(scene, 1, &from);
    memcpy(to.camera.position, from.camera.position, sizeof to.camera.position);
    memcpy(to.camera.look_at, from.camera.look_at, sizeof to.camera.look_at);
    memcpy(to.camera.up, from.camera.up, sizeof to.camera.up);
    to.camera.yfov_deg = (float)((double)from.camera.yfov_rad * 57.29577951308232);
    to.camera.ymag_m = from.camera.ymag_m;
    to.camera.znear_m = from.camera.znear_m;
    to.camera.zfar_m = from.camera.zfar_m;
    return to;
}

/* A camera so far away that it cannot look anywhere is refused. */
static void trace(const struct gltf_scene *scene)
{
    char error[256] = "";
    float picture[3 * SIDE * SIDE];
    const struct raycast_settings settings = {
        .width = SIDE, .height = SIDE, .threads = 1, .max_bounces = 8
    };
    const struct raycast_view view = view_of(scene);
    struct raycast *const rc = raycast_create(scene, &view, &settings, error, sizeof error);
    if (!rc) {
        REQUIRE_TRUE(error[0] != '\0');
        return;
    }
    raycast_render(rc, &(struct raycast_budget){ .samples = 2 }, NULL, NULL, NULL);
    REQUIRE_TRUE(raycast_image(rc, RAYCAST_AOV_RADIANCE, picture));
    for (int i = 0; i < 3 * SIDE * SIDE; i++)
        REQUIRE_TRUE(picture[i] >= 0);
    raycast_destroy(rc);
}

static bool read_scene(const char *path, char *error, size_t error_size)
{
    struct gltf_scene *const scene = gltf_scene_load(path, error, error_size);
    if (!scene)
        return false;
    if (is_small(scene))
        trace(scene);
    gltf_scene_destroy(scene);
    return true;
}

const struct fuzz_target fuzz_trace = { ".glb", read_scene, fuzz_glb_mutate, fuzz_glb_mend };

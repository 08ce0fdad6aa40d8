/* SPDX-License-Identifier: MIT */
#include "api_world.h"

#include "require.h"

#include <math.h>

uint32_t api_below(struct api_world *world, uint32_t limit)
{
    return test_random_uint(&world->random) % limit;
}

static void require_ok(enum sdfgi_result result)
{
    REQUIRE_CMP((int)result, ==, (int)SDFGI_OK);
}

static void forget(struct api_stale *stale, uint32_t id)
{
    stale->ids[stale->count++ % API_STALE] = id;
}

/* ---- Descriptions ----------------------------------------------------------------------------------- */

static void random_color(struct test_random *random, double most, float color[static 3])
{
    for (int i = 0; i < 3; i++)
        color[i] = (float)test_random_real(random, 0, most);
}

struct sdfgi_material_desc api_random_material(struct test_random *random)
{
    struct sdfgi_material_desc desc = { .alpha = 1 };
    random_color(random, 0.9, desc.albedo);
    /* No brighter: the unit of emission grows with the brightest one ever, and does not shrink again. */
    if (test_random_uint(random) % 4 == 0)
        random_color(random, 3, desc.emission);
    desc.specular_albedo = test_random_uint(random) % 4 == 0 ? 0.08f : 0;
    desc.metallic = test_random_uint(random) % 4 == 0 ? 1 : 0;
    desc.smoothness = (float)test_random_real(random, 0, 1);
    desc.double_sided_emission = test_random_uint(random) % 2;
    if (test_random_uint(random) % 8 == 0)
        desc.alpha_cutoff = 0.5f;
    return desc;
}

struct sdfgi_light_desc api_random_light(struct test_random *random)
{
    struct sdfgi_light_desc desc = { .type = (enum sdfgi_light_type)(test_random_uint(random) % 3),
                                     .inner_angle_rad = 0.2f,
                                     .outer_angle_rad = 0.9f,
                                     .indirect_energy = (float)test_random_real(random, 0.5, 2),
                                     .casts_shadow = test_random_uint(random) % 8 != 0 };
    double direction[3];
    test_random_direction(random, direction);
    random_color(random, desc.type == SDFGI_LIGHT_DIRECTIONAL ? 3 : 20, desc.intensity);
    for (int i = 0; i < 3; i++) {
        desc.direction[i] = (float)direction[i];
        desc.position[i] = test_random_real(random, -4, 4);
    }
    if (test_random_uint(random) % 3 == 0)
        desc.range_m = (float)test_random_real(random, 1, 6);
    return desc;
}

struct sdfgi_transform api_random_transform(struct test_random *random)
{
    double rotation[9], axis[3];
    test_random_direction(random, axis);
    test_rotation(axis, test_random_real(random, 0, 6), rotation);
    struct sdfgi_transform transform;
    const double size = test_random_real(random, 0.2, 1.8);
    for (int i = 0; i < 9; i++)
        transform.basis[i] = (float)(rotation[i] * size);
    if (test_random_uint(random) % 8 == 0) /* mirrored */
        for (int i = 0; i < 3; i++)
            transform.basis[i] = -transform.basis[i];
    for (int i = 0; i < 3; i++)
        transform.translation[i] = test_random_real(random, -5, 5);
    return transform;
}

struct sdfgi_settings api_settings(struct test_random *random)
{
    struct sdfgi_settings s = gi_test_settings();
    s.resolution = 32;
    s.cascades = 1 + test_random_uint(random) % 2;
    s.ray_count = 125;
    s.frames_to_converge = 4;
    s.cell_rays = 64;
    s.visibility =
        test_random_uint(random) % 4 == 0 ? SDFGI_VISIBILITY_PROBE_DEPTH : SDFGI_VISIBILITY_CELL_MASK;
    s.surface_light = test_random_uint(random) % 2 ? SDFGI_SURFACE_LIGHT_CELLS : SDFGI_SURFACE_LIGHT_PROBES;
    s.use_occlusion = test_random_uint(random) % 4 != 0;
    s.voxelizer = test_random_uint(random) % 4 == 0 ? SDFGI_VOXELIZER_RASTER : SDFGI_VOXELIZER_COMPUTE;
    s.sdf_method = test_random_uint(random) % 4 == 0 ? SDFGI_SDF_FLOOD : SDFGI_SDF_EXACT;
    s.y_scale = (enum sdfgi_y_scale)(test_random_uint(random) % 3);
    s.bounce_feedback = (float)test_random_real(random, 0, 1);
    s.energy = (float)test_random_real(random, 0.5, 2);
    return s;
}

/* ---- Objects ---------------------------------------------------------------------------------------- */

static void instance_gone(struct api_world *w, uint32_t slot)
{
    forget(&w->instances, w->scene.instances[slot].handle.id);
    w->scene.instances[slot].live = false;
}

/* A mesh that is there goes, with its instances; one that is not comes. */
static void toggle_mesh(struct api_world *w)
{
    const uint32_t slot = api_below(w, API_MESHES);
    if (!w->scene.meshes[slot].live) {
        w->scene.meshes[slot].shape = api_below(w, API_SHAPES);
        require_ok(sdfgi_mesh_create(w->t->gi, &w->device->shapes[w->scene.meshes[slot].shape],
                                     &w->scene.meshes[slot].handle));
        w->scene.meshes[slot].live = true;
        return;
    }
    if (api_below(w, 3) != 0)
        return;
    require_ok(sdfgi_mesh_destroy(w->t->gi, w->scene.meshes[slot].handle));
    forget(&w->meshes, w->scene.meshes[slot].handle.id);
    w->scene.meshes[slot].live = false;
    for (uint32_t i = 0; i < API_INSTANCES; i++)
        if (w->scene.instances[i].live && w->scene.instances[i].mesh == slot)
            instance_gone(w, i);
}

static bool is_used(const struct api_world *w, uint32_t material)
{
    for (uint32_t i = 0; i < API_INSTANCES; i++)
        if (w->scene.instances[i].live && w->scene.instances[i].material == material)
            return true;
    return false;
}

static struct sdfgi_material_desc any_material(struct api_world *w)
{
    struct sdfgi_material_desc desc = api_random_material(&w->random);
    if (api_below(w, 10) == 0)
        desc.albedo_texture.view = w->device->texture.view;
    return desc;
}

static void change_material(struct api_world *w)
{
    const uint32_t slot = api_below(w, API_MATERIALS);
    if (!w->scene.materials[slot].live) {
        w->scene.materials[slot].desc = any_material(w);
        require_ok(sdfgi_material_create(w->t->gi, &w->scene.materials[slot].desc,
                                         &w->scene.materials[slot].handle));
        w->scene.materials[slot].live = true;
        return;
    }
    if (api_below(w, 2)) {
        w->scene.materials[slot].desc = any_material(w);
        require_ok(
            sdfgi_material_update(w->t->gi, w->scene.materials[slot].handle, &w->scene.materials[slot].desc));
        return;
    }
    const enum sdfgi_result result = sdfgi_material_destroy(w->t->gi, w->scene.materials[slot].handle);
    if (is_used(w, slot)) {
        REQUIRE_CMP((int)result, ==, (int)SDFGI_ERROR_INVALID_ARGUMENT);
        return;
    }
    require_ok(result);
    forget(&w->materials, w->scene.materials[slot].handle.id);
    w->scene.materials[slot].live = false;
}

/* What is to be in a slot. False if the mesh or the material that it draws is not there. */
static bool describe_instance(struct api_world *w, uint32_t slot)
{
    const uint32_t mesh = api_below(w, API_MESHES), material = api_below(w, API_MATERIALS);
    if (!w->scene.meshes[mesh].live || !w->scene.materials[material].live)
        return false;
    w->scene.instances[slot].mesh = mesh;
    w->scene.instances[slot].material = material;
    w->scene.instances[slot].desc = (struct sdfgi_instance_desc){
        .mesh = w->scene.meshes[mesh].handle,
        .material = w->scene.materials[material].handle,
        .transform = api_random_transform(&w->random),
        .mobility = api_below(w, 8) == 0 ? SDFGI_EXCLUDED : SDFGI_STATIC,
    };
    return true;
}

static void create_instance(struct api_world *w, uint32_t slot)
{
    if (!describe_instance(w, slot))
        return;
    require_ok(
        sdfgi_instance_create(w->t->gi, &w->scene.instances[slot].desc, &w->scene.instances[slot].handle));
    w->scene.instances[slot].live = true;
}

static void change_instance(struct api_world *w)
{
    const uint32_t slot = api_below(w, API_INSTANCES);
    if (!w->scene.instances[slot].live) {
        create_instance(w, slot);
    } else if (api_below(w, 3) == 0) {
        require_ok(sdfgi_instance_destroy(w->t->gi, w->scene.instances[slot].handle));
        instance_gone(w, slot);
    } else {
        struct sdfgi_transform *const transform = &w->scene.instances[slot].desc.transform;
        *transform = api_random_transform(&w->random);
        require_ok(sdfgi_instance_set_transform(w->t->gi, w->scene.instances[slot].handle, transform));
    }
}

static void create_instances(struct api_world *w)
{
    struct sdfgi_instance_desc descs[API_INSTANCES];
    sdfgi_instance handles[API_INSTANCES];
    uint32_t slots[API_INSTANCES], count = 0;
    for (uint32_t i = 0; i < API_INSTANCES; i++)
        if (!w->scene.instances[i].live && api_below(w, 2) && describe_instance(w, i)) {
            descs[count] = w->scene.instances[i].desc;
            slots[count++] = i;
        }
    require_ok(sdfgi_instances_create(w->t->gi, count, count ? descs : NULL, count ? handles : NULL));
    for (uint32_t i = 0; i < count; i++) {
        w->scene.instances[slots[i]].handle = handles[i];
        w->scene.instances[slots[i]].live = true;
    }
}

static void destroy_instances(struct api_world *w)
{
    sdfgi_instance handles[API_INSTANCES];
    uint32_t slots[API_INSTANCES], count = 0;
    for (uint32_t i = 0; i < API_INSTANCES; i++)
        if (w->scene.instances[i].live && api_below(w, 4) == 0) {
            handles[count] = w->scene.instances[i].handle;
            slots[count++] = i;
        }
    require_ok(sdfgi_instances_destroy(w->t->gi, count, count ? handles : NULL));
    for (uint32_t i = 0; i < count; i++)
        instance_gone(w, slots[i]);
}

/* Many come at once, or go. */
static void change_instances(struct api_world *w)
{
    if (api_below(w, 2))
        create_instances(w);
    else
        destroy_instances(w);
}

static void change_light(struct api_world *w)
{
    const uint32_t slot = api_below(w, API_LIGHTS);
    if (w->scene.lights[slot].live && api_below(w, 3) == 0) {
        require_ok(sdfgi_light_destroy(w->t->gi, w->scene.lights[slot].handle));
        forget(&w->lights, w->scene.lights[slot].handle.id);
        w->scene.lights[slot].live = false;
        return;
    }
    w->scene.lights[slot].desc = api_random_light(&w->random);
    if (w->scene.lights[slot].live)
        require_ok(sdfgi_light_update(w->t->gi, w->scene.lights[slot].handle, &w->scene.lights[slot].desc));
    else
        require_ok(sdfgi_light_create(w->t->gi, &w->scene.lights[slot].desc, &w->scene.lights[slot].handle));
    w->scene.lights[slot].live = true;
}

/* ---- Everything else -------------------------------------------------------------------------------- */

static void change_sky(struct api_world *w)
{
    w->scene.sky = (struct sdfgi_sky){ { 0 }, { 0 }, { 0 } };
    if (api_below(w, 3) != 0) {
        random_color(&w->random, 1, w->scene.sky.zenith);
        random_color(&w->random, 1, w->scene.sky.horizon);
        random_color(&w->random, 1, w->scene.sky.ground);
    }
    require_ok(sdfgi_set_sky(w->t->gi, &w->scene.sky));
}

/* What is to be the settings, or not; some of it or all; or takes back what was. */
static void prepare(struct api_world *w)
{
    struct sdfgi_settings s = w->scene.settings;
    if (api_below(w, 2) == 0)
        s = api_settings(&w->random);
    const struct sdfgi_prepare_desc desc = { .settings = &s, .max_objects = api_below(w, 2) * 20 };
    if (api_below(w, 4) == 0)
        sdfgi_release_prepared(w->t->gi);
    else
        require_ok(sdfgi_prepare(w->t->gi, &desc, NULL));
}

static void change_settings(struct api_world *w)
{
    struct sdfgi_settings *const s = &w->scene.settings;
    switch (api_below(w, 8)) {
    case 0:
        s->enabled = !s->enabled;
        break;
    case 1:
        *s = api_settings(&w->random);
        break;
    case 2:
        s->read_sky_light = !s->read_sky_light;
        break;
    case 3:
        s->energy = (float)test_random_real(&w->random, 0.5, 2);
        break;
    case 4:
        s->bounce_feedback = (float)test_random_real(&w->random, 0, 1);
        break;
    case 5:
        s->rough_lobes = !s->rough_lobes;
        break;
    case 6:
        s->reflection_end = (float)test_random_real(&w->random, 0, 1);
        break;
    default:
        s->frames_to_update_lights = 1 + api_below(w, 4);
    }
    if (api_below(w, 2) == 0)
        prepare(w);
    require_ok(sdfgi_set_settings(w->t->gi, s));
    struct sdfgi_settings found;
    sdfgi_get_settings(w->t->gi, &found);
    REQUIRE_TRUE(sdfgi_settings_change(&found, s) == SETTINGS_SAME);
}

static void move_camera(struct api_world *w)
{
    double *const camera = w->t->frame.camera_position;
    const double far = api_below(w, 10) == 0 ? 100 : 1;
    for (int i = 0; i < 3; i++)
        camera[i] = fmin(fmax(camera[i] + far * test_random_real(&w->random, -1, 1), -3), 3);
    if (api_below(w, 20) == 0) {
        w->t->frame.seed = api_below(w, 3);
        w->calm = 4;
    }
}

static void invalidate(struct api_world *w)
{
    double low[3], high[3];
    for (int i = 0; i < 3; i++) {
        low[i] = test_random_real(&w->random, -6, 6);
        high[i] = low[i] + test_random_real(&w->random, 0, 5);
    }
    require_ok(sdfgi_invalidate_box(w->t->gi, low, high));
}

static void begin_anew(struct api_world *w)
{
    sdfgi_reset(w->t->gi);
}

/* Those of api_change come first. */
static const struct {
    const char *name;
    uint32_t weight;
    void (*run)(struct api_world *world);
} steps[] = {
    { "sky", 6, change_sky },
    { "light", 10, change_light },
    { "instance", 30, change_instance },
    { "mesh", 8, toggle_mesh },
    { "settings", 2, change_settings },
    { "material", 8, change_material },
    { "instances", 12, change_instances },
    { "camera", 10, move_camera },
    { "invalidate", 3, invalidate },
    { "reset", 1, begin_anew },
    { "view", 4, api_change_view },
    { "wrong call", 30, api_break_rule },
    { "frame", 30, api_frame },
};

const char *api_change(struct api_world *world, uint32_t change)
{
    steps[change].run(world);
    return steps[change].name;
}

const char *api_step(struct api_world *world)
{
    uint32_t sum = 0, step = 0;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        sum += steps[i].weight;
    for (uint32_t at = api_below(world, sum); at >= steps[step].weight; step++)
        at -= steps[step].weight;
    return api_change(world, step);
}

/* ---- The same scene again --------------------------------------------------------------------------- */

/* Light is summed in the order of lights: they come in that of their slots in the other context. */
static void build_lights(struct gi_test *t, const struct api_scene *scene, const struct gi_test *walked)
{
    sdfgi_light handle;
    for (uint32_t slot = 0; slot < walked->gi->scene.lights.end; slot++)
        for (uint32_t i = 0; i < API_LIGHTS; i++)
            if (scene->lights[i].live &&
                sdfgi_pool_index(&walked->gi->scene.lights, scene->lights[i].handle.id) == slot)
                require_ok(sdfgi_light_create(t->gi, &scene->lights[i].desc, &handle));
}

void api_scene_build(struct gi_test *t, const struct api_device *device, const struct api_scene *scene,
                     const struct gi_test *walked)
{
    sdfgi_mesh meshes[API_MESHES];
    sdfgi_material materials[API_MATERIALS];
    sdfgi_instance handle;
    for (uint32_t i = 0; i < API_MESHES; i++)
        if (scene->meshes[i].live)
            require_ok(sdfgi_mesh_create(t->gi, &device->shapes[scene->meshes[i].shape], &meshes[i]));
    for (uint32_t i = 0; i < API_MATERIALS; i++) {
        struct sdfgi_material_desc desc = scene->materials[i].desc;
        if (desc.albedo_texture.view)
            desc.albedo_texture.view = device->texture.view;
        if (scene->materials[i].live)
            require_ok(sdfgi_material_create(t->gi, &desc, &materials[i]));
    }
    for (uint32_t i = 0; i < API_INSTANCES; i++) {
        struct sdfgi_instance_desc desc = scene->instances[i].desc;
        if (!scene->instances[i].live)
            continue;
        desc.mesh = meshes[scene->instances[i].mesh];
        desc.material = materials[scene->instances[i].material];
        require_ok(sdfgi_instance_create(t->gi, &desc, &handle));
    }
    build_lights(t, scene, walked);
    require_ok(sdfgi_set_sky(t->gi, &scene->sky));
}

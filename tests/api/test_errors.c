/* SPDX-License-Identifier: MIT
 * Every documented error: its code, its message id and what its message names. Nothing has changed by it. */
#include "gi_test.h"
#include "require.h"
#include "test_group.h"

#include <stdio.h>

static struct gi_test t;
static const struct sdfgi_transform identity = { .basis = { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };

static int open_disabled(void **state)
{
    (void)state;
    struct sdfgi_settings settings = gi_test_settings();
    settings.enabled = false;
    gi_test_open(&t, &settings);
    t.gpu.messages->quiet = true;
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    gi_test_close(&t);
    return 0;
}

/* The call returns `code` and logs `id` once, and nothing else. */
#define REQUIRE_REFUSED(call, code, id)                                                                      \
    do {                                                                                                     \
        memset(t.messages, 0, sizeof t.messages);                                                            \
        REQUIRE_CMP((int)(call), ==, (int)(code));                                                           \
        for (int refused_i = 0; refused_i < SDFGI_MESSAGE_COUNT; refused_i++)                                \
            REQUIRE_CMP(t.messages[refused_i], ==, refused_i == SDFGI_MESSAGE_##id ? 1u : 0u);               \
    } while (0)
#define REQUIRE_INVALID(call) REQUIRE_REFUSED(call, SDFGI_ERROR_INVALID_ARGUMENT, INVALID_ARGUMENT)
#define REQUIRE_STALE(call)   REQUIRE_REFUSED(call, SDFGI_ERROR_INVALID_ARGUMENT, INVALID_HANDLE)

/* ---- Creation */

static void count_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)level;
    REQUIRE_TRUE(text != NULL && strchr(text, '\n') == NULL);
    t.messages[id]++;
}

static struct sdfgi_desc good_desc(void)
{
    return (struct sdfgi_desc){ .vulkan = { t.gpu.instance, t.gpu.physical_device, t.gpu.device,
                                            t.gpu.queue_family_index, vkGetInstanceProcAddr, NULL },
                                .log = { count_message, NULL } };
}

static void *some_alloc(void *user, size_t size)
{
    (void)user;
    (void)size;
    return NULL;
}

static void create_refuses_bad_descriptors(void **state)
{
    (void)state;
    sdfgi *out = (sdfgi *)&t;
#define REFUSE(change)                                                                                       \
    do {                                                                                                     \
        struct sdfgi_desc d = good_desc();                                                                   \
        change;                                                                                              \
        REQUIRE_INVALID(sdfgi_create(&d, &out));                                                             \
        REQUIRE_TRUE(out == (sdfgi *)&t);                                                                    \
    } while (0)
    REFUSE(d.vulkan.instance = VK_NULL_HANDLE);
    REFUSE(d.vulkan.physical_device = VK_NULL_HANDLE);
    REFUSE(d.vulkan.device = VK_NULL_HANDLE);
    REFUSE(d.vulkan.get_instance_proc_addr = NULL);
    REFUSE(d.vulkan.queue_family_index = 77);
    REFUSE(d.frames_in_flight = 9);
    REFUSE(d.allocator.alloc = some_alloc);
#undef REFUSE
    struct sdfgi_settings bad = gi_test_settings();
    bad.cascades = 9;
    struct sdfgi_desc d = good_desc();
    d.settings = &bad;
    REQUIRE_REFUSED(sdfgi_create(&d, &out), SDFGI_ERROR_INVALID_ARGUMENT, INVALID_SETTING);
    REQUIRE_TRUE(out == (sdfgi *)&t);
}

static void a_zeroed_descriptor_means_defaults(void **state)
{
    (void)state;
    const struct sdfgi_desc desc = good_desc();
    sdfgi *gi;
    REQUIRE_CMP((int)sdfgi_create(&desc, &gi), ==, (int)SDFGI_OK);
    struct sdfgi_settings defaults, in_force;
    sdfgi_settings_default(&defaults);
    sdfgi_get_settings(gi, &in_force);
    REQUIRE_BYTES(&defaults, &in_force, sizeof defaults);
    REQUIRE_TRUE(!in_force.enabled && !sdfgi_is_active(gi));
    sdfgi_destroy(gi);
    sdfgi_destroy(NULL);
}

/* ---- Settings */

/* Devices and queue families that are not there in tests. */
static void what_a_device_cannot_do_is_refused(void **state)
{
    (void)state;
    struct gpu_device *device = &t.gi->backend.device;
    const struct gpu_device before = *device;
    struct sdfgi_settings s;
    sdfgi_get_settings(t.gi, &s);
    s.voxelizer = SDFGI_VOXELIZER_RASTER;
    device->queue_flags = VK_QUEUE_COMPUTE_BIT;
    REQUIRE_REFUSED(sdfgi_set_settings(t.gi, &s), SDFGI_ERROR_UNSUPPORTED, UNSUPPORTED_DEVICE);
    *device = before;
    device->features.fragmentStoresAndAtomics = VK_FALSE;
    REQUIRE_REFUSED(sdfgi_set_settings(t.gi, &s), SDFGI_ERROR_UNSUPPORTED, UNSUPPORTED_DEVICE);
    *device = before;
    device->features.vertexPipelineStoresAndAtomics = VK_FALSE;
    REQUIRE_REFUSED(sdfgi_set_settings(t.gi, &s), SDFGI_ERROR_UNSUPPORTED, UNSUPPORTED_DEVICE);
    *device = before;
    sdfgi_get_settings(t.gi, &s);
    s.enabled = true;
    s.resolution = 64;
    device->limits.maxStorageBufferRange = 1000;
    REQUIRE_INVALID(sdfgi_set_settings(t.gi, &s));
    *device = before;
}

static void settings_out_of_range_are_refused(void **state)
{
    (void)state;
    struct sdfgi_settings before, after;
    sdfgi_get_settings(t.gi, &before);
#define REFUSE(change)                                                                                       \
    do {                                                                                                     \
        struct sdfgi_settings s = before;                                                                    \
        change;                                                                                              \
        REQUIRE_REFUSED(sdfgi_set_settings(t.gi, &s), SDFGI_ERROR_INVALID_ARGUMENT, INVALID_SETTING);        \
        sdfgi_get_settings(t.gi, &after);                                                                    \
        REQUIRE_BYTES(&before, &after, sizeof before);                                                       \
    } while (0)
    REFUSE(s.bounce_feedback = 2);
    REFUSE(s.bounce_feedback = -0.1f);
    REFUSE(s.bounce_feedback = NAN);
    REFUSE(s.cascades = 0);
    REFUSE(s.cascades = 9);
    REFUSE(s.min_cell_size_m = 0);
    REFUSE(s.min_cell_size_m = INFINITY);
    REFUSE(s.y_scale = (enum sdfgi_y_scale)3);
    REFUSE(s.energy = -1);
    REFUSE(s.normal_bias_cells = NAN);
    REFUSE(s.probe_bias_cells = 1e9f);
    REFUSE(s.ray_count = 0);
    REFUSE(s.ray_count = 129);
    REFUSE(s.frames_to_converge = 0);
    REFUSE(s.frames_to_converge = 65);
    REFUSE(s.frames_to_update_lights = 0);
    REFUSE(s.resolution = 48);
    REFUSE(s.resolution = 512);
    REFUSE(s.visibility = (enum sdfgi_visibility)9);
    REFUSE(s.sdf_method = (enum sdfgi_sdf_method)2);
    REFUSE(s.voxelizer = (enum sdfgi_voxelizer)2);
#undef REFUSE
}

/* ---- Materials */

static void materials_are_checked(void **state)
{
    (void)state;
    const struct sdfgi_material_desc good = { .albedo = { 0.5f, 0.5f, 0.5f } };
    sdfgi_material out = { 77 }, material;
    REQUIRE_CMP((int)sdfgi_material_create(t.gi, &good, &material), ==, (int)SDFGI_OK);
#define REFUSE(change)                                                                                       \
    do {                                                                                                     \
        struct sdfgi_material_desc d = good;                                                                 \
        change;                                                                                              \
        REQUIRE_INVALID(sdfgi_material_create(t.gi, &d, &out));                                              \
        REQUIRE_INVALID(sdfgi_material_update(t.gi, material, &d));                                          \
        REQUIRE_CMP(out.id, ==, 77u);                                                                        \
    } while (0)
    REFUSE(d.specular_albedo = 1.01f);
    REFUSE(d.albedo[0] = 1.01f);
    REFUSE(d.albedo[1] = -0.01f);
    REFUSE(d.albedo[2] = NAN);
    REFUSE(d.emission[0] = -1);
    REFUSE(d.emission[1] = INFINITY);
    REFUSE(d.alpha = 2);
    REFUSE(d.alpha = NAN);
    REFUSE(d.alpha_cutoff = -1);
    REFUSE(d.alpha_cutoff = 1.01f);
    REFUSE(d.albedo_texture.uv_transform[3] = NAN);
    REFUSE(d.emission_texture.uv_transform[0] = INFINITY);
    REFUSE(d.albedo_texture.address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER);
    REFUSE(d.emission_texture.address_v = VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE);
#undef REFUSE
    REQUIRE_CMP((int)sdfgi_material_destroy(t.gi, material), ==, (int)SDFGI_OK);
    REQUIRE_STALE(sdfgi_material_destroy(t.gi, material));
    REQUIRE_STALE(sdfgi_material_update(t.gi, material, &good));
    REQUIRE_STALE(sdfgi_material_destroy(t.gi, (sdfgi_material){ 0 }));
    REQUIRE_STALE(sdfgi_material_destroy(t.gi, (sdfgi_material){ UINT32_MAX }));
}

static void more_than_4096_materials_are_refused(void **state)
{
    (void)state;
    const struct sdfgi_material_desc good = { .albedo = { 0.5f, 0.5f, 0.5f } };
    static sdfgi_material all[4096];
    for (int i = 0; i < 4096; i++)
        REQUIRE_CMP((int)sdfgi_material_create(t.gi, &good, &all[i]), ==, (int)SDFGI_OK);
    sdfgi_material out = { 77 };
    REQUIRE_REFUSED(sdfgi_material_create(t.gi, &good, &out), SDFGI_ERROR_OUT_OF_MEMORY, OUT_OF_HOST_MEMORY);
    REQUIRE_CMP(out.id, ==, 77u);
    for (int i = 0; i < 4096; i++)
        REQUIRE_CMP((int)sdfgi_material_destroy(t.gi, all[i]), ==, (int)SDFGI_OK);
}

/* ---- Meshes and instances */

static struct sdfgi_mesh_desc good_mesh(void)
{
    static VkBuffer buffer;
    static sdfgi *owner;
    if (owner != t.gi) {
        const float corners[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
        t.buffers[t.buffer_count] =
            gpu_test_buffer_device(&t.gpu, sizeof corners, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, corners);
        buffer = t.buffers[t.buffer_count++].buffer;
        owner = t.gi;
    }
    return (struct sdfgi_mesh_desc){
        .position_buffer = buffer, .vertex_count = 3, .triangle_count = 1, .bounds_max = { 1, 1, 0 }
    };
}

static void meshes_are_checked(void **state)
{
    (void)state;
    sdfgi_mesh out = { 77 };
#define REFUSE(change)                                                                                       \
    do {                                                                                                     \
        struct sdfgi_mesh_desc d = good_mesh();                                                              \
        change;                                                                                              \
        REQUIRE_INVALID(sdfgi_mesh_create(t.gi, &d, &out));                                                  \
        REQUIRE_CMP(out.id, ==, 77u);                                                                        \
    } while (0)
    REFUSE(d.position_buffer = VK_NULL_HANDLE);
    REFUSE(d.vertex_count = 0);
    REFUSE(d.triangle_count = 0);
    REFUSE(d.triangle_count = 2);
    REFUSE(d.position_offset = 2);
    REFUSE(d.position_stride = 13);
    REFUSE(d.position_stride = 8);
    REFUSE((d.uv_buffer = d.position_buffer, d.uv_stride = 4));
    REFUSE((d.color_buffer = d.position_buffer, d.color_stride = 12));
    REFUSE((d.uv_buffer = d.position_buffer, d.uv_offset = 1));
    REFUSE((d.uv_buffer = d.position_buffer, d.uv_stride = 6));
    REFUSE((d.color_buffer = d.position_buffer, d.color_offset = 3));
    REFUSE((d.color_buffer = d.position_buffer, d.color_stride = 5));
    REFUSE((d.index_buffer = d.position_buffer, d.index_type = VK_INDEX_TYPE_NONE_KHR));
    REFUSE(d.front_face = (VkFrontFace)2);
    REFUSE(d.bounds_min[0] = NAN);
    REFUSE(d.bounds_max[1] = INFINITY);
    REFUSE(d.bounds_min[2] = 1);
    REFUSE(d.bounds_max[0] = d.bounds_max[1] = 0);
#undef REFUSE
    const struct sdfgi_mesh_desc good = good_mesh();
    REQUIRE_CMP((int)sdfgi_mesh_create(t.gi, &good, &out), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_mesh_destroy(t.gi, out), ==, (int)SDFGI_OK);
    REQUIRE_STALE(sdfgi_mesh_destroy(t.gi, out));
}

static void instances_are_checked(void **state)
{
    (void)state;
    const struct sdfgi_mesh_desc mesh_desc = good_mesh();
    const struct sdfgi_material_desc material_desc = { .albedo = { 1, 1, 1 } };
    struct sdfgi_instance_desc good = { .transform = identity };
    REQUIRE_CMP((int)sdfgi_mesh_create(t.gi, &mesh_desc, &good.mesh), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_material_create(t.gi, &material_desc, &good.material), ==, (int)SDFGI_OK);
    sdfgi_instance out = { 77 };
#define REFUSE(change, refused)                                                                              \
    do {                                                                                                     \
        struct sdfgi_instance_desc d = good;                                                                 \
        change;                                                                                              \
        refused(sdfgi_instance_create(t.gi, &d, &out));                                                      \
        REQUIRE_CMP(out.id, ==, 77u);                                                                        \
    } while (0)
    REFUSE(d.mesh.id = 0, REQUIRE_STALE);
    REFUSE(d.mesh.id += 1u << 20, REQUIRE_STALE);
    REFUSE(d.material.id = 12345, REQUIRE_STALE);
    REFUSE(d.transform.basis[4] = NAN, REQUIRE_INVALID);
    REFUSE(memset(d.transform.basis, 0, sizeof d.transform.basis), REQUIRE_INVALID);
    REFUSE(d.transform.translation[1] = INFINITY, REQUIRE_INVALID);
    REFUSE(d.mobility = (enum sdfgi_mobility)7, REQUIRE_INVALID);
#undef REFUSE
    REQUIRE_CMP((int)sdfgi_instance_create(t.gi, &good, &out), ==, (int)SDFGI_OK);
    struct sdfgi_transform bad = identity;
    bad.basis[0] = INFINITY;
    REQUIRE_INVALID(sdfgi_instance_set_transform(t.gi, out, &bad));
    REQUIRE_INVALID(sdfgi_instance_set_transform(t.gi, out, &(struct sdfgi_transform){ 0 }));
    REQUIRE_INVALID(sdfgi_material_destroy(t.gi, good.material)); /* still in use */
    REQUIRE_CMP((int)sdfgi_instance_destroy(t.gi, out), ==, (int)SDFGI_OK);
    REQUIRE_STALE(sdfgi_instance_destroy(t.gi, out));
    REQUIRE_STALE(sdfgi_instance_set_transform(t.gi, out, &identity));
    REQUIRE_CMP((int)sdfgi_instance_create(t.gi, &good, &out), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_mesh_destroy(t.gi, good.mesh), ==, (int)SDFGI_OK);
    REQUIRE_STALE(sdfgi_instance_destroy(t.gi, out)); /* went with its mesh */
    REQUIRE_CMP((int)sdfgi_material_destroy(t.gi, good.material), ==, (int)SDFGI_OK);
}

/* A new object in the same place has another handle. */
static void handles_are_not_used_again_at_once(void **state)
{
    (void)state;
    const struct sdfgi_light_desc desc = { .intensity = { 1, 1, 1 },
                                           .type = SDFGI_LIGHT_POINT,
                                           .indirect_energy = 1 };
    sdfgi_light first, second;
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &desc, &first), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, first), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &desc, &second), ==, (int)SDFGI_OK);
    REQUIRE_CMP(first.id, !=, second.id);
    REQUIRE_STALE(sdfgi_light_update(t.gi, first, &desc));
    REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, second), ==, (int)SDFGI_OK);
}

static void boxes_are_checked(void **state)
{
    (void)state;
    REQUIRE_INVALID(sdfgi_invalidate_box(t.gi, (double[]){ 1, 0, 0 }, (double[]){ 0, 1, 1 }));
    REQUIRE_INVALID(sdfgi_invalidate_box(t.gi, (double[]){ 0, NAN, 0 }, (double[]){ 1, 1, 1 }));
    REQUIRE_CMP((int)sdfgi_invalidate_box(t.gi, (double[]){ 0, 0, 0 }, (double[]){ 0, 1, 1 }), ==,
                (int)SDFGI_OK);
}

/* ---- Lights and sky */

static void lights_are_checked(void **state)
{
    (void)state;
    const struct sdfgi_light_desc good = { .type = SDFGI_LIGHT_SPOT,
                                           .direction = { 0, -1, 0 },
                                           .intensity = { 1, 1, 1 },
                                           .inner_angle_rad = 0.2f,
                                           .outer_angle_rad = 0.5f,
                                           .indirect_energy = 1 };
    sdfgi_light out = { 77 }, light;
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &good, &light), ==, (int)SDFGI_OK);
#define REFUSE(change)                                                                                       \
    do {                                                                                                     \
        struct sdfgi_light_desc d = good;                                                                    \
        change;                                                                                              \
        REQUIRE_INVALID(sdfgi_light_create(t.gi, &d, &out));                                                 \
        REQUIRE_INVALID(sdfgi_light_update(t.gi, light, &d));                                                \
        REQUIRE_CMP(out.id, ==, 77u);                                                                        \
    } while (0)
    REFUSE(d.type = (enum sdfgi_light_type)3);
    REFUSE(d.position[0] = NAN);
    REFUSE(d.direction[1] = 0);
    REFUSE(d.direction[1] = INFINITY);
    REFUSE(d.intensity[2] = -1);
    REFUSE(d.intensity[0] = INFINITY);
    REFUSE(d.range_m = -1);
    REFUSE(d.inner_angle_rad = -0.1f);
    REFUSE(d.inner_angle_rad = 0.5f);
    REFUSE(d.outer_angle_rad = 1.6f);
    REFUSE(d.outer_angle_rad = NAN);
    REFUSE(d.indirect_energy = -1);
#undef REFUSE
    REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, light), ==, (int)SDFGI_OK);
    REQUIRE_STALE(sdfgi_light_destroy(t.gi, light));
    REQUIRE_STALE(sdfgi_light_update(t.gi, light, &good));
}

/* A direction need not be of unit length: neither a very short nor a very long one is zero or infinite. */
static void directions_of_any_length_are_taken(void **state)
{
    (void)state;
    static const float lengths[] = { 1e-30f, 1e30f };
    for (int i = 0; i < 2; i++) {
        const struct sdfgi_light_desc sun = { .direction = { 0, -lengths[i], 0 }, .intensity = { 1, 1, 1 } };
        sdfgi_light light;
        REQUIRE_CMP((int)sdfgi_light_create(t.gi, &sun, &light), ==, (int)SDFGI_OK);
        REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, light), ==, (int)SDFGI_OK);
    }
}

static void more_than_1024_lights_are_refused(void **state)
{
    (void)state;
    const struct sdfgi_light_desc good = { .type = SDFGI_LIGHT_POINT, .intensity = { 1, 1, 1 } };
    static sdfgi_light all[1024];
    for (int i = 0; i < 1024; i++)
        REQUIRE_CMP((int)sdfgi_light_create(t.gi, &good, &all[i]), ==, (int)SDFGI_OK);
    sdfgi_light out = { 77 };
    REQUIRE_REFUSED(sdfgi_light_create(t.gi, &good, &out), SDFGI_ERROR_OUT_OF_MEMORY, OUT_OF_HOST_MEMORY);
    REQUIRE_CMP(out.id, ==, 77u);
    for (int i = 0; i < 1024; i++)
        REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, all[i]), ==, (int)SDFGI_OK);
}

static void skies_are_checked(void **state)
{
    (void)state;
    REQUIRE_INVALID(sdfgi_set_sky(t.gi, &(struct sdfgi_sky){ .zenith = { -1, 0, 0 } }));
    REQUIRE_INVALID(sdfgi_set_sky(t.gi, &(struct sdfgi_sky){ .horizon = { 0, NAN, 0 } }));
    REQUIRE_INVALID(sdfgi_set_sky(t.gi, &(struct sdfgi_sky){ .ground = { 0, 0, INFINITY } }));
}

/* ---- Texts */

/* Whether the last message has all of these words. */
static void require_words(const char *const words[static 5])
{
    for (int i = 0; i < 5 && words[i]; i++)
        if (!strstr(t.last_message, words[i]))
            require_fail(__FILE__, __LINE__, "'%s' is not in: %s", words[i], t.last_message);
}

static void messages_name_function_object_field_value_and_limit(void **state)
{
    (void)state;
    struct sdfgi_light_desc light = { .type = SDFGI_LIGHT_POINT, .intensity = { 1, 1, 1 } };
    struct sdfgi_mesh_desc mesh = good_mesh();
    sdfgi_light handle;
    sdfgi_mesh unused;
    mesh.uv_buffer = mesh.position_buffer;
    mesh.uv_stride = 6;
    REQUIRE_INVALID(sdfgi_mesh_create(t.gi, &mesh, &unused));
    require_words((const char *[5]){ "sdfgi_mesh_create", "uv_stride", " 6,", "multiple of 4", "8" });
    mesh = good_mesh();
    mesh.color_buffer = mesh.position_buffer;
    mesh.color_offset = 7;
    REQUIRE_INVALID(sdfgi_mesh_create(t.gi, &mesh, &unused));
    require_words((const char *[5]){ "sdfgi_mesh_create", "color_offset", " 7,", "multiple of 4" });
    REQUIRE_CMP((int)sdfgi_light_create(t.gi, &light, &handle), ==, (int)SDFGI_OK);
    char object[32];
    snprintf(object, sizeof object, "light %u:", handle.id);
    light.intensity[2] = -2.5f;
    REQUIRE_INVALID(sdfgi_light_update(t.gi, handle, &light));
    require_words((const char *[5]){ "sdfgi_light_update", object, "intensity[2]", "-2.5", "at least 0" });
    REQUIRE_CMP((int)sdfgi_light_destroy(t.gi, handle), ==, (int)SDFGI_OK);
    const struct sdfgi_material_desc material = { .albedo = { 0, 1.5f, 0 } };
    REQUIRE_INVALID(sdfgi_material_create(t.gi, &material, &(sdfgi_material){ 0 }));
    require_words((const char *[5]){ "sdfgi_material_create", "albedo[1]", "1.5", "from 0 to 1" });
}

/* ---- Frames */

static void frames_are_checked(void **state)
{
    (void)state;
    const struct sdfgi_frame_desc wrong[] = { { .camera_position = { NAN, 0, 0 } },
                                              { .origin = { 0, INFINITY, 0 } },
                                              { .exposure = -1 },
                                              { .exposure = NAN } };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        REQUIRE_INVALID(sdfgi_update(t.gi, VK_NULL_HANDLE, &wrong[i]));
    /* Off, nothing is recorded: no command buffer is touched. */
    REQUIRE_CMP((int)sdfgi_update(t.gi, VK_NULL_HANDLE, &(struct sdfgi_frame_desc){ 0 }), ==, (int)SDFGI_OK);
    REQUIRE_CMP((int)sdfgi_gather(t.gi, VK_NULL_HANDLE, &(struct sdfgi_gather_desc){ 0 }), ==, (int)SDFGI_OK);
    struct sdfgi_settings settings;
    sdfgi_get_settings(t.gi, &settings);
    settings.enabled = true;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &settings), ==, (int)SDFGI_OK);
    REQUIRE_INVALID(sdfgi_update(t.gi, VK_NULL_HANDLE, &(struct sdfgi_frame_desc){ 0 }));
    settings.enabled = false;
    REQUIRE_CMP((int)sdfgi_set_settings(t.gi, &settings), ==, (int)SDFGI_OK);
}

TEST_GROUP(errors)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(create_refuses_bad_descriptors),
        cmocka_unit_test(a_zeroed_descriptor_means_defaults),
        cmocka_unit_test(what_a_device_cannot_do_is_refused),
        cmocka_unit_test(settings_out_of_range_are_refused),
        cmocka_unit_test(materials_are_checked),
        cmocka_unit_test(more_than_4096_materials_are_refused),
        cmocka_unit_test(meshes_are_checked),
        cmocka_unit_test(instances_are_checked),
        cmocka_unit_test(handles_are_not_used_again_at_once),
        cmocka_unit_test(boxes_are_checked),
        cmocka_unit_test(lights_are_checked),
        cmocka_unit_test(directions_of_any_length_are_taken),
        cmocka_unit_test(more_than_1024_lights_are_refused),
        cmocka_unit_test(skies_are_checked),
        cmocka_unit_test(messages_name_function_object_field_value_and_limit),
        cmocka_unit_test(frames_are_checked),
    };
    return cmocka_run_group_tests(tests, open_disabled, close_context);
}

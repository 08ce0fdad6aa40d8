/* SPDX-License-Identifier: MIT
 * Many instances created and destroyed at once: all or none, with an error that names the one that is wrong,
 * and handles that are as those of single ones. */
#include "box_field.h"
#include "require.h"
#include "test_group.h"
#include "scene/scene_check.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

static struct gi_test t;
static const struct box_field field = { 3000, 1 };
static struct sdfgi_instance_desc *descs;
static sdfgi_instance *handles;
static sdfgi_mesh mesh;
static sdfgi_material grey;
static bool is_poor;

static void *alloc_if_rich(void *user, size_t size)
{
    (void)user;
    return is_poor ? NULL : malloc(size);
}

static void free_any(void *user, void *memory)
{
    (void)user;
    free(memory);
}

static void log_message(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)level;
    t.messages[id]++;
    snprintf(t.last_message, sizeof t.last_message, "%s", text);
}

static int open_context(void **state)
{
    (void)state;
    struct sdfgi_settings off = gi_test_settings();
    off.enabled = false;
    gi_test_open(&t, &off);
    sdfgi_destroy(t.gi);
    const struct sdfgi_desc desc = { .vulkan = { t.gpu.instance, t.gpu.physical_device, t.gpu.device,
                                                 t.gpu.queue_family_index, vkGetInstanceProcAddr, NULL },
                                     .log = { log_message, NULL },
                                     .allocator = { alloc_if_rich, free_any, NULL } };
    REQUIRE_CMP(sdfgi_create(&desc, &t.gi), ==, SDFGI_OK);
    struct test_mesh unit = box_field_unit();
    mesh = gi_test_mesh(&t, &unit);
    grey = gi_test_material(&t, (float[3]){ 0.5f, 0.5f, 0.5f }, (float[3]){ 0 });
    descs = test_array_alloc(field.count, sizeof *descs);
    handles = test_array_alloc(field.count, sizeof *handles);
    for (uint32_t i = 0; i < field.count; i++)
        descs[i] = (struct sdfgi_instance_desc){ mesh, grey, box_field_place(&field, i), SDFGI_STATIC };
    test_mesh_destroy(&unit);
    return 0;
}

static int close_context(void **state)
{
    (void)state;
    gi_test_close(&t);
    free(descs);
    free(handles);
    return 0;
}

static uint32_t live(void)
{
    return t.gi->scene.instances.count;
}

/* ---- Creation */

static void all_are_created_and_destroyed(void **state)
{
    (void)state;
    for (int round = 0; round < 3; round++) {
        REQUIRE_CMP(sdfgi_instances_create(t.gi, field.count, descs, handles), ==, SDFGI_OK);
        REQUIRE_CMP(live(), ==, field.count);
        for (uint32_t i = 0; i < field.count; i += 100)
            REQUIRE_CMP(sdfgi_instance_set_transform(t.gi, handles[i], &descs[field.count - 1 - i].transform),
                        ==, SDFGI_OK);
        REQUIRE_CMP(sdfgi_instances_destroy(t.gi, field.count, handles), ==, SDFGI_OK);
        REQUIRE_CMP(live(), ==, 0u);
        REQUIRE_TRUE(t.gi->scene.tree.root == TREE_NONE && t.gi->scene.newest == 0);
        REQUIRE_CMP(sdfgi_instance_destroy(t.gi, handles[7]), ==, SDFGI_ERROR_INVALID_ARGUMENT);
    }
    REQUIRE_CMP(sdfgi_instances_create(t.gi, 0, NULL, NULL), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instances_destroy(t.gi, 0, NULL), ==, SDFGI_OK);
}

/* The call is refused with one message of the id, whose text has the words, and nothing has changed. */
static void require_refused(enum sdfgi_result result, enum sdfgi_result code, enum sdfgi_message id,
                            const char *words, uint32_t live_before)
{
    REQUIRE_CMP((int)result, ==, (int)code);
    for (int i = 0; i < SDFGI_MESSAGE_COUNT; i++)
        REQUIRE_CMP(t.messages[i], ==, i == (int)id ? 1u : 0u);
    if (!strstr(t.last_message, words))
        require_fail(__FILE__, __LINE__, "\"%s\" does not say \"%s\"", t.last_message, words);
    REQUIRE_CMP(live(), ==, live_before);
    for (uint32_t i = 0; i < field.count; i++)
        REQUIRE_CMP(handles[i].id, ==, 77u);
}

static void create_one_bad(struct sdfgi_instance_desc bad, enum sdfgi_message id, const char *words)
{
    const uint32_t at = 2345, before = live();
    const struct sdfgi_instance_desc good = descs[at];
    descs[at] = bad;
    memset(t.messages, 0, sizeof t.messages);
    for (uint32_t i = 0; i < field.count; i++)
        handles[i].id = 77;
    require_refused(sdfgi_instances_create(t.gi, field.count, descs, handles), SDFGI_ERROR_INVALID_ARGUMENT,
                    id, words, before);
    descs[at] = good;
}

static void one_bad_description_creates_none(void **state)
{
    (void)state;
    struct sdfgi_instance_desc bad = descs[0];
    bad.mesh.id = 12345;
    create_one_bad(bad, SDFGI_MESSAGE_INVALID_HANDLE, "descs[2345]: mesh: no object with handle 12345");
    bad = descs[0];
    bad.material.id = 0;
    create_one_bad(bad, SDFGI_MESSAGE_INVALID_HANDLE, "descs[2345]: material");
    bad = descs[0];
    bad.transform.translation[1] = NAN;
    create_one_bad(bad, SDFGI_MESSAGE_INVALID_ARGUMENT, "descs[2345]: transform.translation[1] is nan");
    bad = descs[0];
    bad.mobility = (enum sdfgi_mobility)9;
    create_one_bad(bad, SDFGI_MESSAGE_INVALID_ARGUMENT, "descs[2345]: mobility is 9");
}

static void without_memory_none_is_created(void **state)
{
    (void)state;
    sdfgi_instance first;
    REQUIRE_CMP(sdfgi_instance_create(t.gi, &descs[0], &first), ==, SDFGI_OK);
    const struct pool *pool = &t.gi->scene.instances;
    const uint32_t room = pool->capacity - pool->count, count = room + 1;
    struct sdfgi_instance_desc *many = test_array_alloc(count, sizeof *many);
    sdfgi_instance *out = test_array_alloc(count, sizeof *out);
    for (uint32_t i = 0; i < count; i++)
        many[i] = descs[i % field.count];
    for (uint32_t i = 0; i < count; i++)
        out[i].id = 77;
    for (uint32_t i = 0; i < field.count; i++)
        handles[i].id = 77;
    memset(t.messages, 0, sizeof t.messages);
    is_poor = true;
    require_refused(sdfgi_instances_create(t.gi, count, many, out), SDFGI_ERROR_OUT_OF_MEMORY,
                    SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "sdfgi_instances_create", 1);
    is_poor = false;
    for (uint32_t i = 0; i < count; i++)
        REQUIRE_CMP(out[i].id, ==, 77u);
    REQUIRE_CMP(sdfgi_instances_create(t.gi, count, many, out), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instances_destroy(t.gi, count, out), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, first), ==, SDFGI_OK);
    free(many);
    free(out);
}

/* At the limit one error says so, and those that are there stay. */
static void the_limit_is_named(void **state)
{
    (void)state;
    enum { SHARE = 1 << 16 };
    struct sdfgi_instance_desc *share = test_array_alloc(SHARE, sizeof *share);
    sdfgi_instance *out = test_array_alloc(MAX_OBJECTS, sizeof *out);
    for (uint32_t i = 0; i < SHARE; i++) {
        share[i] = descs[i % field.count];
        share[i].mobility = SDFGI_EXCLUDED;
    }
    for (uint32_t made = 0; made < MAX_OBJECTS; made += SHARE)
        REQUIRE_CMP(sdfgi_instances_create(t.gi, MAX_OBJECTS - made < SHARE ? MAX_OBJECTS - made : SHARE,
                                           share, out + made),
                    ==, SDFGI_OK);
    for (uint32_t i = 0; i < field.count; i++)
        handles[i].id = 77;
    memset(t.messages, 0, sizeof t.messages);
    require_refused(sdfgi_instances_create(t.gi, 2, share, handles), SDFGI_ERROR_OUT_OF_MEMORY,
                    SDFGI_MESSAGE_OUT_OF_HOST_MEMORY,
                    "2 more beside 1048574 instances, must be at most 1048574", MAX_OBJECTS);
    memset(t.messages, 0, sizeof t.messages);
    require_refused(sdfgi_instance_create(t.gi, share, handles), SDFGI_ERROR_OUT_OF_MEMORY,
                    SDFGI_MESSAGE_OUT_OF_HOST_MEMORY, "1 more beside 1048574 instances", MAX_OBJECTS);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, out[5]), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instance_create(t.gi, share, &out[5]), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instances_destroy(t.gi, MAX_OBJECTS, out), ==, SDFGI_OK);
    REQUIRE_CMP(live(), ==, 0u);
    free(share);
    free(out);
}

/* ---- Destruction */

static void destroy_refuses(uint32_t at, uint32_t id, enum sdfgi_message message, const char *words)
{
    static sdfgi_instance spoiled[3000];
    memcpy(spoiled, handles, sizeof spoiled);
    spoiled[at].id = id;
    memset(t.messages, 0, sizeof t.messages);
    REQUIRE_CMP(sdfgi_instances_destroy(t.gi, field.count, spoiled), ==, SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(t.messages[message], ==, 1u);
    if (!strstr(t.last_message, words))
        require_fail(__FILE__, __LINE__, "\"%s\" does not say \"%s\"", t.last_message, words);
    REQUIRE_CMP(live(), ==, field.count);
}

static void one_bad_handle_destroys_none(void **state)
{
    (void)state;
    sdfgi_instance stale;
    REQUIRE_CMP(sdfgi_instance_create(t.gi, &descs[0], &stale), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, stale), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instances_create(t.gi, field.count, descs, handles), ==, SDFGI_OK);
    destroy_refuses(2999, stale.id, SDFGI_MESSAGE_INVALID_HANDLE, "instances[2999]: no object");
    destroy_refuses(0, 0, SDFGI_MESSAGE_INVALID_HANDLE, "instances[0]: no object");
    destroy_refuses(1234, handles[3].id, SDFGI_MESSAGE_INVALID_ARGUMENT, "instances[1234]: handle");
    REQUIRE_CMP(sdfgi_instances_destroy(t.gi, field.count, handles), ==, SDFGI_OK);
}

/* A mesh takes its instances with it, and a material goes once the last that uses it has. */
static void meshes_and_materials_know_their_instances(void **state)
{
    (void)state;
    struct test_mesh unit = box_field_unit();
    const sdfgi_mesh other = gi_test_mesh(&t, &unit);
    const sdfgi_material red = gi_test_material(&t, (float[3]){ 1, 0, 0 }, (float[3]){ 0 });
    for (uint32_t i = 0; i < field.count; i += 2) {
        descs[i].mesh = other;
        descs[i].material = red;
        descs[i].mobility = i % 4 ? SDFGI_STATIC : SDFGI_EXCLUDED;
    }
    REQUIRE_CMP(sdfgi_instances_create(t.gi, field.count, descs, handles), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_material_destroy(t.gi, red), ==, SDFGI_ERROR_INVALID_ARGUMENT);
    for (uint32_t i = 0; i < 300; i++)
        REQUIRE_CMP(sdfgi_instance_destroy(t.gi, handles[i]), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_mesh_destroy(t.gi, other), ==, SDFGI_OK);
    REQUIRE_CMP(live(), ==, (field.count - 300) / 2);
    REQUIRE_CMP(sdfgi_material_destroy(t.gi, red), ==, SDFGI_OK);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, handles[300]), ==, SDFGI_ERROR_INVALID_ARGUMENT);
    REQUIRE_CMP(sdfgi_instance_destroy(t.gi, handles[301]), ==, SDFGI_OK);
    test_mesh_destroy(&unit);
}

TEST_GROUP(bulk)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_are_created_and_destroyed),
        cmocka_unit_test(one_bad_description_creates_none),
        cmocka_unit_test(without_memory_none_is_created),
        cmocka_unit_test(one_bad_handle_destroys_none),
        cmocka_unit_test(the_limit_is_named),
        cmocka_unit_test(meshes_and_materials_know_their_instances),
    };
    return cmocka_run_group_tests_name("instances_bulk", tests, open_context, close_context);
}

/* SPDX-License-Identifier: MIT
 * Instances leave in the volumes what one mesh with the same triangles leaves, bit for bit. */
#include "box_field.h"
#include "require.h"
#include "test_group.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

static struct gi_test t;

/* More boxes than a list holds stand in cascade 0: 8 m, with sub-voxels of 1/16 m. */
static const struct box_field crowd = { 180 * 180, 1.0 / 16 };

static struct sdfgi_settings settings_of(enum sdfgi_voxelizer voxelizer)
{
    struct sdfgi_settings settings = gi_test_settings();
    settings.resolution = 32;
    settings.cascades = 2;
    settings.voxelizer = voxelizer;
    return settings;
}

static sdfgi_material material(int i)
{
    static const float albedo[2][3] = { { 0.8f, 0.4f, 0.2f }, { 0.1f, 0.9f, 0.5f } };
    return gi_test_material(&t, albedo[i], (float[3]){ i ? 2 : 0, 0, 0 });
}

/* Every second box from `first` on, as one mesh. */
static void add_half_as_mesh(const struct box_field *field, uint32_t first, sdfgi_material made_of)
{
    struct test_mesh all = box_field_mesh(field);
    const uint32_t triangles = all.triangle_count / field->count;
    uint32_t kept = 0;
    for (uint32_t i = first; i < field->count; i += 2, kept++)
        memmove(all.indices + 3 * (size_t)triangles * kept, all.indices + 3 * (size_t)triangles * i,
                3 * triangles * sizeof *all.indices);
    all.triangle_count = kept * triangles;
    gi_test_add(&t, &all, made_of);
    test_mesh_destroy(&all);
}

/* Those from `first` on. */
static void add_as_instances(const struct box_field *field, uint32_t first, uint32_t end)
{
    struct sdfgi_instance_desc *descs = test_array_alloc(field->count, sizeof *descs);
    sdfgi_instance *handles = test_array_alloc(field->count, sizeof *handles);
    struct test_mesh unit = box_field_unit();
    const sdfgi_mesh mesh = gi_test_mesh(&t, &unit);
    const sdfgi_material materials[2] = { material(0), material(1) };
    for (uint32_t i = 0; i < field->count; i++)
        descs[i] =
            (struct sdfgi_instance_desc){ mesh, materials[i % 2], box_field_place(field, i), SDFGI_STATIC };
    REQUIRE_CMP(sdfgi_instances_create(t.gi, end - first, descs + first, handles), ==, SDFGI_OK);
    test_mesh_destroy(&unit);
    free(handles);
    free(descs);
}

/* ---- What was generated */

static const enum resource compared[] = { RESOURCE_BITS, RESOURCE_DISTANCE, RESOURCE_ALBEDO, RESOURCE_NORMALS,
                                          RESOURCE_EMISSION };
enum { COMPARED = sizeof compared / sizeof *compared };

struct volumes {
    uint8_t *data[COMPARED];
    uint64_t sizes[COMPARED];
};

static struct volumes read_volumes(void)
{
    struct volumes v;
    for (int i = 0; i < COMPARED; i++)
        v.data[i] = gi_test_read(&t, compared[i], &v.sizes[i]);
    return v;
}

static void free_volumes(struct volumes *v)
{
    for (int i = 0; i < COMPARED; i++)
        free(v->data[i]);
}

static void require_equal(const struct volumes *a, const struct volumes *b)
{
    for (int i = 0; i < COMPARED; i++) {
        uint64_t differ = 0;
        REQUIRE_CMP(a->sizes[i], ==, b->sizes[i]);
        for (uint64_t k = 0; k < a->sizes[i]; k++)
            differ += a->data[i][k] != b->data[i][k];
        printf("%s: %llu of %llu bytes differ\n", sdfgi_resource_row(compared[i])->name,
               (unsigned long long)differ, (unsigned long long)a->sizes[i]);
        REQUIRE_CMP(differ, ==, 0ull);
    }
}

static uint64_t bits_set(const struct volumes *v)
{
    uint64_t count = 0;
    for (uint64_t k = 0; k < v->sizes[0]; k++)
        count += (uint64_t)__builtin_popcount(v->data[0][k]);
    return count;
}

static const struct sdfgi_pass_report *pass_of(enum sdfgi_voxelizer voxelizer)
{
    static struct sdfgi_report report;
    sdfgi_get_report(t.gi, &report);
    return &report.passes[voxelizer == SDFGI_VOXELIZER_RASTER ? PASS_VOXELIZE_RASTER : PASS_VOXELIZE];
}

static struct volumes volumes_of_meshes(const struct box_field *field, enum sdfgi_voxelizer voxelizer)
{
    const struct sdfgi_settings settings = settings_of(voxelizer);
    gi_test_renew(&t, &settings);
    for (uint32_t i = 0; i < 2; i++)
        add_half_as_mesh(field, i, material((int)i));
    gi_test_update(&t, 1);
    return read_volumes();
}

static void require_same(const struct box_field *field, enum sdfgi_voxelizer voxelizer)
{
    const struct sdfgi_settings settings = settings_of(voxelizer);
    struct volumes expected = volumes_of_meshes(field, voxelizer);
    gi_test_renew(&t, &settings);
    add_as_instances(field, 0, field->count);
    gi_test_update(&t, 1);
    struct volumes made = read_volumes();
    REQUIRE_CMP(bits_set(&expected), >, 1000ull);
    require_equal(&expected, &made);
    free_volumes(&expected);
    free_volumes(&made);
}

static void instances_are_as_one_mesh(void **state)
{
    (void)state;
    require_same(&(struct box_field){ 100, 0.5 }, SDFGI_VOXELIZER_COMPUTE);
}

static void instances_are_as_one_mesh_to_the_raster_voxelizer(void **state)
{
    (void)state;
    require_same(&(struct box_field){ 100, 0.5 }, SDFGI_VOXELIZER_RASTER);
}

/* The list is filled several times, and the buffer of instances has grown. */
static void a_crowd_is_as_one_mesh(void **state)
{
    (void)state;
    require_same(&crowd, SDFGI_VOXELIZER_COMPUTE);
    const struct sdfgi_pass_report *pass = pass_of(SDFGI_VOXELIZER_COMPUTE);
    REQUIRE_CMP(pass->work, >, 12ull * SDFGI_MAX_DRAWS);
    REQUIRE_CMP(pass->dispatches, <, 40u);
    REQUIRE_CMP(t.gi->volume.resources->extent.instances, >=, crowd.count);
}

/* ---- Updates that do not run */

static void record_update(VkCommandBuffer cmd, uint32_t index, void *user)
{
    (void)index;
    (void)user;
    REQUIRE_CMP(sdfgi_update(t.gi, cmd, &t.frame), ==, SDFGI_OK);
}

/* What the cancelled update uploaded, into a buffer that it made longer, is uploaded again. */
static void a_cancelled_update_loses_no_instance(void **state)
{
    (void)state;
    const struct box_field field = { 2500, 0.25 };
    const struct sdfgi_settings settings = settings_of(SDFGI_VOXELIZER_COMPUTE);
    struct volumes expected = volumes_of_meshes(&field, SDFGI_VOXELIZER_COMPUTE);
    gi_test_renew(&t, &settings);
    add_as_instances(&field, 0, field.count);
    gpu_test_record_and_drop(&t.gpu, record_update, NULL);
    sdfgi_cancel_update(t.gi);
    gi_test_update(&t, 1);
    struct volumes made = read_volumes();
    require_equal(&expected, &made);
    free_volumes(&made);
    /* Nor does one that nobody cancels, once that has been noticed. */
    sdfgi_reset(t.gi);
    gpu_test_record_and_drop(&t.gpu, record_update, NULL);
    gi_test_update(&t, 4);
    REQUIRE_CMP(t.messages[SDFGI_MESSAGE_UPDATE_LOST], ==, 1u);
    made = read_volumes();
    require_equal(&expected, &made);
    free_volumes(&made);
    free_volumes(&expected);
}

/* The buffer becomes longer while it holds some of them, in an update that is cancelled. */
static void later_instances_lose_no_earlier_one(void **state)
{
    (void)state;
    const struct box_field field = { 2500, 0.25 };
    const struct sdfgi_settings settings = settings_of(SDFGI_VOXELIZER_COMPUTE);
    struct volumes expected = volumes_of_meshes(&field, SDFGI_VOXELIZER_COMPUTE);
    for (int cancels = 0; cancels < 2; cancels++) {
        gi_test_restart(&t, &settings);
        add_as_instances(&field, 0, 900);
        gi_test_update(&t, 2);
        REQUIRE_CMP(t.gi->volume.resources->extent.instances, ==, (uint64_t)SDFGI_FIRST_INSTANCES);
        add_as_instances(&field, 900, field.count);
        if (cancels) {
            gpu_test_record_and_drop(&t.gpu, record_update, NULL);
            sdfgi_cancel_update(t.gi);
        }
        gi_test_update(&t, 8);
        REQUIRE_CMP(t.gi->volume.resources->extent.instances, >, (uint64_t)SDFGI_FIRST_INSTANCES);
        struct volumes made = read_volumes();
        require_equal(&expected, &made);
        free_volumes(&made);
    }
    free_volumes(&expected);
}

static int close_context(void **state)
{
    (void)state;
    gi_test_close(&t);
    return 0;
}

TEST_GROUP(volumes)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_are_as_one_mesh),
        cmocka_unit_test(instances_are_as_one_mesh_to_the_raster_voxelizer),
        cmocka_unit_test(a_crowd_is_as_one_mesh),
        cmocka_unit_test(a_cancelled_update_loses_no_instance),
        cmocka_unit_test(later_instances_lose_no_earlier_one),
    };
    return cmocka_run_group_tests_name("instances_volumes", tests, NULL, close_context);
}

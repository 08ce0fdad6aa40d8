/* SPDX-License-Identifier: MIT
 * The library's own compiled shaders place every shared struct and every resource where C does. */
#include "modules.h"
#include "pass/resource_rows.h"
#include "pass/work.h"
#include "require.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/threads.h"

#include <ctype.h>
#include <stdio.h>

/* ---- Structs */

#define MEMBERS(X)                                                                                           \
    X(sdfgi_dirty_box, low)                                                                                  \
    X(sdfgi_dirty_box, padding_0)                                                                            \
    X(sdfgi_dirty_box, high)                                                                                 \
    X(sdfgi_dirty_box, padding_1)                                                                            \
    X(sdfgi_cascade_params, origin_rel)                                                                      \
    X(sdfgi_cascade_params, cell_m)                                                                          \
    X(sdfgi_cascade_params, wrap)                                                                            \
    X(sdfgi_cascade_params, watched_first)                                                                   \
    X(sdfgi_cascade_params, probe_wrap)                                                                      \
    X(sdfgi_cascade_params, watched_end)                                                                     \
    X(sdfgi_cascade_params, from_first)                                                                      \
    X(sdfgi_cascade_params, from_first_scale)                                                                \
    X(sdfgi_cascade_params, probe_base)                                                                      \
    X(sdfgi_cascade_params, hit_bits)                                                                        \
    X(sdfgi_cascade_params, valid_low)                                                                       \
    X(sdfgi_cascade_params, dirty_count)                                                                     \
    X(sdfgi_cascade_params, valid_high)                                                                      \
    X(sdfgi_cascade_params, hit_part)                                                                        \
    X(sdfgi_cascade_params, blend_low)                                                                       \
    X(sdfgi_cascade_params, padding_4)                                                                       \
    X(sdfgi_cascade_params, blend_high)                                                                      \
    X(sdfgi_cascade_params, padding_5)                                                                       \
    X(sdfgi_cascade_params, places_low)                                                                      \
    X(sdfgi_cascade_params, padding_9)                                                                       \
    X(sdfgi_cascade_params, places_high)                                                                     \
    X(sdfgi_cascade_params, padding_10)                                                                      \
    X(sdfgi_cascade_params, kept_low)                                                                        \
    X(sdfgi_cascade_params, bounds_axis)                                                                     \
    X(sdfgi_cascade_params, kept_high)                                                                       \
    X(sdfgi_cascade_params, padding_6)                                                                       \
    X(sdfgi_cascade_params, content_low)                                                                     \
    X(sdfgi_cascade_params, padding_7)                                                                       \
    X(sdfgi_cascade_params, content_high)                                                                    \
    X(sdfgi_cascade_params, padding_8)                                                                       \
    X(sdfgi_cascade_params, dirty)                                                                           \
    X(sdfgi_frame_params, cascades)                                                                          \
    X(sdfgi_frame_params, sky_zenith)                                                                        \
    X(sdfgi_frame_params, sky_has_harmonics)                                                                 \
    X(sdfgi_frame_params, sky_horizon)                                                                       \
    X(sdfgi_frame_params, up_axis)                                                                           \
    X(sdfgi_frame_params, sky_ground)                                                                        \
    X(sdfgi_frame_params, has_metal)                                                                         \
    X(sdfgi_frame_params, epoch)                                                                             \
    X(sdfgi_frame_params, epoch_of_all)                                                                      \
    X(sdfgi_frame_params, edited_count)                                                                      \
    X(sdfgi_frame_params, epoch_of_drift)                                                                    \
    X(sdfgi_frame_params, drift)                                                                             \
    X(sdfgi_frame_params, changes_are_local)                                                                 \
    X(sdfgi_frame_params, epoch_of_local)                                                                    \
    X(sdfgi_frame_params, flicker)                                                                           \
    X(sdfgi_frame_params, edited_emitter_count)                                                              \
    X(sdfgi_frame_params, keeps_low_light)                                                                   \
    X(sdfgi_frame_params, low_light_begin)                                                                   \
    X(sdfgi_frame_params, edited)                                                                            \
    X(sdfgi_frame_params, edited_emitters)                                                                   \
    X(sdfgi_frame_params, y_scale)                                                                           \
    X(sdfgi_frame_params, exposure)                                                                          \
    X(sdfgi_frame_params, exposure_inverse)                                                                  \
    X(sdfgi_frame_params, energy)                                                                            \
    X(sdfgi_frame_params, normal_bias)                                                                       \
    X(sdfgi_frame_params, probe_bias)                                                                        \
    X(sdfgi_frame_params, bounce_feedback)                                                                   \
    X(sdfgi_frame_params, emission_scale)                                                                    \
    X(sdfgi_frame_params, resolution)                                                                        \
    X(sdfgi_frame_params, resolution_log2)                                                                   \
    X(sdfgi_frame_params, probes_per_side)                                                                   \
    X(sdfgi_frame_params, cascade_count)                                                                     \
    X(sdfgi_frame_params, light_count)                                                                       \
    X(sdfgi_frame_params, light_cell_room)                                                                   \
    X(sdfgi_frame_params, visibility)                                                                        \
    X(sdfgi_frame_params, seed)                                                                              \
    X(sdfgi_frame_params, rays_per_frame)                                                                    \
    X(sdfgi_frame_params, first_sample)                                                                      \
    X(sdfgi_frame_params, cycle_samples)                                                                     \
    X(sdfgi_frame_params, cycle_visits)                                                                      \
    X(sdfgi_frame_params, emitter_samples)                                                                   \
    X(sdfgi_frame_params, dark)                                                                              \
    X(sdfgi_frame_params, rays_blend)                                                                        \
    X(sdfgi_frame_params, rays_end)                                                                          \
    X(sdfgi_frame_params, next_epoch)                                                                        \
    X(sdfgi_frame_params, sky_harmonics)                                                                     \
    X(sdfgi_light_params, position)                                                                          \
    X(sdfgi_light_params, range_m)                                                                           \
    X(sdfgi_light_params, direction)                                                                         \
    X(sdfgi_light_params, cos_outer)                                                                         \
    X(sdfgi_light_params, intensity)                                                                         \
    X(sdfgi_light_params, cone_scale)                                                                        \
    X(sdfgi_light_params, kind)                                                                              \
    X(sdfgi_light_params, bit)                                                                               \
    X(sdfgi_light_params, padding_0)                                                                         \
    X(sdfgi_light_params, padding_1)                                                                         \
    X(sdfgi_material_params, albedo)                                                                         \
    X(sdfgi_material_params, alpha)                                                                          \
    X(sdfgi_material_params, emission)                                                                       \
    X(sdfgi_material_params, alpha_cutoff)                                                                   \
    X(sdfgi_material_params, albedo_uv)                                                                      \
    X(sdfgi_material_params, emission_uv)                                                                    \
    X(sdfgi_material_params, flags)                                                                          \
    X(sdfgi_material_params, specular_albedo)                                                                \
    X(sdfgi_material_params, padding_0)                                                                      \
    X(sdfgi_material_params, padding_1)                                                                      \
    X(sdfgi_cascade_args, cascade)                                                                           \
    X(sdfgi_region_args, low)                                                                                \
    X(sdfgi_region_args, cascade)                                                                            \
    X(sdfgi_region_args, high)                                                                               \
    X(sdfgi_region_args, bounds_axis)                                                                        \
    X(sdfgi_region_args, before)                                                                             \
    X(sdfgi_region_args, padding_0)                                                                          \
    X(sdfgi_voxelize_args, bounds_min)                                                                       \
    X(sdfgi_voxelize_args, cascade)                                                                          \
    X(sdfgi_voxelize_args, bounds_max)                                                                       \
    X(sdfgi_voxelize_args, triangle_count)                                                                   \
    X(sdfgi_voxelize_args, corner_low)                                                                       \
    X(sdfgi_voxelize_args, slices)                                                                           \
    X(sdfgi_voxelize_args, corner_high)                                                                      \
    X(sdfgi_voxelize_args, flags)                                                                            \
    X(sdfgi_voxelize_args, position_fetch)                                                                   \
    X(sdfgi_voxelize_args, position_stride)                                                                  \
    X(sdfgi_voxelize_args, uv_fetch)                                                                         \
    X(sdfgi_voxelize_args, uv_stride)                                                                        \
    X(sdfgi_voxelize_args, color_fetch)                                                                      \
    X(sdfgi_voxelize_args, color_stride)                                                                     \
    X(sdfgi_voxelize_args, vertex_offset)                                                                    \
    X(sdfgi_voxelize_args, vertex_count)                                                                     \
    X(sdfgi_voxelize_args, box_low)                                                                          \
    X(sdfgi_voxelize_args, box_high)                                                                         \
    X(sdfgi_voxelize_args, first_draw)                                                                       \
    X(sdfgi_voxelize_args, draw_count)                                                                       \
    X(sdfgi_instance_params, row_x)                                                                          \
    X(sdfgi_instance_params, place_low_x)                                                                    \
    X(sdfgi_instance_params, row_y)                                                                          \
    X(sdfgi_instance_params, place_low_y)                                                                    \
    X(sdfgi_instance_params, row_z)                                                                          \
    X(sdfgi_instance_params, place_low_z)                                                                    \
    X(sdfgi_instance_params, place_high)                                                                     \
    X(sdfgi_instance_params, material)                                                                       \
    X(sdfgi_distance_prepare_args, cascade)                                                                  \
    X(sdfgi_distance_prepare_args, first_block)                                                              \
    X(sdfgi_distance_prepare_args, row_groups)                                                               \
    X(sdfgi_distance_prepare_args, box_count)                                                                \
    X(sdfgi_distance_prepare_args, corners)                                                                  \
    X(sdfgi_distance_search_args, cascade)                                                                   \
    X(sdfgi_distance_search_args, first_x)                                                                   \
    X(sdfgi_distance_search_args, end_x)                                                                     \
    X(sdfgi_flood_args, cascade)                                                                             \
    X(sdfgi_flood_args, jump)                                                                                \
    X(sdfgi_flood_args, source)                                                                              \
    X(sdfgi_light_mark_args, cascade)                                                                        \
    X(sdfgi_light_mark_args, rebuild)                                                                        \
    X(sdfgi_light_direct_args, cascade)                                                                      \
    X(sdfgi_light_direct_args, only_dirty)                                                                   \
    X(sdfgi_light_direct_args, first)                                                                        \
    X(sdfgi_light_direct_args, end)                                                                          \
    X(sdfgi_light_direct_args, threads_per_ray)                                                              \
    X(sdfgi_light_direct_args, changed)                                                                      \
    X(sdfgi_light_direct_args, moved)                                                                        \
    X(sdfgi_light_direct_args, lit)                                                                          \
    X(sdfgi_light_bounce_args, cascade)                                                                      \
    X(sdfgi_light_bounce_args, only_dirty)                                                                   \
    X(sdfgi_light_bounce_args, visited)                                                                      \
    X(sdfgi_light_bounce_args, lit)                                                                          \
    X(sdfgi_light_bounce_args, end)                                                                          \
    X(sdfgi_visit_list_args, first)                                                                          \
    X(sdfgi_visit_list_args, end)                                                                            \
    X(sdfgi_visit_list_args, groups)                                                                         \
    X(sdfgi_light_bounce_args, without_probes)                                                               \
    X(sdfgi_probe_blend_args, cycle_ends)                                                                    \
    X(sdfgi_probe_blend_args, marks)                                                                         \
    X(sdfgi_probe_blend_args, without_history)                                                               \
    X(sdfgi_gather_args, inverse_view_projection)                                                            \
    X(sdfgi_gather_args, width)                                                                              \
    X(sdfgi_gather_args, height)                                                                             \
    X(sdfgi_gather_args, background_depth)                                                                   \
    X(sdfgi_gather_args, step)                                                                               \
    X(sdfgi_gather_args, scale)                                                                              \
    X(sdfgi_gather_args, ray_step)                                                                           \
    X(sdfgi_gather_args, filter_step)                                                                        \
    X(sdfgi_debug_view_args, inverse_view_projection)                                                        \
    X(sdfgi_debug_view_args, width)                                                                          \
    X(sdfgi_debug_view_args, height)                                                                         \
    X(sdfgi_debug_view_args, background_depth)                                                               \
    X(sdfgi_debug_view_args, view)                                                                           \
    X(sdfgi_debug_view_args, exposure)                                                                       \
    X(sdfgi_debug_view_args, slice_m)

struct place {
    const char *type, *name;
    size_t offset, size;
    uint32_t seen;
};

static struct place places[] = {
#define ROW(type, name) { #type, #name, offsetof(struct type, name), sizeof(((struct type *)0)->name), 0 },
    MEMBERS(ROW)
#undef ROW
};

/* Structs that lie in arrays: their size is the distance between elements. */
static struct {
    const char *type;
    size_t size;
    uint32_t seen;
} elements[] = {
    { "sdfgi_cascade_params", sizeof(struct sdfgi_cascade_params), 0 },
    { "sdfgi_light_params", sizeof(struct sdfgi_light_params), 0 },
    { "sdfgi_material_params", sizeof(struct sdfgi_material_params), 0 },
};

enum { PLACES = sizeof places / sizeof *places, ELEMENTS = sizeof elements / sizeof *elements };

/* Member `index` of a struct. */
struct member {
    spvc_compiler spirv;
    spvc_type owner, type;
    unsigned index;
    const char *owner_name, *name;
};

static void check_stride(const struct member *m)
{
    const char *element = spvc_compiler_get_name(m->spirv, spvc_type_get_base_type_id(m->type));
    unsigned stride;
    REQUIRE_CMP(spvc_compiler_type_struct_member_array_stride(m->spirv, m->owner, m->index, &stride), ==,
                SPVC_SUCCESS);
    for (int i = 0; i < ELEMENTS; i++)
        if (strcmp(elements[i].type, element) == 0) {
            if (stride != elements[i].size)
                require_fail(__FILE__, __LINE__, "%s: %u bytes apart, %zu in C", element, stride,
                             elements[i].size);
            elements[i].seen++;
        }
}

static bool is_shared(const char *type)
{
    for (int i = 0; i < PLACES; i++)
        if (strcmp(places[i].type, type) == 0)
            return true;
    return false;
}

static struct place *place_find(const struct member *m)
{
    for (int i = 0; i < PLACES; i++)
        if (strcmp(places[i].type, m->owner_name) == 0 && strcmp(places[i].name, m->name) == 0)
            return &places[i];
    require_fail(__FILE__, __LINE__, "%s.%s: not in the table of this test", m->owner_name, m->name);
    return NULL;
}

static void check_place(const struct member *m)
{
    struct place *place = place_find(m);
    unsigned offset;
    size_t size;
    REQUIRE_CMP(spvc_compiler_type_struct_member_offset(m->spirv, m->owner, m->index, &offset), ==,
                SPVC_SUCCESS);
    REQUIRE_CMP(spvc_compiler_get_declared_struct_member_size(m->spirv, m->owner, m->index, &size), ==,
                SPVC_SUCCESS);
    if (offset != place->offset || size != place->size)
        require_fail(__FILE__, __LINE__, "%s.%s: %zu bytes at %u, in C %zu at %zu", m->owner_name, m->name,
                     size, offset, place->size, place->offset);
    place->seen++;
}

static void check_struct(spvc_compiler spirv, spvc_type_id id)
{
    struct member m = { .spirv = spirv, .owner = spvc_compiler_get_type_handle(spirv, id) };
    m.owner_name = spvc_compiler_get_name(spirv, id);
    for (; m.index < spvc_type_get_num_member_types(m.owner); m.index++) {
        m.type = spvc_compiler_get_type_handle(spirv, spvc_type_get_member_type(m.owner, m.index));
        m.name = spvc_compiler_get_member_name(spirv, id, m.index);
        if (is_shared(m.owner_name))
            check_place(&m);
        if (spvc_type_get_basetype(m.type) != SPVC_BASETYPE_STRUCT)
            continue;
        if (spvc_type_get_num_array_dimensions(m.type))
            check_stride(&m);
        check_struct(spirv, spvc_type_get_base_type_id(m.type));
    }
}

static void check_structs(const struct module *module)
{
    struct module_resource resources[MODULE_RESOURCES_MAX];
    const size_t count = module_resources(module, resources);
    const spvc_type_id push = module_push_type(module);
    for (size_t i = 0; i < count; i++)
        check_struct(module->spirv, resources[i].type);
    if (push)
        check_struct(module->spirv, push);
}

static void shaders_lay_out_every_shared_struct_as_c_does(void **state)
{
    (void)state;
    for (size_t i = 0; i < module_count; i++)
        check_structs(&modules[i]);
    for (int i = 0; i < PLACES; i++)
        if (!places[i].seen)
            require_fail(__FILE__, __LINE__, "%s.%s: in no shader", places[i].type, places[i].name);
    for (int i = 0; i < ELEMENTS; i++)
        REQUIRE_CMP(elements[i].seen, >, 0u);
}

/* ---- Bindings */

_Static_assert((int)RESOURCE_SET_LOOKUP == SDFGI_SET_LOOKUP && (int)RESOURCE_SET_WORK == SDFGI_SET_WORK,
               "resources are bound in the sets that their rows name");

/* Block of a buffer of the resource table, sdfgi_<id>_buffer, or its texels, sdfgi_<id>_view; the table's
 * names are "sdfgi <ID>". */
static void block_name(int resource, bool texels, char name[static 64])
{
    snprintf(name, 64, "%s_%s", sdfgi_resource_row((enum resource)resource)->name,
             texels ? "view" : "buffer");
    for (char *c = name; *c; c++)
        *c = *c == ' ' ? '_' : (char)tolower((unsigned char)*c);
}

static bool is_texels(const struct module_resource *r)
{
    return r->kind == SPVC_RESOURCE_TYPE_SAMPLED_IMAGE;
}

/* The resource that a block stands for; RESOURCE_COUNT: none. */
static int resource_of(const struct module_resource *r)
{
    char name[64];
    for (int i = 0; i < RESOURCE_COUNT; i++) {
        block_name(i, is_texels(r), name);
        if (strcmp(r->block, name) == 0)
            return i;
    }
    return RESOURCE_COUNT;
}

static void check_binding(const struct module *module, const struct module_resource *r,
                          uint32_t seen[static RESOURCE_COUNT])
{
    const int resource = resource_of(r);
    if (resource == RESOURCE_COUNT && r->set != SDFGI_SET_LOOKUP && r->set != SDFGI_SET_WORK)
        return;
    if (resource == RESOURCE_COUNT)
        require_fail(__FILE__, __LINE__, "%s: %s is not in the resource table", module->name, r->block);
    const struct resource_row *row = sdfgi_resource_row((enum resource)resource);
    const uint32_t binding = row->binding + (is_texels(r) ? SDFGI_BINDING_TEXELS : 0);
    if (r->set != (uint32_t)row->set || r->binding != binding)
        require_fail(__FILE__, __LINE__, "%s: %s has set %u, binding %u, in the resource table %u, %u",
                     module->name, r->block, r->set, r->binding, (unsigned)row->set, binding);
    if (is_texels(r)) {
        REQUIRE_CMP(row->texels, !=, VK_FORMAT_UNDEFINED);
        return;
    }
    const bool uniform = row->kind == RESOURCE_KIND_UNIFORM;
    REQUIRE_CMP(r->kind, ==, uniform ? SPVC_RESOURCE_TYPE_UNIFORM_BUFFER : SPVC_RESOURCE_TYPE_STORAGE_BUFFER);
    seen[resource]++;
}

static void shaders_bind_every_resource_where_the_table_says(void **state)
{
    (void)state;
    uint32_t seen[RESOURCE_COUNT] = { 0 };
    for (size_t i = 0; i < module_count; i++) {
        struct module_resource resources[MODULE_RESOURCES_MAX];
        const size_t count = module_resources(&modules[i], resources);
        for (size_t k = 0; k < count; k++)
            check_binding(&modules[i], &resources[k], seen);
    }
    for (int i = 0; i < RESOURCE_COUNT; i++)
        if (!seen[i])
            require_fail(__FILE__, __LINE__, "%s: in no shader", sdfgi_resource_row((enum resource)i)->name);
}

/* Bindings of a set are 0, 1, ... in the order of its rows: set layouts and pools count on it. */
static void rows_of_a_set_stand_in_the_order_of_their_bindings(void **state)
{
    (void)state;
    uint32_t count[RESOURCE_SET_COUNT] = { 0 };
    for (int i = 0; i < RESOURCE_COUNT; i++) {
        const struct resource_row *row = sdfgi_resource_row((enum resource)i);
        REQUIRE_CMP(row->binding, ==, count[row->set]);
        count[row->set]++;
    }
    for (int i = 0; i < RESOURCE_SET_COUNT; i++)
        REQUIRE_CMP(sdfgi_resource_set_size((enum resource_set)i), ==, count[i]);
}

/* ---- Threads */

/* Threads without rays would leave what they have to forget. */
static void every_thread_of_a_probe_has_rays(void **state)
{
    (void)state;
    for (uint32_t samples = 1; samples <= 1 << 16; samples++) {
        const uint32_t rays = sdfgi_invalidate_rays(samples), threads = sdfgi_invalidate_threads(samples);
        REQUIRE_TRUE(threads >= 1 && threads <= SDFGI_GROUP_LINEAR);
        REQUIRE_TRUE((threads - 1) * rays < samples && threads * rays >= samples);
    }
}

/* ---- Push constants */

_Static_assert(sizeof(struct sdfgi_voxelize_args) <= 128, "Vulkan promises 128 bytes");
_Static_assert(sizeof(struct sdfgi_gather_args) <= 128, "Vulkan promises 128 bytes");
_Static_assert(sizeof(struct sdfgi_distance_prepare_args) <= 128, "Vulkan promises 128 bytes");
_Static_assert(sizeof(struct sdfgi_region_args) <= sizeof(struct sdfgi_distance_prepare_args),
               "they share a layout");

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_lay_out_every_shared_struct_as_c_does),
        cmocka_unit_test(shaders_bind_every_resource_where_the_table_says),
        cmocka_unit_test(rows_of_a_set_stand_in_the_order_of_their_bindings),
        cmocka_unit_test(every_thread_of_a_probe_has_rays),
    };
    return cmocka_run_group_tests_name("layout", tests, modules_open, modules_close);
}

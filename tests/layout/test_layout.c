/* SPDX-License-Identifier: MIT
 * The library's own compiled shaders place every shared struct and every resource where C does. */
#include "internal.h"
#include "require.h"
#include "spirv.h"

#include "cell_mask.comp.h"
#include "distance_exact.comp.h"
#include "distance_plane.comp.h"
#include "distance_prepare.comp.h"
#include "flood_distance.comp.h"
#include "flood_seed.comp.h"
#include "flood_step.comp.h"
#include "gather.comp.h"
#include "light_bounce.comp.h"
#include "light_direct.comp.h"
#include "light_list.comp.h"
#include "light_mark.comp.h"
#include "occlusion_trace.comp.h"
#include "probe_blend.comp.h"
#include "probe_place.comp.h"
#include "probe_seed.comp.h"
#include "probe_sum.comp.h"
#include "probe_trace.comp.h"
#include "ray_forget.comp.h"
#include "ray_list.comp.h"
#include "region_clear.comp.h"
#include "voxel_resolve.comp.h"
#include "voxelize.comp.h"
#include "voxelize_raster.frag.h"
#include "voxelize_raster.vert.h"
#include "voxelize_raster_textured.frag.h"
#include "voxelize_textured.comp.h"

#include <ctype.h>
#include <stdio.h>

#define MODULE(name)                                                                                         \
    {                                                                                                        \
        name, sizeof name                                                                                    \
    }
static const struct {
    const uint32_t *code;
    size_t size;
} modules[] = {
    MODULE(cell_mask_comp),
    MODULE(distance_exact_comp),
    MODULE(distance_plane_comp),
    MODULE(distance_prepare_comp),
    MODULE(flood_distance_comp),
    MODULE(flood_seed_comp),
    MODULE(flood_step_comp),
    MODULE(gather_comp),
    MODULE(light_bounce_comp),
    MODULE(light_direct_comp),
    MODULE(light_list_comp),
    MODULE(light_mark_comp),
    MODULE(occlusion_trace_comp),
    MODULE(probe_blend_comp),
    MODULE(probe_place_comp),
    MODULE(probe_seed_comp),
    MODULE(probe_sum_comp),
    MODULE(probe_trace_comp),
    MODULE(ray_forget_comp),
    MODULE(ray_list_comp),
    MODULE(region_clear_comp),
    MODULE(voxel_resolve_comp),
    MODULE(voxelize_comp),
    MODULE(voxelize_raster_frag),
    MODULE(voxelize_raster_vert),
    MODULE(voxelize_textured_comp),
    MODULE(voxelize_raster_textured_frag),
};

static void visit_all(const struct spirv_visitor *visitor)
{
    for (size_t i = 0; i < sizeof modules / sizeof *modules; i++)
        spirv_visit(modules[i].code, modules[i].size, visitor);
}

/* ---- Structs */

#define MEMBERS(X)                                                                                           \
    X(sdfgi_dirty_box, low)                                                                                  \
    X(sdfgi_dirty_box, padding_0)                                                                            \
    X(sdfgi_dirty_box, high)                                                                                 \
    X(sdfgi_dirty_box, padding_1)                                                                            \
    X(sdfgi_cascade_params, origin_rel)                                                                      \
    X(sdfgi_cascade_params, cell_m)                                                                          \
    X(sdfgi_cascade_params, wrap)                                                                            \
    X(sdfgi_cascade_params, padding_0)                                                                       \
    X(sdfgi_cascade_params, probe_wrap)                                                                      \
    X(sdfgi_cascade_params, padding_1)                                                                       \
    X(sdfgi_cascade_params, from_first)                                                                      \
    X(sdfgi_cascade_params, from_first_scale)                                                                \
    X(sdfgi_cascade_params, probe_base)                                                                      \
    X(sdfgi_cascade_params, padding_2)                                                                       \
    X(sdfgi_cascade_params, valid_low)                                                                       \
    X(sdfgi_cascade_params, dirty_count)                                                                     \
    X(sdfgi_cascade_params, valid_high)                                                                      \
    X(sdfgi_cascade_params, padding_3)                                                                       \
    X(sdfgi_cascade_params, blend_low)                                                                       \
    X(sdfgi_cascade_params, padding_4)                                                                       \
    X(sdfgi_cascade_params, blend_high)                                                                      \
    X(sdfgi_cascade_params, padding_5)                                                                       \
    X(sdfgi_cascade_params, kept_low)                                                                        \
    X(sdfgi_cascade_params, bounds_axis)                                                                     \
    X(sdfgi_cascade_params, kept_high)                                                                       \
    X(sdfgi_cascade_params, padding_6)                                                                       \
    X(sdfgi_cascade_params, dirty)                                                                           \
    X(sdfgi_frame_params, cascades)                                                                          \
    X(sdfgi_frame_params, sky_zenith)                                                                        \
    X(sdfgi_frame_params, padding_0)                                                                         \
    X(sdfgi_frame_params, sky_horizon)                                                                       \
    X(sdfgi_frame_params, padding_1)                                                                         \
    X(sdfgi_frame_params, sky_ground)                                                                        \
    X(sdfgi_frame_params, padding_2)                                                                         \
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
    X(sdfgi_frame_params, brightest_texel)                                                                   \
    X(sdfgi_light_params, position)                                                                          \
    X(sdfgi_light_params, range_m)                                                                           \
    X(sdfgi_light_params, direction)                                                                         \
    X(sdfgi_light_params, cos_outer)                                                                         \
    X(sdfgi_light_params, intensity)                                                                         \
    X(sdfgi_light_params, cone_scale)                                                                        \
    X(sdfgi_light_params, kind)                                                                              \
    X(sdfgi_light_params, padding_0)                                                                         \
    X(sdfgi_light_params, padding_1)                                                                         \
    X(sdfgi_light_params, padding_2)                                                                         \
    X(sdfgi_material_params, albedo)                                                                         \
    X(sdfgi_material_params, alpha)                                                                          \
    X(sdfgi_material_params, emission)                                                                       \
    X(sdfgi_material_params, alpha_cutoff)                                                                   \
    X(sdfgi_material_params, albedo_uv)                                                                      \
    X(sdfgi_material_params, emission_uv)                                                                    \
    X(sdfgi_material_params, flags)                                                                          \
    X(sdfgi_material_params, padding_0)                                                                      \
    X(sdfgi_material_params, padding_1)                                                                      \
    X(sdfgi_material_params, padding_2)                                                                      \
    X(sdfgi_cascade_args, cascade)                                                                           \
    X(sdfgi_region_args, low)                                                                                \
    X(sdfgi_region_args, cascade)                                                                            \
    X(sdfgi_region_args, high)                                                                               \
    X(sdfgi_region_args, bounds_axis)                                                                        \
    X(sdfgi_region_args, before)                                                                             \
    X(sdfgi_region_args, padding_0)                                                                          \
    X(sdfgi_voxelize_args, rows)                                                                             \
    X(sdfgi_voxelize_args, anchor)                                                                           \
    X(sdfgi_voxelize_args, box_low)                                                                          \
    X(sdfgi_voxelize_args, cascade)                                                                          \
    X(sdfgi_voxelize_args, triangle_count)                                                                   \
    X(sdfgi_voxelize_args, groups)                                                                           \
    X(sdfgi_voxelize_args, slices)                                                                           \
    X(sdfgi_voxelize_args, material)                                                                         \
    X(sdfgi_voxelize_args, flags)                                                                            \
    X(sdfgi_voxelize_args, position_offset)                                                                  \
    X(sdfgi_voxelize_args, position_stride)                                                                  \
    X(sdfgi_voxelize_args, uv_offset)                                                                        \
    X(sdfgi_voxelize_args, uv_stride)                                                                        \
    X(sdfgi_voxelize_args, color_offset)                                                                     \
    X(sdfgi_voxelize_args, color_stride)                                                                     \
    X(sdfgi_voxelize_args, index_offset)                                                                     \
    X(sdfgi_voxelize_args, vertex_count)                                                                     \
    X(sdfgi_voxelize_args, group_width)                                                                      \
    X(sdfgi_voxelize_args, box_high)                                                                         \
    X(sdfgi_distance_prepare_args, cascade)                                                                  \
    X(sdfgi_distance_prepare_args, first_block)                                                              \
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
    X(sdfgi_light_bounce_args, cascade)                                                                      \
    X(sdfgi_light_bounce_args, only_dirty)                                                                   \
    X(sdfgi_light_bounce_args, first)                                                                        \
    X(sdfgi_light_bounce_args, end)                                                                          \
    X(sdfgi_light_bounce_args, without_probes)                                                               \
    X(sdfgi_probe_blend_args, cycle_ends)                                                                    \
    X(sdfgi_probe_blend_args, without_history)                                                               \
    X(sdfgi_gather_args, inverse_view_projection)                                                            \
    X(sdfgi_gather_args, width)                                                                              \
    X(sdfgi_gather_args, height)                                                                             \
    X(sdfgi_gather_args, background_depth)                                                                   \
    X(sdfgi_gather_args, padding_0)

struct place {
    const char *type, *name;
    size_t offset;
    uint32_t seen;
};

static struct place places[] = {
#define ROW(type, name) { #type, #name, offsetof(struct type, name), 0 },
    MEMBERS(ROW)
#undef ROW
};

/* Structs that lie in arrays: their size is the distance between elements. */
static struct place sizes[] = {
    { "sdfgi_cascade_params", "", sizeof(struct sdfgi_cascade_params), 0 },
    { "sdfgi_light_params", "", sizeof(struct sdfgi_light_params), 0 },
    { "sdfgi_material_params", "", sizeof(struct sdfgi_material_params), 0 },
};

enum { PLACES = sizeof places / sizeof *places, SIZES = sizeof sizes / sizeof *sizes };

static bool is_shared(const char *type)
{
    for (int i = 0; i < PLACES; i++)
        if (strcmp(places[i].type, type) == 0)
            return true;
    return false;
}

static void check_size(const struct spirv_member *m)
{
    for (int i = 0; i < SIZES; i++)
        if (strcmp(sizes[i].type, m->element) == 0) {
            if (m->array_stride != sizes[i].offset)
                require_fail(__FILE__, __LINE__, "%s: %u bytes apart, %zu in C", m->element, m->array_stride,
                             sizes[i].offset);
            sizes[i].seen++;
        }
}

static void check_member(void *user, const struct spirv_member *m)
{
    (void)user;
    if (m->array_stride)
        check_size(m);
    if (!is_shared(m->type))
        return;
    for (int i = 0; i < PLACES; i++)
        if (strcmp(places[i].type, m->type) == 0 && strcmp(places[i].name, m->name) == 0) {
            if (m->offset != places[i].offset)
                require_fail(__FILE__, __LINE__, "%s.%s: at %u, in C at %zu", m->type, m->name, m->offset,
                             places[i].offset);
            places[i].seen++;
            return;
        }
    require_fail(__FILE__, __LINE__, "%s.%s: not in the table of this test", m->type, m->name);
}

static void shaders_lay_out_every_shared_struct_as_c_does(void **state)
{
    (void)state;
    visit_all(&(struct spirv_visitor){ .member = check_member });
    for (int i = 0; i < PLACES; i++)
        if (!places[i].seen)
            require_fail(__FILE__, __LINE__, "%s.%s: in no shader", places[i].type, places[i].name);
    for (int i = 0; i < SIZES; i++)
        REQUIRE_CMP(sizes[i].seen, >, 0u);
}

/* ---- Bindings */

#define SAME_BINDING(id, category, size, lifetime)                                                           \
    _Static_assert((int)RESOURCE_##id == SDFGI_BINDING_##id, "bindings.h follows the resource table: " #id);
SDFGI_BUFFERS(SAME_BINDING)
#undef SAME_BINDING
_Static_assert((int)RESOURCE_IRRADIANCE == SDFGI_BINDING_IRRADIANCE, "the atlas follows the buffers");
_Static_assert((int)RESOURCE_IRRADIANCE + 1 == SDFGI_BINDING_IRRADIANCE_STORE,
               "then the atlas as it is written");

static const char *const resource_ids[RESOURCE_COUNT] = {
#define ROW(id, category, size, lifetime) #id,
    SDFGI_BUFFERS(ROW)
#undef ROW
        "IRRADIANCE",
};

/* Block of a buffer of the resource table: sdfgi_<id>_buffer. */
static void block_name(int resource, char name[static 64])
{
    snprintf(name, 64, "sdfgi_%s_buffer", resource_ids[resource]);
    for (char *c = name; *c; c++)
        *c = (char)tolower((unsigned char)*c);
}

static uint32_t blocks_seen[RESOURCE_COUNT];

static void check_binding(void *user, const struct spirv_binding *b)
{
    (void)user;
    char name[64];
    if (b->set != 0)
        return;
    if (strcmp(b->name, "sdfgi_irradiance_atlas") == 0) {
        REQUIRE_CMP(b->binding, ==, (uint32_t)SDFGI_BINDING_IRRADIANCE);
        blocks_seen[RESOURCE_IRRADIANCE]++;
        return;
    }
    for (int i = 0; i < RESOURCE_BUFFER_COUNT; i++) {
        block_name(i, name);
        if (strcmp(b->type, name) != 0)
            continue;
        if (b->binding != (uint32_t)i)
            require_fail(__FILE__, __LINE__, "%s: binding %u, in the resource table %d", name, b->binding, i);
        blocks_seen[i]++;
        return;
    }
    if (b->binding != SDFGI_BINDING_IRRADIANCE_STORE)
        require_fail(__FILE__, __LINE__, "%s %s: binding %u is none of the resource table's", b->type,
                     b->name, b->binding);
}

static void shaders_bind_every_resource_where_the_table_says(void **state)
{
    (void)state;
    visit_all(&(struct spirv_visitor){ .binding = check_binding });
    for (int i = 0; i < RESOURCE_COUNT; i++)
        if (!blocks_seen[i])
            require_fail(__FILE__, __LINE__, "%s: in no shader", resource_ids[i]);
}

/* ---- Push constants */

static void push_constants_fit_everywhere(void **state)
{
    (void)state;
    /* Vulkan promises 128 bytes. */
    REQUIRE_CMP(sizeof(struct sdfgi_voxelize_args), <=, 128u);
    REQUIRE_CMP(sizeof(struct sdfgi_gather_args), <=, 128u);
    REQUIRE_CMP(sizeof(struct sdfgi_distance_prepare_args), <=, 128u);
    REQUIRE_CMP(sizeof(struct sdfgi_region_args), <=,
                sizeof(struct sdfgi_distance_prepare_args)); /* they share a layout */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shaders_lay_out_every_shared_struct_as_c_does),
        cmocka_unit_test(shaders_bind_every_resource_where_the_table_says),
        cmocka_unit_test(push_constants_fit_everywhere),
    };
    return cmocka_run_group_tests_name("layout", tests, NULL, NULL);
}

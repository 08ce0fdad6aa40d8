/* SPDX-License-Identifier: MIT */
#include "scroll_scene.h"

#include "light_scene.h"
#include "require.h"
#include "test_memory.h"

#include <stdio.h>
#include <stdlib.h>

bool scroll_is_full(void)
{
    return getenv("SDFGI_TEST_FULL") != NULL;
}

uint32_t scroll_resolution(void)
{
    return scroll_is_full() ? 128 : 64;
}

struct sdfgi_settings scroll_settings(uint32_t resolution)
{
    struct sdfgi_settings settings = light_settings(resolution, 0.25f);
    settings.cascades = 2;
    return settings;
}

void scroll_use_cells(struct sdfgi_settings *settings, uint32_t visits)
{
    settings->surface_light = SDFGI_SURFACE_LIGHT_CELLS;
    settings->cell_rays_per_frame = scroll_is_full() ? 1 << 22 : 1 << 15;
    settings->cell_rays = visits * SDFGI_VISIT_RAYS * (scroll_is_full() ? 2 : 1);
}

static void add_boxes(struct gi_test *t, const double center[static 3], double reach)
{
    struct test_random random = { 7 };
    const uint32_t count = (uint32_t)(reach * 1.5);
    for (uint32_t i = 0; i < count && i < 40; i++) {
        double low[3], high[3];
        float albedo[3];
        for (int k = 0; k < 3; k++) {
            low[k] = center[k] + test_random_real(&random, -reach, reach) * (k == 1 ? 0.3 : 1);
            high[k] = low[k] + test_random_real(&random, 0.3, 3);
            albedo[k] = (float)test_random_real(&random, 0.05, 0.9);
        }
        light_add_box(t, low, high, albedo, i % 5 == 0 ? 1.5f : 0);
    }
}

void scroll_world(struct gi_test *t, const double center[static 3], double reach)
{
    const double ground[3] = { center[0], center[1] - 2.1, center[2] }, u[3] = { 0, 0.4, 2 * reach },
                 v[3] = { 2 * reach, 0, 0 };
    light_add(t, test_mesh_plane(ground, u, v, 4), 0.5f, 0);
    scroll_air(t, center, reach);
}

void scroll_air(struct gi_test *t, const double center[static 3], double reach)
{
    const double c[3] = { center[0], center[1], center[2] };
    add_boxes(t, c, reach);
    const double low[3] = { c[0] - reach, c[1] - 3, c[2] - reach },
                 high[3] = { c[0] + reach, c[1] + 3, c[2] + reach };
    light_add(t, test_mesh_soup(11, 150, low, high, 1.2), 0.4f, 0);
    const struct sdfgi_light_desc sun = light_sun(-0.5f, -0.8f, 0.2f, 5),
                                  lamp = light_point(c[0] + 1.3, c[1] + 2.5, c[2] + 0.4, 30);
    light_create(t, &sun);
    light_create(t, &lamp);
    REQUIRE_CMP(
        sdfgi_set_sky(t->gi, &(struct sdfgi_sky){ { 0.5f, 0.7f, 1 }, { 1, 1, 1 }, { 0.2f, 0.2f, 0.1f } }), ==,
        SDFGI_OK);
}

void scroll_colored_box(struct gi_test *t, const double center[static 3], double half)
{
    static const float red[3] = { 0.63f, 0.065f, 0.05f }, green[3] = { 0.14f, 0.45f, 0.09f },
                       white[3] = { 0.73f, 0.71f, 0.68f };
    const double h = half, out = half + 0.3;
    const struct {
        double low[3], high[3];
        const float *albedo;
    } walls[5] = {
        { { -out, -out, -h }, { -h, out, h }, red },       { { h, -out, -h }, { out, out, h }, green },
        { { -h, -out, -h }, { h, -h, h }, white },         { { -h, h, -h }, { h, out, h }, white },
        { { -out, -out, -out }, { out, out, -h }, white },
    };
    for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
        double low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = center[k] + walls[i].low[k];
            high[k] = center[k] + walls[i].high[k];
        }
        light_add_box(t, low, high, walls[i].albedo, 0);
    }
    const struct sdfgi_light_desc lamp =
        light_point(center[0] + 0.2, center[1] + 0.7 * half, center[2] - 0.1, 20);
    light_create(t, &lamp);
}

void scroll_stand(struct gi_test *t, const double position[static 3])
{
    memcpy(t->frame.camera_position, position, sizeof t->frame.camera_position);
}

void scroll_place_as(struct gi_test *fresh, const struct gi_test *walked)
{
    for (uint32_t c = 0; c < fresh->gi->settings.cascades; c++) {
        struct cascade *cascade = &fresh->gi->volume.state.cascades.at[c];
        memcpy(cascade->origin, walked->gi->volume.state.cascades.at[c].origin, sizeof cascade->origin);
        cascade->place = CASCADE_OUTDATED;
    }
}

uint32_t scroll_settle(struct gi_test *t)
{
    for (uint32_t frames = 1; frames <= 400; frames++) {
        gi_test_update(t, 1);
        if (sdfgi_cascades_rest(&t->gi->volume.state.cascades) &&
            !sdfgi_relight_is_due(&t->gi->volume.state.relight))
            return frames;
    }
    require_fail(__FILE__, __LINE__, "cascades are still at work after 400 frames");
    return 0;
}

/* Elements that differ, and the first; says so. */
struct difference {
    uint64_t count, first;
};

static void difference_add(struct difference *d, uint64_t element)
{
    d->first = d->count++ ? d->first : element;
}

static uint64_t difference_tell(const struct difference *d, const char *what, const char *of)
{
    if (d->count)
        printf("%s: %s: %llu differ, first %llu\n", what, of, (unsigned long long)d->count,
               (unsigned long long)d->first);
    return d->count;
}

static uint64_t bytes_differ(struct gi_test *a, struct gi_test *b, enum resource resource, const char *what)
{
    uint64_t size;
    uint8_t *x = gi_test_read(a, resource, &size), *y = gi_test_read(b, resource, NULL);
    struct difference d = { 0 };
    for (uint64_t i = 0; i < size; i++)
        if (x[i] != y[i])
            difference_add(&d, i);
    free(x);
    free(y);
    return difference_tell(&d, what, sdfgi_resource_row(resource)->name);
}

/* Of probes: where they stand and how they are linked, not whether they are new. */
static uint64_t probes_differ(struct gi_test *a, struct gi_test *b, const char *what)
{
    uint64_t size;
    uint32_t *x = gi_test_read(a, RESOURCE_PROBES, &size), *y = gi_test_read(b, RESOURCE_PROBES, NULL);
    struct difference d = { 0 };
    for (uint64_t i = 0; i < size / 4; i++)
        if ((x[i] ^ y[i]) & ~SDFGI_PROBE_NEW)
            difference_add(&d, i);
    free(x);
    free(y);
    return difference_tell(&d, what, "probes");
}

/* `lit`: their direct light too. The bits of lights depend on the order in which these were made. */
static uint64_t lists_differ(struct gi_test *a, struct gi_test *b, bool lit, const char *what)
{
    uint32_t *x = gi_test_read(a, RESOURCE_LIGHT_CELLS, NULL),
             *y = gi_test_read(b, RESOURCE_LIGHT_CELLS, NULL);
    uint32_t *p = gi_test_read(a, RESOURCE_DIRECT, NULL), *q = gi_test_read(b, RESOURCE_DIRECT, NULL);
    uint32_t *m = gi_test_read(a, RESOURCE_COUNTERS, NULL), *n = gi_test_read(b, RESOURCE_COUNTERS, NULL);
    const uint64_t room = a->gi->volume.resources->extent.light_cells;
    struct difference counts = { 0 }, cells = { 0 };
    REQUIRE_CMP(room, ==, b->gi->volume.resources->extent.light_cells);
    for (uint32_t c = 0; c < a->gi->settings.cascades; c++) {
        const uint32_t count = m[SDFGI_COUNTER_LIGHT_CELLS + c];
        if (count != n[SDFGI_COUNTER_LIGHT_CELLS + c])
            difference_add(&counts, c);
        for (uint64_t i = 0; i < count; i++) {
            const struct gi_test_direct of_a = gi_test_direct_at(p, room, c, i),
                                        of_b = gi_test_direct_at(q, room, c, i);
            if (x[c * room + i] != y[c * room + i] ||
                (lit && (of_a.color != of_b.color || of_a.axes != of_b.axes)))
                difference_add(&cells, c * room + i);
        }
    }
    free(x);
    free(y);
    free(p);
    free(q);
    free(m);
    free(n);
    return difference_tell(&counts, what, "numbers of light cells") +
           difference_tell(&cells, what, "light cells");
}

/* Those of probes that are dead are not read. */
static uint64_t depths_differ(struct gi_test *a, struct gi_test *b, const char *what)
{
    enum { WORDS = SDFGI_OCCLUSION_STRIDE * SDFGI_OCCLUSION_STRIDE };
    const uint64_t probes = a->gi->volume.resources->extent.probes * a->gi->settings.cascades;
    uint32_t *x = gi_test_read(a, RESOURCE_OCCLUSION, NULL), *y = gi_test_read(b, RESOURCE_OCCLUSION, NULL);
    uint32_t *states = gi_test_read(a, RESOURCE_PROBES, NULL);
    struct difference d = { 0 };
    for (uint64_t i = 0; i < probes * WORDS; i++)
        if (!(states[i / WORDS] & SDFGI_PROBE_DEAD) && x[i] != y[i])
            difference_add(&d, i);
    free(x);
    free(y);
    free(states);
    return difference_tell(&d, what, "texels of depths");
}

static uint64_t differences(struct gi_test *walked, struct gi_test *fresh, bool lit, const char *what)
{
    for (uint32_t c = 0; c < walked->gi->settings.cascades; c++)
        REQUIRE_BYTES(walked->gi->volume.state.cascades.at[c].origin,
                      fresh->gi->volume.state.cascades.at[c].origin,
                      sizeof walked->gi->volume.state.cascades.at[c].origin);
    static const enum resource whole[] = { RESOURCE_BITS,     RESOURCE_DISTANCE, RESOURCE_ALBEDO,
                                           RESOURCE_EMISSION, RESOURCE_NORMALS,  RESOURCE_LIGHT_BLOCKS };
    const bool depths = walked->gi->settings.visibility == SDFGI_VISIBILITY_PROBE_DEPTH;
    uint64_t count = probes_differ(walked, fresh, what) + lists_differ(walked, fresh, lit, what);
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        count += bytes_differ(walked, fresh, whole[i], what);
    if (!walked->gi->settings.use_occlusion)
        return count; /* nobody writes masks or depths */
    return count +
           (depths ? depths_differ(walked, fresh, what) : bytes_differ(walked, fresh, RESOURCE_MASKS, what));
}

uint64_t scroll_differences(struct gi_test *walked, struct gi_test *fresh, const char *what)
{
    return differences(walked, fresh, true, what);
}

void scroll_require_equal(struct gi_test *walked, struct gi_test *fresh, const char *what)
{
    REQUIRE_CMP(scroll_differences(walked, fresh, what), ==, 0ul);
}

void scroll_require_equal_but_light(struct gi_test *walked, struct gi_test *fresh, const char *what)
{
    REQUIRE_CMP(differences(walked, fresh, false, what), ==, 0ul);
}

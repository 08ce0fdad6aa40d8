/* SPDX-License-Identifier: MIT
 * States of `sdfgi reference`: of a picture of 4 x 4 pixels of a sky, on one thread. */
#include "fuzz.h"

#include "../../modules/gltf/gltf_scene.h"
#include "internal.h"
#include "require.h"

#include <stdio.h>

enum { SIDE = 4, HEADER_BYTES = 56, CHECKSUM_AT = 16, COUNTS_AT = 24, SIZES_AT = 40 };

/* Made once: every state is loaded into the same tracer, as if it took up one run after the other. */
static struct raycast *tracer(void)
{
    static struct raycast *made;
    static struct gltf_scene scene;
    if (made)
        return made;
    char error[256];
    const struct raycast_view view = {
        .camera = { .position = { 0, 0, 1 }, .up = { 0, 1, 0 }, .yfov_deg = 60 },
        .sky = { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } },
        .punctual_scale = 1,
        .emissive_scale = 1,
        .default_albedo = { 0.5f, 0.5f, 0.5f },
    };
    const struct raycast_settings settings = { .width = SIDE, .height = SIDE, .threads = 1 };
    made = raycast_create(&scene, &view, &settings, error, sizeof error);
    if (!made)
        require_fail(__FILE__, __LINE__, "%s", error);
    return made;
}

static bool read_state(const char *path, char *error, size_t error_size)
{
    struct raycast *const rc = tracer();
    static float picture[3 * SIDE * SIDE];
    const struct film before = rc->film;
    const uint64_t rays = rc->rays, not_finite = rc->not_finite;
    if (!raycast_state_load(rc, path, error, error_size)) {
        REQUIRE_TRUE(memcmp(&before, &rc->film, sizeof before) == 0);
        REQUIRE_TRUE(rays == rc->rays && not_finite == rc->not_finite);
        return false;
    }
    /* There are samples: there is a picture, and more can be added. */
    REQUIRE_TRUE(raycast_image(rc, RAYCAST_AOV_RADIANCE, picture));
    raycast_render(rc, &(struct raycast_budget){ .samples = 2 }, NULL, NULL, NULL);
    return true;
}

/* As raycast_state_write does it: the header without the checksum, samples of tiles, the sums of each plane.
 */
static uint64_t checksum(const uint8_t *data, size_t size)
{
    const struct film *const f = &tracer()->film;
    uint8_t header[HEADER_BYTES];
    memcpy(header, data, sizeof header);
    memset(header + CHECKSUM_AT, 0, sizeof(uint64_t));
    uint64_t h = raycast_hash_bytes(0, header, sizeof header);
    size_t at = HEADER_BYTES;
    for (int plane = -1; plane < RAYCAST_AOV_COUNT; plane++) {
        const size_t wanted = plane < 0        ? film_tile_count(f) * sizeof *f->tile_samples
                              : f->sums[plane] ? SIDE * SIDE * film_plane_channels(plane) * sizeof(double)
                                               : 0;
        const size_t length = wanted < size - at ? wanted : size - at;
        h = raycast_hash_bytes(h, data + at, length);
        at += length;
    }
    return h;
}

static void mend_state(uint8_t *data, size_t size)
{
    const struct raycast *const rc = tracer();
    if (size < HEADER_BYTES)
        return;
    const uint32_t sizes[4] = { SIDE, SIDE, rc->settings.aovs, FILM_TILE };
    memcpy(data, "raycst02", 8);
    memcpy(data + 8, &rc->identity, sizeof rc->identity);
    memcpy(data + SIZES_AT, sizes, sizeof sizes);
    const uint64_t sum = checksum(data, size);
    memcpy(data + CHECKSUM_AT, &sum, sizeof sum);
}

const struct fuzz_target fuzz_state = { ".state", read_state, NULL, mend_state };

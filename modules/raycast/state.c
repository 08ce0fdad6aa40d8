/* SPDX-License-Identifier: MIT
 *
 * The sums of a picture in a file, so that a run can be taken up again. In the machine's own byte order: a
 * state is for going on where one stopped, not for keeping.
 */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

/* All of it but the checksum is hashed, so there is no padding. */
struct state_header {
    char magic[8];
    uint64_t identity;
    uint64_t checksum; /* of the header, the samples of the tiles, and the sums */
    uint64_t rays, not_finite;
    uint32_t width, height, aovs, tile;
};

_Static_assert(sizeof(struct state_header) == 56, "no padding");

static const char magic[8] = { 'r', 'a', 'y', 'c', 's', 't', '0', '2' };

static size_t plane_size(const struct film *f, uint32_t aov)
{
    return f->sums[aov] != NULL ? film_pixel_count(f) * film_plane_channels(aov) : 0;
}

static uint64_t checksum(struct state_header header, const struct film *f)
{
    header.checksum = 0;
    uint64_t h = raycast_hash_bytes(0, &header, sizeof(header));
    h = raycast_hash_bytes(h, f->tile_samples, film_tile_count(f) * sizeof(*f->tile_samples));
    for (uint32_t aov = 0; aov < RAYCAST_AOV_COUNT; aov++)
        h = raycast_hash_bytes(h, f->sums[aov], plane_size(f, aov) * sizeof(double));
    return h;
}

bool raycast_state_write(const struct raycast *rc, FILE *file)
{
    const struct film *f = &rc->film;
    struct state_header header = {
        .identity = rc->identity,
        .rays = rc->rays,
        .not_finite = rc->not_finite,
        .width = f->width,
        .height = f->height,
        .aovs = rc->settings.aovs,
        .tile = FILM_TILE,
    };
    memcpy(header.magic, magic, sizeof(magic));
    header.checksum = checksum(header, f);
    const size_t tiles = film_tile_count(f);
    bool ok = fwrite(&header, sizeof(header), 1, file) == 1 &&
              fwrite(f->tile_samples, sizeof(*f->tile_samples), tiles, file) == tiles;
    for (uint32_t aov = 0; ok && aov < RAYCAST_AOV_COUNT; aov++) {
        const size_t size = plane_size(f, aov);
        ok = size == 0 || fwrite(f->sums[aov], sizeof(double), size, file) == size;
    }
    return ok;
}

static bool header_check(const struct raycast *rc, const struct state_header *h, const char *path,
                         char *error, size_t error_size)
{
    if (memcmp(h->magic, magic, sizeof(magic)) != 0)
        return raycast_fail(error, error_size, "%s: is not a state of a reference", path);
    if (h->width != rc->film.width || h->height != rc->film.height)
        return raycast_fail(error, error_size, "%s: is of a picture of %ux%u, not %ux%u", path, h->width,
                            h->height, rc->film.width, rc->film.height);
    if (h->identity != rc->identity || h->aovs != rc->settings.aovs || h->tile != FILM_TILE)
        return raycast_fail(error, error_size, "%s: belongs to another scene, view, seed or choice of AOVs",
                            path);
    return true;
}

static bool read_film(struct film *f, const struct state_header *h, FILE *file)
{
    const size_t tiles = film_tile_count(f);
    if (fread(f->tile_samples, sizeof(*f->tile_samples), tiles, file) != tiles)
        return false;
    for (uint32_t aov = 0; aov < RAYCAST_AOV_COUNT; aov++) {
        const size_t size = plane_size(f, aov);
        if (size != 0 && fread(f->sums[aov], sizeof(double), size, file) != size)
            return false;
    }
    return fgetc(file) == EOF && checksum(*h, f) == h->checksum;
}

static bool read_state(struct raycast *rc, FILE *file, const char *path, char *error, size_t error_size)
{
    struct state_header header;
    if (fread(&header, sizeof(header), 1, file) != 1)
        return raycast_fail(error, error_size, "%s: is too short for a state of a reference", path);
    if (!header_check(rc, &header, path, error, error_size))
        return false;
    struct film film;
    if (!raycast_film_init(&film, rc->film.width, rc->film.height, rc->settings.aovs))
        return raycast_fail(error, error_size, "%s: out of memory", path);
    const bool whole = read_film(&film, &header, file);
    if (!whole || !(film_mean_samples(&film) > 0.0)) {
        raycast_film_finish(&film);
        return raycast_fail(error, error_size, "%s: %s", path,
                            whole ? "holds no samples" : "is damaged or cut short");
    }
    raycast_film_finish(&rc->film);
    rc->film = film;
    rc->rays = header.rays;
    rc->not_finite = header.not_finite;
    return true;
}

bool raycast_state_load(struct raycast *rc, const char *path, char *error, size_t error_size)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return raycast_fail(error, error_size, "%s: cannot be read: %s", path, strerror(errno));
    const bool ok = read_state(rc, file, path, error, error_size);
    fclose(file);
    return ok;
}

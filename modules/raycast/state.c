/* SPDX-License-Identifier: MIT
 *
 * The sums of a picture in a file, so that a run can be taken up again. In the machine's own byte order: a
 * state is for going on where one stopped, not for keeping.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"

struct state_header {
    char magic[8];
    uint64_t identity;
    uint64_t checksum; /* of the sums */
    uint64_t rays, not_finite;
    uint32_t samples, width, height, aovs;
};

static const char magic[8] = { 'r', 'a', 'y', 'c', 's', 't', '0', '1' };

static size_t plane_size(const struct film *f, uint32_t aov)
{
    return f->sums[aov] != NULL ? film_pixel_count(f) * film_plane_channels(aov) : 0;
}

static uint64_t checksum(const struct film *f)
{
    uint64_t h = 0;
    for (uint32_t aov = 0; aov < RAYCAST_AOV_COUNT; aov++)
        h = raycast_hash_bytes(h, f->sums[aov], plane_size(f, aov) * sizeof(double));
    return h;
}

static bool write_all(const struct raycast *rc, FILE *file)
{
    struct state_header header = {
        .identity = rc->identity,
        .checksum = checksum(&rc->film),
        .rays = rc->rays,
        .not_finite = rc->not_finite,
        .samples = rc->film.samples,
        .width = rc->film.width,
        .height = rc->film.height,
        .aovs = rc->settings.aovs,
    };
    memcpy(header.magic, magic, sizeof(magic));
    bool ok = fwrite(&header, sizeof(header), 1, file) == 1;
    for (uint32_t aov = 0; ok && aov < RAYCAST_AOV_COUNT; aov++) {
        const size_t size = plane_size(&rc->film, aov);
        ok = size == 0 || fwrite(rc->film.sums[aov], sizeof(double), size, file) == size;
    }
    return ok;
}

bool raycast_state_save(const struct raycast *rc, const char *path, char *error, size_t error_size)
{
    const size_t size = strlen(path) + sizeof(".part");
    char *part = malloc(size);
    if (part == NULL)
        return raycast_fail(error, error_size, "%s: out of memory", path);
    snprintf(part, size, "%s.part", path);
    FILE *file = fopen(part, "wb");
    bool ok = file != NULL && write_all(rc, file);
    ok = (file == NULL || fclose(file) == 0) && ok;
    ok = ok && rename(part, path) == 0;
    if (!ok) {
        raycast_fail(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
        if (file != NULL)
            remove(part);
    }
    free(part);
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
    if (h->identity != rc->identity || h->aovs != rc->settings.aovs)
        return raycast_fail(error, error_size, "%s: belongs to another scene, view, seed or choice of AOVs",
                            path);
    return true;
}

static bool read_sums(struct film *f, const struct state_header *h, FILE *file)
{
    for (uint32_t aov = 0; aov < RAYCAST_AOV_COUNT; aov++) {
        const size_t size = plane_size(f, aov);
        if (size != 0 && fread(f->sums[aov], sizeof(double), size, file) != size)
            return false;
    }
    return fgetc(file) == EOF && checksum(f) == h->checksum;
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
    if (!read_sums(&film, &header, file)) {
        raycast_film_finish(&film);
        return raycast_fail(error, error_size, "%s: is damaged or cut short", path);
    }
    raycast_film_finish(&rc->film);
    rc->film = film;
    rc->film.samples = header.samples;
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

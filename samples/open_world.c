/* SPDX-License-Identifier: MIT
 *
 * Teaches: how to write a whole scene as one .glb file, with shared meshes, alpha masks, glow and lights.
 *
 * Writes a seeded valley of about a kilometre: a village of houses one can walk into, a tunnel, woods,
 * fences, a stream, lanterns; and view files to look at it from. The same seed gives the same bytes on the
 * same machine. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file_write.h"
#include "world.h"

struct options {
    uint32_t seed;
    const char *out, *views;
};

static int usage(void)
{
    printf("usage: open_world --out FILE.glb [--seed N] [--views FOLDER]\n"
           "Writes a seeded sample world, and with --views the cameras to look at it from.\n");
    return EXIT_SUCCESS;
}

static bool seed_parse(const char *text, uint32_t *seed)
{
    char *end = NULL;
    errno = 0;
    const unsigned long long value = strtoull(text, &end, 10);
    *seed = (uint32_t)value;
    return errno == 0 && text[0] != '-' && end != text && *end == '\0' && value <= UINT32_MAX;
}

static bool options_parse(int argc, char **argv, struct options *options)
{
    *options = (struct options){ .seed = 1 };
    for (int i = 1; i < argc; i += 2) {
        const char *value = i + 1 < argc ? argv[i + 1] : NULL;
        if (!value) {
            fprintf(stderr, "open_world: %s needs a value\n", argv[i]);
            return false;
        }
        if (strcmp(argv[i], "--out") == 0) {
            options->out = value;
        } else if (strcmp(argv[i], "--views") == 0) {
            options->views = value;
        } else if (strcmp(argv[i], "--seed") != 0) {
            fprintf(stderr, "open_world: unknown option %s\n", argv[i]);
            return false;
        } else if (!seed_parse(value, &options->seed)) {
            fprintf(stderr, "open_world: --seed must be a number from 0 to 4294967295, not %s\n", value);
            return false;
        }
    }
    if (!options->out)
        fprintf(stderr, "open_world: --out is missing\n");
    return options->out != NULL;
}

static void world_build(struct world *world, struct house houses[HOUSE_COUNT])
{
    world_materials_make(world);
    world_houses_layout(world->seed, houses);
    world_terrain_add(world);
    world_tunnel_add(world);
    for (uint32_t i = 0; i < HOUSE_COUNT; i++)
        world_house_add(world, &houses[i], i);
    world_props_add(world);
    world_plants_add(world, houses);
}

static bool world_save(const struct world *world, const struct house houses[HOUSE_COUNT],
                       const struct options *options, char *error, size_t error_size)
{
    if (!glb_writer_save(world->writer, options->out, error, error_size))
        return false;
    return !options->views || (file_make_folder(options->views, error, error_size) &&
                               world_views_save(world, houses, options->views, error, error_size));
}

int main(int argc, char **argv)
{
    struct options options;
    struct house houses[HOUSE_COUNT];
    char error[512];
    if (argc == 2 && strcmp(argv[1], "--help") == 0)
        return usage();
    if (!options_parse(argc, argv, &options))
        return EXIT_FAILURE;
    struct world world = { .writer = glb_writer_create("libsdfgi open_world"), .seed = options.seed };
    if (!world.writer) {
        fprintf(stderr, "open_world: out of memory\n");
        return EXIT_FAILURE;
    }
    world_build(&world, houses);
    const bool ok = world_save(&world, houses, &options, error, sizeof(error));
    if (ok)
        printf("%s: seed %u, %u triangles drawn\n", options.out, options.seed, world.triangle_count);
    else
        fprintf(stderr, "open_world: %s\n", error);
    glb_writer_destroy(world.writer);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

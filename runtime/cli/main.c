/* SPDX-License-Identifier: MIT
 * The `sdfgi` program: a table of sub-commands. */
#include "cli.h"
#include "commands.h"
#include "file/stop.h"

#include <stdio.h>
#include <string.h>

struct command {
    const char *name;
    int (*run)(int argc, char **argv);
    const char *summary;
};

static const struct command commands[] = {
    { "render", cmd_render, "a picture of a glTF scene, offscreen" },
    { "walk", cmd_walk, "a camera along a path, GI off and on, and what each frame cost" },
#ifdef SDFGI_WITH_WINDOW
    { "view", cmd_view, "a window; G toggles global illumination" },
#endif
#ifdef SDFGI_WITH_RAYCAST
    { "reference", cmd_reference, "path-traced ground truth" },
#endif
    { "compare", cmd_compare, "how far two pictures differ" },
    { "info", cmd_info, "devices, requirements, memory estimate" },
    { "properties", cmd_properties, "every setting" },
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_commands(FILE *out)
{
    fputs("usage: sdfgi COMMAND [arguments], sdfgi COMMAND --help\n\n", out);
    for (int i = 0; i < COMMAND_COUNT; i++)
        fprintf(out, "  %-11s %s\n", commands[i].name, commands[i].summary);
    fputs("\nevery command takes --quiet, --device N and --report FILE.json; commands that show a scene read "
          "glTF 2.0\n(.glb, .gltf) with Draco, meshoptimizer and WebP where they are built in, and take "
          "--time, "
          "--camera,\n--sky, --sun and --environment\n",
          out);
    fputs("\nexit codes: 0 done, 1 failed, 2 wrong arguments, 130 stopped by SIGINT, 143 by SIGTERM\n", out);
}

static int finish(int code)
{
    /* Text that never reached a full disk or a closed pipe must not count as success. */
    if (fflush(stdout) != 0 || ferror(stdout))
        return cli_error("standard output cannot be written");
    return code;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        print_commands(stderr);
        return CLI_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
        print_commands(stdout);
        return finish(CLI_EXIT_OK);
    }
    stop_watch();
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i].name, argv[1]) == 0)
            return finish(commands[i].run(argc - 1, argv + 1));
    cli_error("unknown command \"%s\", see sdfgi --help", argv[1]);
    return CLI_EXIT_USAGE;
}

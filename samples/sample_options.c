/* SPDX-License-Identifier: MIT */
#include "sample_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: %s [--out FILE.ppm|FILE.pfm] [--gi on|off] [--switch N] [--size WxH] [--frames N]\n"
    "       [--set NAME=VALUE]... [--gather] [--down] [--window]\n"
    "Draws a room until its light has settled, for 1000 frames or N at most. A window stays open for N\n"
    "frames, or until it is closed. --switch turns GI on or off in frame N. --gather has a deferred host\n"
    "gather diffuse light alone, without reflections. --down has a forward host turn its world upside "
    "down.\n";

static void end(const char *program, bool is_help)
{
    fprintf(is_help ? stdout : stderr, usage, program);
    exit(is_help ? EXIT_SUCCESS : 2);
}

static bool read_setting(struct sample_options *o, const char *text)
{
    const char *equals = strchr(text, '=');
    if (!equals || o->setting_count == SAMPLE_MAX_SETTINGS)
        return false;
    const uint32_t at = o->setting_count++;
    const int name = snprintf(o->names[at], sizeof o->names[at], "%.*s", (int)(equals - text), text),
              value = snprintf(o->values[at], sizeof o->values[at], "%s", equals + 1);
    return name < (int)sizeof o->names[at] && value < (int)sizeof o->values[at];
}

static bool read_number(const char *text, char end_with, uint32_t most, uint32_t *out)
{
    char *end_of;
    const unsigned long value = strtoul(text, &end_of, 10);
    *out = (uint32_t)value;
    return end_of != text && *end_of == end_with && value > 0 && value <= most;
}

static bool read_size(const char *text, struct sample_options *o)
{
    const char *x = strchr(text, 'x');
    return x && read_number(text, 'x', 16384, &o->width) && read_number(x + 1, '\0', 16384, &o->height);
}

static bool read_option(struct sample_options *o, const char *name, const char *value)
{
    if (strcmp(name, "--out") == 0)
        return (o->out = value) != NULL;
    if (strcmp(name, "--gi") == 0)
        return (o->gi = strcmp(value, "on") == 0) || strcmp(value, "off") == 0;
    if (strcmp(name, "--size") == 0)
        return read_size(value, o);
    if (strcmp(name, "--frames") == 0)
        return read_number(value, '\0', 1000000, &o->frames);
    if (strcmp(name, "--switch") == 0)
        return read_number(value, '\0', 1000000, &o->switch_frame);
    return strcmp(name, "--set") == 0 && read_setting(o, value);
}

void sample_options_read(struct sample_options *o, int argc, char **argv)
{
    *o = (struct sample_options){ .gi = true, .width = 640, .height = 360 };
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0)
            end(argv[0], true);
        if (strcmp(argv[i], "--window") == 0)
            o->window = true;
        else if (strcmp(argv[i], "--gather") == 0)
            o->gather = true;
        else if (strcmp(argv[i], "--down") == 0)
            o->down = true;
        else if (i + 1 == argc || !read_option(o, argv[i], argv[i + 1]))
            end(argv[0], false);
        else
            i++;
    }
    if (o->frames == 0)
        o->frames = o->window ? UINT32_MAX : 1000;
}

bool sample_options_gi(const struct sample_options *o, uint64_t frame)
{
    return o->gi != (o->switch_frame > 0 && frame >= o->switch_frame);
}

bool sample_options_go_on(const struct sample_options *o, uint64_t frame, bool settled)
{
    return (o->window || !settled || frame <= o->switch_frame) && frame < o->frames;
}

/* SPDX-License-Identifier: MIT
 * The command line of the sample hosts. */
#ifndef SAMPLE_OPTIONS_H
#define SAMPLE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SAMPLE_MAX_SETTINGS = 16 };

struct sample_options {
    const char *out;        /* picture's file; NULL: none */
    bool gi;                /* --gi on or off */
    bool gather;            /* --gather: diffuse light alone, without reflections */
    bool down;              /* --down: the world of a forward host has +Y down, baked into its vertices */
    bool window;            /* --window */
    uint32_t width, height; /* --size WxH */
    uint32_t frames;        /* --frames N: as many at most */
    uint32_t switch_frame;  /* --switch N: GI is switched over in this frame, counted from 0; 0: never */
    uint32_t setting_count; /* --set NAME=VALUE, as often as wanted */
    char names[SAMPLE_MAX_SETTINGS][64], values[SAMPLE_MAX_SETTINGS][64]; /* of those */
};

/* A wrong command line ends the program with 2, --help with 0. */
void sample_options_read(struct sample_options *options, int argc, char **argv);
/* Whether GI is on in a frame. */
bool sample_options_gi(const struct sample_options *options, uint64_t frame);
/* Whether there is to be another frame: a picture is drawn until light has settled. */
bool sample_options_go_on(const struct sample_options *options, uint64_t frame, bool settled);

#ifdef __cplusplus
}
#endif
#endif

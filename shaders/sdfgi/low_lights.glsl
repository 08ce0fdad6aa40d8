/* SPDX-License-Identifier: MIT
 * From where the surfaces of light cells get their light: for each a word, as lib/low_light.glsl packs it. It
 * is kept where a view has reflections. */
#ifndef SDFGI_LOW_LIGHTS_GLSL
#define SDFGI_LOW_LIGHTS_GLSL

#include "seen.glsl"
#include "../lib/low_light.glsl"

bool keeps_low_light()
{
    return sdfgi_frame.keeps_low_light != 0u;
}

/* Where in the buffer SEEN the word of a surface is, by its number: sdfgi_surface_index. */
uint low_light_word(uint surface)
{
    return sdfgi_seen_low_light(sdfgi_frame.light_cell_room, sdfgi_frame.cascade_count) + surface;
}

#endif

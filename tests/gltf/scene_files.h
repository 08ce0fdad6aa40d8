/* SPDX-License-Identifier: MIT
 *
 * glTF files made by the tests: drafts that collect accessors and end
 * as a .glb, PNG images, and the check that every loaded scene must pass.
 */
#ifndef TESTS_GLTF_SCENE_FILES_H
#define TESTS_GLTF_SCENE_FILES_H

#include "files.h"
#include "gltf_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

enum { DRAFT_TEXT_SIZE = 8192, DRAFT_BINARY_SIZE = 16384 };

/* glTF's codes for component types. */
enum component {
    COMPONENT_BYTE = 5120,
    COMPONENT_UBYTE = 5121,
    COMPONENT_SHORT = 5122,
    COMPONENT_USHORT = 5123,
    COMPONENT_UINT = 5125,
    COMPONENT_FLOAT = 5126,
};

/* A file in the making: buffer views and accessors are appended as their data is. */
struct draft {
    uint8_t binary[DRAFT_BINARY_SIZE];
    size_t binary_size;
    char views[DRAFT_TEXT_SIZE], accessors[DRAFT_TEXT_SIZE];
    int view_count, accessor_count;
};

struct elements {
    const void *data;
    size_t size;
    enum component component;
    const char *type; /* "SCALAR", "VEC3" */
    int count;
    const char *more; /* further members of the accessor, each with a comma before it; or NULL */
};

size_t glb_assemble(uint8_t *out, size_t capacity, const char *json, const void *binary, size_t binary_size);

/* Each appends, and returns the index of what was appended. */
int draft_view(struct draft *d, const void *data, size_t size);
int draft_accessor(struct draft *d, const struct elements *e);
int draft_floats(struct draft *d, const char *type, int count, const float *values);

/* The document: the draft's views and accessors, and `rest`, whose members each start with a comma. */
void draft_json(const struct draft *d, const char *rest, char *out, size_t size);
void draft_write(const struct draft *d, const char *rest, const char *name);

/* Loads and checks; the test fails with the loader's message. The caller destroys the scene. */
struct gltf_scene *draft_load(const struct draft *d, const char *rest);
struct gltf_scene *file_load(const char *name);

/* Fails the test where the scene breaks a promise of gltf_scene.h. */
void scene_check(const struct gltf_scene *scene);

/* An uncompressed PNG of 8- or 16-bit RGBA, `samples` in big-endian rows; returns its size. */
struct png {
    uint32_t width, height;
    uint8_t depth;
    const uint8_t *samples;
};
size_t png_encode(const struct png *image, uint8_t *out, size_t capacity);
/* Changes what the header says, and nothing else. */
void png_resize(uint8_t *png, uint32_t width, uint32_t height);
/* A PNG of one black and clear texel whose image data, as many as fit `capacity`, go on for 158 times that.
 */
size_t png_bomb_encode(uint8_t *out, size_t capacity);
void base64_encode(const uint8_t *data, size_t size, char *out, size_t capacity);

/* Writes packed.glb: `data` is the first buffer view, `rest` as for draft_json. */
void packed_write(const void *data, size_t size, const char *rest);
/* Fails unless packed.glb is refused with a message of one line that holds `wrong`. */
void refused_with(const char *wrong);

#endif

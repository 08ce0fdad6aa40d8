/* SPDX-License-Identifier: MIT
 * Changes to glTF: to its JSON, and in a GLB the lengths of chunks after any change. */
#include "fuzz.h"

#include <string.h>

static void little_endian_put(uint8_t *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (8 * i));
}

/* A GLB: "glTF", version, length; then length, "JSON", data; then, if any, length, "BIN", data. */
void fuzz_glb_mend(uint8_t *data, size_t size)
{
    static const char head[4] = { 'g', 'l', 'T', 'F' }, binary[4] = { 'B', 'I', 'N', '\0' };
    if (size < 20 || memcmp(data, head, sizeof head) != 0)
        return;
    size_t json_end = size;
    for (size_t at = 24; at + sizeof binary <= size && json_end == size; at++)
        if (memcmp(data + at, binary, sizeof binary) == 0)
            json_end = at - 4;
    little_endian_put(data + 8, (uint32_t)size);
    little_endian_put(data + 12, (uint32_t)(json_end - 20));
    if (json_end < size)
        little_endian_put(data + json_end, (uint32_t)(size - json_end - 8));
}

/* A chunk that has become longer, under its old length, would always be refused. */
size_t fuzz_glb_mutate(uint8_t *data, size_t size, size_t capacity, struct test_random *random)
{
    const size_t changed = fuzz_json_mutate(data, size, capacity, random);
    fuzz_glb_mend(data, changed);
    return changed;
}

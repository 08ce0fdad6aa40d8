/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include "files.h"
#include "require.h"

#include <stdio.h>

enum { ERROR_BYTES = 512 };

static void check_message(const char error[static ERROR_BYTES])
{
    const size_t length = strnlen(error, ERROR_BYTES);
    REQUIRE_CMP(length, <, (size_t)ERROR_BYTES);
    for (size_t i = 0; i < length; i++)
        REQUIRE_CMP((unsigned char)error[i], >=, 0x20);
    REQUIRE_TRUE(strstr(error, FUZZ_STEM ".") != NULL);
}

bool fuzz_run(const struct fuzz_target *target, const uint8_t *data, size_t size)
{
    char name[32], path[256], error[ERROR_BYTES];
    snprintf(name, sizeof name, FUZZ_STEM "%s", target->ending);
    snprintf(path, sizeof path, "%s", files_path(name));
    files_write(name, data, size);
    memset(error, 'x', sizeof error); /* without an end */
    const bool is_read = target->read(path, error, sizeof error);
    if (!is_read)
        check_message(error);
    return is_read;
}

uint32_t fuzz_big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

void fuzz_big_endian_put(uint8_t *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* SPDX-License-Identifier: MIT */
#include "require.h"

#include <stdio.h>

const char *require_text_signed(char text[static REQUIRE_TEXT_SIZE], long long value)
{
    snprintf(text, REQUIRE_TEXT_SIZE, "%lld", value);
    return text;
}

const char *require_text_unsigned(char text[static REQUIRE_TEXT_SIZE], unsigned long long value)
{
    snprintf(text, REQUIRE_TEXT_SIZE, "%llu", value);
    return text;
}

const char *require_text_real(char text[static REQUIRE_TEXT_SIZE], double value)
{
    snprintf(text, REQUIRE_TEXT_SIZE, "%.9g", value);
    return text;
}

void require_fail(const char *file, int line, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    print_error("%s\n", text);
    _fail(file, line);
}

void require_bytes(const char *file, int line, const char *name_a, const void *a, const char *name_b,
                   const void *b, size_t size)
{
    const unsigned char *bytes_a = a, *bytes_b = b;
    for (size_t i = 0; i < size; i++)
        if (bytes_a[i] != bytes_b[i])
            require_fail(file, line, "%s and %s differ at byte %zu of %zu: 0x%02x and 0x%02x", name_a, name_b,
                         i, size, bytes_a[i], bytes_b[i]);
}

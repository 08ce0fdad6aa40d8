/* SPDX-License-Identifier: MIT */
#include "text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void remove_control_characters(char *text)
{
    for (; *text; text++) {
        const unsigned char c = (unsigned char)*text;
        if (c < 0x20 || c == 0x7f)
            *text = '?';
    }
}

bool base_text_error_va(char *text, size_t size, const char *format, va_list args)
{
    if (!text || size == 0)
        return false;
    const int length = vsnprintf(text, size, format, args);
    if (length < 0)
        text[0] = '\0';
    else if ((size_t)length >= size && size > 4)
        memcpy(text + size - 4, "...", 4);
    remove_control_characters(text);
    return false;
}

bool base_text_error(char *text, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    base_text_error_va(text, size, format, args);
    va_end(args);
    return false;
}

bool base_text_to_double(const char *text, double *value)
{
    /* strtod also takes leading spaces, hexadecimal, "nan" and "inf": only plain decimal numbers are let
     * through. */
    if (text[0] == '\0' || text[strspn(text, "0123456789+-.eE")] != '\0')
        return false;
    char *end;
    const double parsed = strtod(text, &end);
    if (end == text || *end != '\0' || !isfinite(parsed))
        return false;
    *value = parsed;
    return true;
}

/* SPDX-License-Identifier: MIT
 * Bounded single-line text: messages for people end up in logs and terminals, so whatever a file name or a
 * value contains, one message stays one line and always fits its buffer. */
#ifndef BASE_TEXT_H
#define BASE_TEXT_H

#include <stdbool.h>
#include <stdarg.h>
#include <stddef.h>

/* Names for the linker, since this lies in the static library, too: see gpu/gpu_names.h. */
#define base_text_error     sdfgi_base_text_error
#define base_text_error_va  sdfgi_base_text_error_va
#define base_text_to_double sdfgi_base_text_to_double

#ifdef __cplusplus
extern "C" {
#endif

/* Formats into `text` of `size` bytes: always terminated, control characters become '?', and a line that does
 * not fit ends in "...". Returns false so that a failing function can end in `return base_text_error(...)`.
 * `text` may be NULL or `size` 0: nothing is written. */
__attribute__((format(printf, 3, 4))) bool base_text_error(char *text, size_t size, const char *format, ...);
bool base_text_error_va(char *text, size_t size, const char *format, va_list args);

/* Reads a finite number that makes up the whole of `text`: no spaces, no trailing characters, no hexadecimal,
 * no "nan" or "inf". Leaves `*value` alone on failure. */
bool base_text_to_double(const char *text, double *value);

#ifdef __cplusplus
}
#endif
#endif

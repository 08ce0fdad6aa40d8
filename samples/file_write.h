/* SPDX-License-Identifier: MIT
 * Writes a whole file or nothing: to a temporary name first, then renamed. */
#ifndef SAMPLES_FILE_WRITE_H
#define SAMPLES_FILE_WRITE_H

#include <stdbool.h>
#include <stddef.h>

struct file_part {
    const void *bytes;
    size_t size;
};

/* Writes the parts one after another. On failure returns false with one line in `error`; `path` is untouched.
 */
bool file_write_parts(const char *path, const struct file_part *parts, size_t count, char *error,
                      size_t error_size);

/* Makes `path` and its parents where they are missing; false with one line in `error` if that fails. */
bool file_make_folder(const char *path, char *error, size_t error_size);

#endif

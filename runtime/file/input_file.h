/* SPDX-License-Identifier: MIT
 * Files that users name. Only plain files are opened: a pipe or a device could wait for ever, or never end.
 */
#ifndef RUNTIME_INPUT_FILE_H
#define RUNTIME_INPUT_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Opens `path` for reading and tells its size. On failure returns NULL and writes one line, which does not
 * name the file, into `error`. */
FILE *input_file_open(const char *path, uint64_t *size, char *error, size_t error_size);

/* All of `stream`, for free(), with a byte of zero behind it. NULL with a line in `error` if it has other
 * than `size` bytes, or memory runs out. */
char *input_file_read(FILE *stream, uint64_t size, char *error, size_t error_size);

#endif

/* SPDX-License-Identifier: MIT
 * Files that appear whole or not at all: written beside their final place and renamed at the end. */
#ifndef RUNTIME_OUTPUT_FILE_H
#define RUNTIME_OUTPUT_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct output_file {
    FILE *stream; /* write here */
    const char *path;
    char *temporary_path;
};

/* Opens a temporary file beside `path`, which must outlive `file`. On failure returns false and writes one
 * line that names the path into `error`. */
bool output_file_begin(struct output_file *file, const char *path, char *error, size_t error_size);

/* Closes the file and renames it to its path. Fails, and removes it, if any write to the stream failed. */
bool output_file_commit(struct output_file *file, char *error, size_t error_size);

/* Closes and removes the file. */
void output_file_cancel(struct output_file *file);

/* Removes the file that is being written, if there is one. For a handler of signals that ends the process
 * afterwards. */
void output_file_abandon(void);

/* True if a file can be written at `path`; otherwise one line in `error`. Leaves nothing behind, and removes
 * what killed runs have left of this output. To be called before minutes of work, not after. */
bool output_file_check(const char *path, char *error, size_t error_size);

#endif

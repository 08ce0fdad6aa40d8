/* SPDX-License-Identifier: MIT
 * Files that a program keeps from one run to the next and can do without: whatever is wrong with one, it
 * counts as absent. */
#ifndef RUNTIME_CACHE_FILE_H
#define RUNTIME_CACHE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Where the user's caches are: $XDG_CACHE_HOME/sdfgi, else $HOME/.cache/sdfgi. False if neither is set to an
 * absolute path that fits. Makes no folder. */
bool cache_folder(char *path, size_t path_size);

/* FNV-1a over 64 bits: tells damaged data, not data that someone forged. */
uint64_t cache_checksum(const void *data, size_t size);

/* What cache_file_save wrote to `path`, for free(); NULL if there is no such file or any byte of it is not as
 * it was written. */
void *cache_file_load(const char *path, size_t *size);

/* Replaces the file at once; makes the folders that are missing. False if the file could not be written. */
bool cache_file_save(const char *path, const void *data, size_t size);

#endif

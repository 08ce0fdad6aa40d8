/* SPDX-License-Identifier: MIT */
#include "cache_file.h"

#include "output_file.h"
#include "temporary_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_BYTES = 4096, SIZE_MAX_MIB = 256 };

/* Before the data, in the byte order of the machine: a cache stays on it. */
struct header {
    char magic[8];
    uint64_t size, checksum; /* of the data */
};

static const char magic[8] = "sdfgi-1";

bool cache_folder(char *path, size_t path_size)
{
    const char *const cache = getenv("XDG_CACHE_HOME"), *const home = getenv("HOME");
    int length = -1;
    if (cache && cache[0] == '/')
        length = snprintf(path, path_size, "%s/sdfgi", cache);
    else if (home && home[0] == '/')
        length = snprintf(path, path_size, "%s/.cache/sdfgi", home);
    return length > 0 && (size_t)length < path_size;
}

uint64_t cache_checksum(const void *data, size_t size)
{
    const uint8_t *const bytes = data;
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ bytes[i]) * UINT64_C(0x100000001b3);
    return hash;
}

/* ---- Reading ---------------------------------------------------------------------------------------- */

static void *read_data(FILE *stream, size_t *size)
{
    struct header header;
    if (fread(&header, sizeof header, 1, stream) != 1 || memcmp(header.magic, magic, sizeof magic) != 0 ||
        header.size == 0 || header.size > (uint64_t)SIZE_MAX_MIB << 20)
        return NULL;
    void *const data = malloc((size_t)header.size);
    if (data && fread(data, (size_t)header.size, 1, stream) == 1 && fgetc(stream) == EOF &&
        cache_checksum(data, (size_t)header.size) == header.checksum) {
        *size = (size_t)header.size;
        return data;
    }
    free(data);
    return NULL;
}

void *cache_file_load(const char *path, size_t *size)
{
    FILE *const stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    void *const data = read_data(stream, size);
    fclose(stream);
    return data;
}

/* ---- Writing ---------------------------------------------------------------------------------------- */

/* The folders of `path`, whose last part is the file's name. Opening the file shows whether they are there.
 */
static void make_folders(const char *path)
{
    char folder[PATH_BYTES];
    for (const char *slash = strchr(path, '/'); slash; slash = strchr(slash + 1, '/')) {
        const size_t length = (size_t)(slash - path);
        if (length == 0 || length >= sizeof folder)
            continue;
        memcpy(folder, path, length);
        folder[length] = '\0';
        mkdir(folder, 0700);
    }
}

bool cache_file_save(const char *path, const void *data, size_t size)
{
    struct header header = { .size = size, .checksum = cache_checksum(data, size) };
    struct output_file file;
    char error[PATH_BYTES];
    memcpy(header.magic, magic, sizeof magic);
    make_folders(path);
    temporary_file_remove_leftovers(path);
    if (!output_file_begin(&file, path, error, sizeof error))
        return false;
    if (fwrite(&header, sizeof header, 1, file.stream) == 1 && fwrite(data, size, 1, file.stream) == 1)
        return output_file_commit(&file, error, sizeof error);
    output_file_cancel(&file);
    return false;
}

/* SPDX-License-Identifier: MIT */
#include "output_file.h"

#include <base/text.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SUFFIX_BYTES = 32 };

/* Renaming onto a device or a pipe would replace it by a file. */
static bool check_target(const char *path, char *error, size_t error_size)
{
    struct stat status;
    if (stat(path, &status) != 0 || S_ISREG(status.st_mode))
        return true;
    return base_text_error(error, error_size, "%s: is a %s, expected a file to write", path,
                           S_ISDIR(status.st_mode) ? "folder" : "device");
}

bool output_file_begin(struct output_file *file, const char *path, char *error, size_t error_size)
{
    if (!check_target(path, error, error_size))
        return false;
    const size_t size = strlen(path) + SUFFIX_BYTES;
    char *temporary_path = malloc(size);
    if (!temporary_path)
        return base_text_error(error, error_size, "%s: out of memory", path);
    snprintf(temporary_path, size, "%s.%ld.partial", path, (long)getpid());
    FILE *stream = fopen(temporary_path, "wb");
    if (!stream) {
        free(temporary_path);
        return base_text_error(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
    }
    *file = (struct output_file){ stream, path, temporary_path };
    return true;
}

void output_file_cancel(struct output_file *file)
{
    fclose(file->stream);
    unlink(file->temporary_path);
    free(file->temporary_path);
}

bool output_file_commit(struct output_file *file, char *error, size_t error_size)
{
    if (fflush(file->stream) != 0 || ferror(file->stream)) {
        base_text_error(error, error_size, "%s: cannot be written: %s", file->path, strerror(errno));
        output_file_cancel(file);
        return false;
    }
    const bool renamed = fclose(file->stream) == 0 && rename(file->temporary_path, file->path) == 0;
    if (!renamed) {
        base_text_error(error, error_size, "%s: cannot be written: %s", file->path, strerror(errno));
        unlink(file->temporary_path);
    }
    free(file->temporary_path);
    return renamed;
}

bool output_file_check(const char *path, char *error, size_t error_size)
{
    struct output_file file;
    if (!output_file_begin(&file, path, error, error_size))
        return false;
    output_file_cancel(&file);
    return true;
}

/* SPDX-License-Identifier: MIT */
#include "file_write.h"

#include "file/output_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool file_write_parts(const char *path, const struct file_part *parts, size_t count, char *error,
                      size_t error_size)
{
    struct output_file file;
    if (!output_file_check(path, error, error_size) || !output_file_begin(&file, path, error, error_size))
        return false;
    for (size_t i = 0; i < count; i++)
        if (parts[i].size)
            fwrite(parts[i].bytes, 1, parts[i].size, file.stream);
    return output_file_commit(&file, error, error_size);
}

static bool folder_make_one(const char *path)
{
    struct stat info;
    if (mkdir(path, 0777) == 0)
        return true;
    return errno == EEXIST && stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

bool file_make_folder(const char *path, char *error, size_t error_size)
{
    char *copy = strdup(path);
    bool ok = copy != NULL;
    for (char *at = copy; ok && *at; at++) {
        if (*at != '/' || at == copy)
            continue;
        *at = '\0';
        ok = folder_make_one(copy);
        *at = '/';
    }
    ok = ok && folder_make_one(copy);
    if (!ok)
        snprintf(error, error_size, "%s: cannot make the folder", path);
    free(copy);
    return ok;
}

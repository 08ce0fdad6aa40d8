/* SPDX-License-Identifier: MIT */
#include "file_write.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool parts_write(FILE *file, const struct file_part *parts, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (parts[i].size && fwrite(parts[i].bytes, 1, parts[i].size, file) != parts[i].size)
            return false;
    return true;
}

bool file_write_parts(const char *path, const struct file_part *parts, size_t count, char *error,
                      size_t error_size)
{
    const size_t temp_size = strlen(path) + 16;
    char *temp = malloc(temp_size);
    if (!temp) {
        snprintf(error, error_size, "%s: out of memory", path);
        return false;
    }
    snprintf(temp, temp_size, "%s.%d.tmp", path, (int)(getpid() % 1000000));
    FILE *file = fopen(temp, "wb");
    bool ok = file && parts_write(file, parts, count);
    int code = errno;
    /* fclose flushes: a full disk may show only here. */
    if (file && fclose(file) != 0 && ok) {
        ok = false;
        code = errno;
    }
    if (ok && rename(temp, path) != 0) {
        ok = false;
        code = errno;
    }
    if (!ok) {
        snprintf(error, error_size, "%s: cannot write: %s", path, strerror(code));
        if (file)
            remove(temp);
    }
    free(temp);
    return ok;
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

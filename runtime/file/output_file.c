/* SPDX-License-Identifier: MIT */
#include "output_file.h"

#include "temporary_file.h"

#include <base/text.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_BYTES = 4096 };

/* Handlers of signals can be given nothing: what they remove is known here. Only the first file that is open
 * at a time; programs write one after another. */
static char open_path[PATH_BYTES];
static atomic_bool open_path_valid;

static void remember(const char *path)
{
    if (atomic_load(&open_path_valid) || strlen(path) >= sizeof open_path)
        return;
    strcpy(open_path, path);
    atomic_store(&open_path_valid, true);
}

static void forget(const char *path)
{
    if (atomic_load(&open_path_valid) && strcmp(open_path, path) == 0)
        atomic_store(&open_path_valid, false);
}

void output_file_abandon(void)
{
    if (atomic_load(&open_path_valid))
        unlink(open_path);
}

/* ---- One file --------------------------------------------------------------------------------------- */

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
    char *temporary_path;
    FILE *const stream = temporary_file_open(path, &temporary_path);
    if (!stream)
        return base_text_error(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
    remember(temporary_path);
    *file = (struct output_file){ stream, path, temporary_path };
    return true;
}

static void release(struct output_file *file)
{
    forget(file->temporary_path);
    free(file->temporary_path);
}

void output_file_cancel(struct output_file *file)
{
    fclose(file->stream);
    unlink(file->temporary_path);
    release(file);
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
    release(file);
    return renamed;
}

bool output_file_check(const char *path, char *error, size_t error_size)
{
    struct output_file file;
    temporary_file_remove_leftovers(path);
    if (!output_file_begin(&file, path, error, error_size))
        return false;
    output_file_cancel(&file);
    return true;
}

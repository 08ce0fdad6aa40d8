/* SPDX-License-Identifier: MIT */
#define _DEFAULT_SOURCE /* getentropy */
#include "temporary_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SUFFIX_BYTES = 64, RANDOM_DIGITS = 16, ATTEMPTS = 100 };

static const char ending[] = ".partial";

/* ---- New files -------------------------------------------------------------------------------------- */

static FILE *open_stream(const char *name)
{
    /* Whoever knows the name in advance can put a link there, but not have it followed. */
    const int file = open(name, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    FILE *const stream = file < 0 ? NULL : fdopen(file, "wb");
    if (file >= 0 && !stream) {
        const int reason = errno;
        close(file);
        unlink(name);
        errno = reason;
    }
    return stream;
}

FILE *temporary_file_open(const char *path, char **name)
{
    const size_t size = strlen(path) + SUFFIX_BYTES;
    FILE *stream = NULL;
    *name = malloc(size);
    for (int i = 0; *name && !stream && i < ATTEMPTS && (i == 0 || errno == EEXIST); i++) {
        uint64_t random = (uint64_t)i;
        (void)!getentropy(&random, sizeof random);
        snprintf(*name, size, "%s.%ld.%016llx%s", path, (long)getpid(), (unsigned long long)random, ending);
        stream = open_stream(*name);
    }
    if (stream)
        return stream;
    const int reason = *name ? errno : ENOMEM;
    free(*name);
    *name = NULL;
    errno = reason;
    return NULL;
}

/* ---- Those of processes that were killed ------------------------------------------------------------ */

/* The process in ".PID.RANDOM.partial" at the end of `name`, or 0. */
static long owner(const char *name)
{
    const size_t length = strlen(name), tail = 1 + RANDOM_DIGITS + strlen(ending);
    if (length < tail || strcmp(name + length - strlen(ending), ending) != 0)
        return 0;
    const char *const random = name + length - tail;
    if (random[0] != '.' || strspn(random + 1, "0123456789abcdef") != RANDOM_DIGITS)
        return 0;
    const char *digits = random;
    while (digits > name && digits[-1] >= '0' && digits[-1] <= '9')
        digits--;
    return digits > name && digits[-1] == '.' && random - digits < 16 ? strtol(digits, NULL, 10) : 0;
}

static bool is_leftover(const char *name, const char *prefix, size_t prefix_length)
{
    if (strncmp(name, prefix, prefix_length) != 0)
        return false;
    const long process = owner(name);
    return process > 0 && kill((pid_t)process, 0) != 0 && errno == ESRCH;
}

void temporary_file_remove_leftovers(const char *prefix)
{
    const char *const slash = strrchr(prefix, '/');
    const char *const base = slash ? slash + 1 : prefix;
    char *const folder = slash ? strndup(prefix, (size_t)(base - prefix)) : strdup(".");
    DIR *const entries = folder ? opendir(folder) : NULL;
    const size_t base_length = strlen(base);
    for (const struct dirent *entry; entries && (entry = readdir(entries));)
        if (is_leftover(entry->d_name, base, base_length))
            unlinkat(dirfd(entries), entry->d_name, 0);
    if (entries)
        closedir(entries);
    free(folder);
}

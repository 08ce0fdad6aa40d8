/* SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* realpath */
#include "output_names.h"

#include "output_file.h"

#include <base/text.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The path of the file without links and dots, for free(); the file itself need not be there. */
static char *canonical(const char *path)
{
    char *const whole = realpath(path, NULL);
    if (whole)
        return whole;
    const char *const slash = strrchr(path, '/'), *const base = slash ? slash + 1 : path;
    char *const folder = slash ? strndup(path, (size_t)(base - path)) : strdup(".");
    char *const place = folder ? realpath(folder, NULL) : NULL;
    const size_t size = place ? strlen(place) + strlen(base) + 2 : 0;
    char *const joined = place ? malloc(size) : NULL;
    if (joined)
        snprintf(joined, size, "%s/%s", place, base);
    free(place);
    free(folder);
    return joined;
}

static bool fail_same(const struct output_name *a, const struct output_name *b, char *error,
                      size_t error_size)
{
    return base_text_error(error, error_size, "%s: is the output of both %s%s%s and %s%s%s", b->path,
                           a->option, a->option_value ? " " : "", a->option_value ? a->option_value : "",
                           b->option, b->option_value ? " " : "", b->option_value ? b->option_value : "");
}

static bool check_differ(const struct output_name *names, char *const *places, uint32_t count, char *error,
                         size_t error_size)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < i; k++)
            if (places[i] && places[k] && strcmp(places[i], places[k]) == 0)
                return fail_same(&names[k], &names[i], error, error_size);
    return true;
}

bool output_names_check(const struct output_name *names, uint32_t count, char *error, size_t error_size)
{
    char **const places = calloc(count, sizeof *places);
    bool ok = places || count == 0 || base_text_error(error, error_size, "out of memory");
    for (uint32_t i = 0; ok && i < count; i++) {
        if (!names[i].path)
            continue;
        ok = output_file_check(names[i].path, error, error_size);
        places[i] = canonical(names[i].path);
    }
    ok = ok && check_differ(names, places, count, error, error_size);
    for (uint32_t i = 0; places && i < count; i++)
        free(places[i]);
    free(places);
    return ok;
}

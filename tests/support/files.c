/* SPDX-License-Identifier: MIT */
#include "files.h"

#include "require.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = 256 };

static char folder[PATH_SIZE / 2];

/* The first name of this process's that is free: one that crashed may have left another behind. */
int files_setup(void **state)
{
    (void)state;
    const char *const temporary = getenv("TMPDIR");
    for (unsigned n = 0;; n++) {
        const int length = snprintf(folder, sizeof folder, "%s/sdfgi_test_%ld_%u",
                                    temporary == NULL ? "/tmp" : temporary, (long)getpid(), n);
        if (length < 0 || (size_t)length >= sizeof folder)
            return 1;
        if (mkdir(folder, 0700) == 0)
            return 0;
        if (errno != EEXIST)
            return 1;
    }
}

static int each_file(void (*visit)(const char *name))
{
    int count = 0;
    DIR *const dir = opendir(folder);
    if (dir == NULL)
        return 0;
    for (const struct dirent *entry; (entry = readdir(dir));) {
        if (entry->d_name[0] == '.')
            continue;
        count++;
        if (visit)
            visit(entry->d_name);
    }
    closedir(dir);
    return count;
}

static void remove_file(const char *name)
{
    unlink(files_path(name));
}

int files_teardown(void **state)
{
    (void)state;
    each_file(remove_file);
    return rmdir(folder);
}

const char *files_path(const char *name)
{
    static char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s%s%.120s", folder, name[0] ? "/" : "", name);
    return path;
}

void files_write(const char *name, const void *data, size_t size)
{
    FILE *const file = fopen(files_path(name), "wb");
    REQUIRE_TRUE(file != NULL);
    assert_int_equal(fwrite(data, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

void files_write_text(const char *name, const char *text)
{
    files_write(name, text, strlen(text));
}

void files_write_triangle(const char *name)
{
    files_write_text(
        name, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
              "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
              "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
              "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
              "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
              "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
              "\"min\":[0,0,0],\"max\":[1,1,0]}]}");
}

void files_take_text(const char *name, char *text, size_t size)
{
    FILE *const file = fopen(files_path(name), "rb");
    REQUIRE_TRUE(file != NULL);
    text[fread(text, 1, size - 1, file)] = '\0';
    fclose(file);
    remove_file(name);
}

int files_count(void)
{
    return each_file(NULL);
}

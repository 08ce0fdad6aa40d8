/* SPDX-License-Identifier: MIT */
#include "input_file.h"

#include <base/text.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

FILE *input_file_open(const char *path, uint64_t *size, char *error, size_t error_size)
{
    /* Opening a pipe would wait for its writer. */
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat status;
    if (file < 0 || fstat(file, &status) != 0) {
        base_text_error(error, error_size, "%s", strerror(errno));
    } else if (!S_ISREG(status.st_mode)) {
        base_text_error(error, error_size, "not a plain file");
    } else {
        FILE *stream = fdopen(file, "rb");
        *size = (uint64_t)status.st_size;
        if (stream)
            return stream;
        base_text_error(error, error_size, "%s", strerror(errno));
    }
    if (file >= 0)
        close(file);
    return NULL;
}

char *input_file_read(FILE *stream, uint64_t size, char *error, size_t error_size)
{
    char *bytes = size < SIZE_MAX ? malloc((size_t)size + 1) : NULL;
    if (!bytes) {
        base_text_error(error, error_size, "out of memory");
        return NULL;
    }
    if (fread(bytes, 1, (size_t)size, stream) == size && fgetc(stream) == EOF && !ferror(stream)) {
        bytes[size] = '\0';
        return bytes;
    }
    base_text_error(error, error_size, "cannot be read to its end");
    free(bytes);
    return NULL;
}

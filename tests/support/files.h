/* SPDX-License-Identifier: MIT
 * Files made by tests, in a temporary folder that goes away with the test program. */
#ifndef TEST_FILES_H
#define TEST_FILES_H

#include <stddef.h>

/* cmocka fixtures, of a group or of one test: the folder. Tearing down fails where a test left a folder or a
 * hidden file in it. */
int files_setup(void **state);
int files_teardown(void **state);

/* The path of a file in the folder, or with "" the folder's own; valid until the next call. */
const char *files_path(const char *name);

/* Failures end the test. */
void files_write(const char *name, const void *data, size_t size);
void files_write_text(const char *name, const char *text);
/* A scene of one triangle, as .gltf. */
void files_write_triangle(const char *name);
/* At most `size` - 1 bytes of the file, which is removed then. */
void files_take_text(const char *name, char *text, size_t size);

/* How many files lie in the folder, hidden ones apart. */
int files_count(void);

#endif

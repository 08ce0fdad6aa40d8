/* SPDX-License-Identifier: MIT
 * Which variables the instructions of a SPIR-V module read and write.
 */
#ifndef TEST_ACCESS_H
#define TEST_ACCESS_H

#include <stddef.h>
#include <stdint.h>

enum { ACCESS_READ = 1, ACCESS_WRITE = 2 };

/* What a module of `size` bytes does with each variable: ACCESS_* bits, by id, for free(). The length of an
 * array and the size of an image are no reads. Follows no resource into a function: a shader that passes one
 * fails the test. Counts functions that nothing calls; glslang leaves them out. */
uint8_t *access_by_id(const uint32_t *code, size_t size);

#endif

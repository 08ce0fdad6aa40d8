/* SPDX-License-Identifier: MIT
 * The device of a test program that draws with the host renderer. */
#ifndef TEST_HOST_TEST_H
#define TEST_HOST_TEST_H

struct host_device;

enum { HOST_TEST_SKIP = 77 }; /* exit code of a test that could not run */

/* The device that SDFGI_TEST_DEVICE names, or the best one; all groups of a program have the same. NULL,
 * after a line that says why, if there is none: leave with HOST_TEST_SKIP then. */
struct host_device *host_test_open(void);
/* Adds 1 to the count of failures if the validation layer had something to say. */
int host_test_close(struct host_device *device, int failed);

#endif

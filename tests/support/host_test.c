/* SPDX-License-Identifier: MIT */
#include "host_test.h"

#include "host.h"

#include <stdio.h>
#include <stdlib.h>

/* The device stays for the next group of tests: so do its pipelines. */
static struct host_device *kept;

static void destroy_kept(void)
{
    host_device_destroy(kept);
}

struct host_device *host_test_open(void)
{
    char error[256];
    const struct host_device_desc desc = { .select = getenv("SDFGI_TEST_DEVICE") };
    if (kept)
        return kept;
    kept = host_device_create(&desc, error, sizeof error);
    if (!kept)
        fprintf(stderr, "skipped: %s\n", error);
    else
        atexit(destroy_kept);
    return kept;
}

int host_test_close(struct host_device *device, int failed)
{
    return failed + (host_device_validation_count(device) > 0);
}

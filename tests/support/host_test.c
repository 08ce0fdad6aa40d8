/* SPDX-License-Identifier: MIT */
#include "host_test.h"

#include "host.h"

#include <stdio.h>
#include <stdlib.h>

struct host_device *host_test_open(void)
{
    char error[256];
    const struct host_device_desc desc = { .select = getenv("SDFGI_TEST_DEVICE") };
    struct host_device *device = host_device_create(&desc, error, sizeof error);
    if (!device)
        fprintf(stderr, "skipped: %s\n", error);
    return device;
}

int host_test_close(struct host_device *device, int failed)
{
    failed += host_device_validation_count(device) > 0;
    host_device_destroy(device);
    return failed;
}

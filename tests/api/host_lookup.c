/* SPDX-License-Identifier: MIT */
#include "host_lookup.h"

#include "gpu_test_compute.h"

#include "host_lookup.comp.h"
#include "host_lookup_software.comp.h"

void host_lookup_run(struct gi_test *t, struct host_lookup *lookups, uint32_t count)
{
    const struct gpu_test_shader shader = GI_TEST_SHADER(t->gi, sdfgi_get_descriptor_set(t->gi), host_lookup);
    gpu_test_compute(&t->gpu, &shader, count, lookups, count * sizeof *lookups);
}

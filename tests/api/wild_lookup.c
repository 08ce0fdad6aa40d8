/* SPDX-License-Identifier: MIT */
#include "wild_lookup.h"

#include "gpu_test_compute.h"

#include "wild_lookup.comp.h"
#include "wild_lookup_software.comp.h"

void wild_lookup_run(struct gi_test *t, struct wild_lookup *lookups, uint32_t count)
{
    const struct gpu_test_shader shader = GI_TEST_SHADER(t->gi, sdfgi_get_descriptor_set(t->gi), wild_lookup);
    gpu_test_compute(&t->gpu, &shader, count, lookups, count * sizeof *lookups);
}

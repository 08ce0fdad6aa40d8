/* SPDX-License-Identifier: MIT */
#include "journey_state.h"

#include "context.h"
#include "require.h"

#include <string.h>

_Static_assert((int)RESOURCE_COUNT <= (int)JOURNEY_MAX_BUFFERS, "there is room for every buffer");

/* "sdfgi BITS" is BITS. */
static const char *short_name(const char *name)
{
    const char *space = strrchr(name, ' ');
    return space ? space + 1 : name;
}

void journey_state_find(const struct gi_test *t, struct journey_state *state)
{
    const struct resources *r = t->gi->volume.resources;
    *state = (struct journey_state){ 0 };
    if (!r)
        return;
    state->count = RESOURCE_COUNT;
    for (int i = 0; i < RESOURCE_COUNT; i++)
        state->buffers[i] = (struct journey_buffer){ short_name(sdfgi_resource_row((enum resource)i)->name),
                                                     r->buffers[i].handle, r->buffers[i].size };
}

void journey_state_require_reasons(const struct sdfgi_report *report)
{
    REQUIRE_CMP(report->pass_count, ==, (uint32_t)PASS_COUNT);
    for (uint32_t i = 0; i < report->pass_count; i++) {
        const struct sdfgi_pass_report *pass = &report->passes[i];
        const bool runs = strcmp(pass->reason, sdfgi_need_reason(sdfgi_pass_row((enum pass)i)->need)) == 0;
        if (runs != pass->ran)
            require_fail(__FILE__, __LINE__, "%s: ran: %d, because: %s", pass->name, pass->ran, pass->reason);
    }
}

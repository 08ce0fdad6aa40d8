/* SPDX-License-Identifier: MIT
 * What a context holds once its light has settled, and whether it is what another holds. */
#ifndef TEST_WAKE_RESULT_H
#define TEST_WAKE_RESULT_H

#include "wake_world.h"

enum { WAKE_POINTS = 72, WAKE_TEXT = 256 };

struct wake_result {
    bool settles;    /* it has settled within the frames allowed, and was idle afterwards */
    bool active;     /* GI is on */
    uint32_t frames; /* until it had settled */
    struct sdfgi_settings settings;
    double dark;  /* irradiance below which light need not settle: 1/4096 over the host's exposure */
    int exposure; /* that light is stored with */
    int64_t origins[SDFGI_MAX_CASCADES][3];
    uint8_t *data[RESOURCE_COUNT]; /* copies of what is compared; else NULL */
    uint64_t size[RESOURCE_COUNT];
    uint64_t room; /* entries of a light list */
    float light[WAKE_POINTS][3];
};

/* Updates a context until light has settled, and a few times more; then copies what it holds. */
void wake_result_take(struct wake_result *result, struct wake_device *device, struct wake_context *context,
                      const struct wake_world *world);
void wake_result_free(struct wake_result *result);
/* Has cascades begin where those of `other` are: within their hysteresis the way decides. Before the first
 * update. */
void wake_context_place_as(struct wake_context *context, const struct wake_context *other);
bool wake_result_placed_alike(const struct wake_result *a, const struct wake_result *b);

/* How direct light of cells compares, which is made again only where lights or surfaces change. */
enum wake_direct {
    WAKE_DIRECT_EXACT,
    WAKE_DIRECT_ROUNDED, /* it has been stored with another exposure: one unit of its colours */
    WAKE_DIRECT_ANY,     /* it was made with another origin, so that positions were rounded differently */
};

/* Writes the first difference into `text` and returns false, if there is one. */
bool wake_result_same(const struct wake_result *found, const struct wake_result *fresh,
                      enum wake_direct direct, char text[static WAKE_TEXT]);

#endif

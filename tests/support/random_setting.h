/* SPDX-License-Identifier: MIT
 * Random values of properties, by the library's own table. */
#ifndef TEST_RANDOM_SETTING_H
#define TEST_RANDOM_SETTING_H

#include "test_memory.h"

#include <sdfgi/sdfgi.h>

enum { RANDOM_SETTING_TEXT = 64 };

uint32_t random_setting_rows(void);
/* Gives the property `row` of `settings` another value than it has: a choice, or about as much as in `base`,
 * so that costs stay about the same. Writes that value into `text`. */
void random_setting_change(struct test_random *random, uint32_t row, const struct sdfgi_settings *base,
                           struct sdfgi_settings *settings, char text[static RANDOM_SETTING_TEXT]);
/* Device bytes of a context with these settings. */
uint64_t random_setting_memory(const struct sdfgi_settings *settings);

#endif

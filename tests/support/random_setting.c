/* SPDX-License-Identifier: MIT */
#include "random_setting.h"

#include "require.h"

#include <math.h>
#include <stdio.h>

/* A change may need so many times the memory of the base. */
#define MEMORY_MOST 9

static uint32_t below(struct test_random *random, uint32_t count)
{
    return (uint32_t)test_random_real(random, 0, count);
}

uint32_t random_setting_rows(void)
{
    uint32_t count = 0;
    while (sdfgi_property_get_info(count))
        count++;
    return count;
}

uint64_t random_setting_memory(const struct sdfgi_settings *settings)
{
    struct sdfgi_memory memory;
    REQUIRE_CMP((int)sdfgi_estimate_memory(settings, 2, &memory), ==, (int)SDFGI_OK);
    return memory.total_bytes;
}

static void any_choice(struct test_random *random, const char *choices, char *text)
{
    uint32_t count = 1;
    for (const char *at = choices; (at = strchr(at, ',')); at++)
        count++;
    const char *at = choices;
    for (uint32_t i = below(random, count); i > 0; i--)
        at = strchr(at, ',') + 1;
    snprintf(text, RANDOM_SETTING_TEXT, "%.*s", (int)strcspn(at, ","), at);
}

static void any_value(struct test_random *random, const struct sdfgi_property_info *info,
                      const struct sdfgi_settings *base, char *text)
{
    static const double factors[] = { 0.5, 1, 2 };
    const double wanted = sdfgi_settings_get(base, info->name) * factors[below(random, 3)];
    const double value = fmin(fmax(wanted, info->minimum), info->maximum);
    if (info->type == SDFGI_PROPERTY_BOOL)
        snprintf(text, RANDOM_SETTING_TEXT, "%s", below(random, 2) ? "true" : "false");
    else if (info->choices[0])
        any_choice(random, info->choices, text);
    else
        snprintf(text, RANDOM_SETTING_TEXT, info->type == SDFGI_PROPERTY_INT ? "%.0f" : "%.9g", value);
}

void random_setting_change(struct test_random *random, uint32_t row, const struct sdfgi_settings *base,
                           struct sdfgi_settings *settings, char text[static RANDOM_SETTING_TEXT])
{
    const struct sdfgi_property_info *info = sdfgi_property_get_info(row);
    const struct sdfgi_settings before = *settings;
    char error[200];
    do {
        *settings = before;
        any_value(random, info, base, text);
        if (!sdfgi_settings_set(settings, info->name, text, error, sizeof error))
            require_fail(__FILE__, __LINE__, "%s", error);
    } while (memcmp(settings, &before, sizeof before) == 0 ||
             random_setting_memory(settings) > MEMORY_MOST * random_setting_memory(base));
}

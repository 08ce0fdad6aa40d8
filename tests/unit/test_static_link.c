/* SPDX-License-Identifier: MIT
 * Library, host renderer and the program's parts in one program, all of every archive: a name that two of
 * them define is an error of the linker. */
#include "unit.h"

#include "host.h"

#include <stdio.h>
#include <string.h>

static void the_library_comes_from_its_archive(void **state)
{
    (void)state;
    char line[512];
    FILE *const maps = fopen("/proc/self/maps", "r");
    if (maps == NULL)
        skip();
    while (fgets(line, sizeof line, maps))
        assert_null(strstr(line, "libsdfgi"));
    fclose(maps);
}

static void the_renderer_asks_the_library_in_the_same_program(void **state)
{
    (void)state;
    static struct host_device_info infos[4];
    struct sdfgi_settings settings;
    struct sdfgi_memory memory;
    char error[256] = "";
    sdfgi_settings_default(&settings);
    assert_int_equal(sdfgi_estimate_memory(&settings, 2, &memory), SDFGI_OK);
    assert_true(memory.total_bytes > 0);
    const uint32_t count = host_device_list(infos, 4, error, sizeof error);
    for (uint32_t i = 0; i < count && i < 4; i++)
        assert_true(infos[i].requirements.supported || infos[i].reason[0]);
    assert_true(count > 0 || error[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_library_comes_from_its_archive),
        cmocka_unit_test(the_renderer_asks_the_library_in_the_same_program),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

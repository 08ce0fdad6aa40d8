/* SPDX-License-Identifier: MIT
 * Whatever bits lie in buffers that keep light from frame to frame: light is finite at once, and right again
 * soon. */
#include "light_scene.h"
#include "require.h"

#include <math.h>
#include <stdio.h>

static const struct gi_test_point points[] = {
    { { 0.2f, -1.9f, 0.3f }, { 0, 1, 0 } },
    { { 1.9f, -1, 0.4f }, { -1, 0, 0 } },
    { { 0, 0.5f, 0 }, { 0, 1, 0 } }, /* in the air: probes answer */
};
enum { POINTS = sizeof points / sizeof *points };

static const enum resource histories[] = { RESOURCE_SUMS, RESOURCE_PREVIOUS, RESOURCE_IRRADIANCE };

struct spoiling {
    struct gi_test *t;
    uint32_t pattern;
};

static void record_fill(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct spoiling *s = user;
    const struct gpu_buffer *buffers = s->t->gi->volume.resources->buffers;
    (void)index;
    for (size_t i = 0; i < sizeof histories / sizeof *histories; i++)
        vkCmdFillBuffer(cmd, buffers[histories[i]].handle, 0, VK_WHOLE_SIZE, s->pattern);
}

static void require_finite(struct gi_test *t, uint32_t pattern)
{
    float found[POINTS][3];
    gi_test_irradiance(t, points, POINTS, found);
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            if (!isfinite(found[i][k]) || found[i][k] < 0)
                require_fail(__FILE__, __LINE__, "%#x: point %d reads %g", pattern, i, (double)found[i][k]);
}

/* Largest relative difference. */
static double worst_of(float (*found)[3], float (*wanted)[3])
{
    double worst = 0;
    for (int i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs((double)found[i][k] / (double)wanted[i][k] - 1));
    return worst;
}

static void any_bits_in_histories_become_light_again(void **state)
{
    (void)state;
    static const uint32_t patterns[] = { 0xffffffff, 0x7f800000, 0xff800000, 0x7fc00001, 0x7c007c00,
                                         0xfc00fc00, 0x7e007e00, 0x7f7fffff, 0xdeadbeef };
    static struct gi_test t;
    const struct sdfgi_settings settings = light_settings(32, 0.4f);
    const uint32_t cycle = sdfgi_settings_cycle_frames(&settings);
    float before[POINTS][3], found[POINTS][3];
    gi_test_open(&t, &settings);
    light_set_uniform_sky(&t, 1);
    light_add_box(&t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ 0.7f, 0.7f, 0.7f }, 0);
    light_add_box(&t, (double[]){ 2, -2, -3 }, (double[]){ 3, 0, 3 }, (float[]){ 0.2f, 0.6f, 0.3f }, 0.5f);
    gi_test_converge(&t, 200);
    gi_test_irradiance(&t, points, POINTS, before);
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        gpu_test_submit(&t.gpu, record_fill, &(struct spoiling){ &t, patterns[i] });
        require_finite(&t, patterns[i]);
        sdfgi_volume_invalidate(&t.gi->volume);
        for (uint32_t frame = 0; frame < 5 * cycle; frame++) {
            gi_test_update(&t, 1);
            require_finite(&t, patterns[i]);
        }
        gi_test_irradiance(&t, points, POINTS, found);
        printf("%#x: off by %.4f after five cycles\n", patterns[i], worst_of(found, before));
        REQUIRE_CMP(worst_of(found, before), <=, 0.01);
    }
    gi_test_close(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(any_bits_in_histories_become_light_again) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

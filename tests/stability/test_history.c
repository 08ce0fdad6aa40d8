/* SPDX-License-Identifier: MIT
 * Whatever bits lie in buffers that keep light from frame to frame: light is finite at once, and right again
 * soon. Histories of probes are floats, and what no float of theirs can be is forgotten. What cells keep is
 * coded in whole numbers: any bits are light that might have been there, and fade as fast as such light. */
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

static const uint32_t patterns[] = { 0xffffffff, 0xff800000, 0xdeadbeef, 0x7f800000, 0x7fc00001,
                                     0x7c007c00, 0xfc00fc00, 0x7e007e00, 0x7f7fffff };
enum { PATTERNS = sizeof patterns / sizeof *patterns, CODED_PATTERNS = 3, MOST_HISTORIES = 3 };

/* What is spoiled, with how many of the patterns, and after how many sample cycles light must be right again,
 * how exactly. */
struct histories {
    enum sdfgi_surface_light surface_light;
    enum resource which[MOST_HISTORIES];
    int patterns;
    uint32_t cycles;
    double tolerance;
};

static const struct histories of_probes = {
    SDFGI_SURFACE_LIGHT_PROBES, { RESOURCE_SUMS, RESOURCE_PREVIOUS, RESOURCE_IRRADIANCE }, PATTERNS, 1, 1e-6
};
/* The brightest light that can be coded is 1e5 times that of the scene, and halves in each frame. */
static const struct histories of_cells = { SDFGI_SURFACE_LIGHT_CELLS,
                                           { RESOURCE_LIGHT, RESOURCE_SURFACES, RESOURCE_GATHERED },
                                           CODED_PATTERNS,
                                           8,
                                           0.01 };

struct spoiling {
    struct gi_test *t;
    const struct histories *histories;
    uint32_t pattern;
};

static void record_fill(VkCommandBuffer cmd, uint32_t index, void *user)
{
    const struct spoiling *s = user;
    const struct gpu_buffer *buffers = s->t->gi->volume.resources->buffers;
    (void)index;
    for (int i = 0; i < MOST_HISTORIES; i++)
        vkCmdFillBuffer(cmd, buffers[s->histories->which[i]].handle, 0, VK_WHOLE_SIZE, s->pattern);
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

static void open_scene(struct gi_test *t, const struct sdfgi_settings *settings)
{
    gi_test_open(t, settings);
    light_set_uniform_sky(t, 1);
    light_add_box(t, (double[]){ -3, -3, -3 }, (double[]){ 3, -2, 3 }, (float[]){ 0.7f, 0.7f, 0.7f }, 0);
    light_add_box(t, (double[]){ 2, -2, -3 }, (double[]){ 3, 0, 3 }, (float[]){ 0.2f, 0.6f, 0.3f }, 0.5f);
    gi_test_converge(t, 2000);
}

static void require_light_again(const struct histories *histories)
{
    static struct gi_test t;
    struct sdfgi_settings settings = light_settings(32, 0.4f);
    settings.surface_light = histories->surface_light;
    float before[POINTS][3], found[POINTS][3];
    open_scene(&t, &settings);
    gi_test_irradiance(&t, points, POINTS, before);
    for (int i = 0; i < histories->patterns; i++) {
        gpu_test_submit(&t.gpu, record_fill, &(struct spoiling){ &t, histories, patterns[i] });
        require_finite(&t, patterns[i]);
        sdfgi_volume_invalidate(&t.gi->volume);
        const uint32_t frames = histories->cycles * sdfgi_settings_cycle_frames(&settings);
        for (uint32_t frame = 0; frame < frames; frame++) {
            gi_test_update(&t, 1);
            require_finite(&t, patterns[i]);
        }
        gi_test_irradiance(&t, points, POINTS, found);
        printf("%#x: off by %.2g after %u cycles\n", patterns[i], worst_of(found, before), histories->cycles);
        REQUIRE_CMP(worst_of(found, before), <=, histories->tolerance);
    }
    gi_test_close(&t);
}

static void any_bits_in_histories_of_probes_become_light_in_a_cycle(void **state)
{
    (void)state;
    require_light_again(&of_probes);
}

static void any_bits_in_what_cells_keep_are_light_that_fades(void **state)
{
    (void)state;
    require_light_again(&of_cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_bits_in_histories_of_probes_become_light_in_a_cycle),
        cmocka_unit_test(any_bits_in_what_cells_keep_are_light_that_fades),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

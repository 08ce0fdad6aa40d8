/* SPDX-License-Identifier: MIT
 * What the host tells the library of a surface's reflectance is what the path tracer's surface sends back of
 * even light. */
#include "../../modules/raycast/bsdf.h"
#include "../../runtime/host/host_albedo.h"
#include "require.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

enum { DIRECTIONS = 32, RAYS = 4096 };

/* Share of even light from all directions that a surface sends back in all directions. */
static double path_traced(const struct lobe *lobe, float color, float metallic, float roughness)
{
    const struct vec3 up = vec3_make(0, 0, 1),
                      diffuse = vec3_scale(vec3_make(1, 1, 1), color * (1 - metallic)),
                      specular = vec3_scale(vec3_make(1, 1, 1), metallic > 0 ? color : 0.04f);
    const struct surface surface = { .geometric_normal = up,
                                     .normal = up,
                                     .diffuse = diffuse,
                                     .specular = specular,
                                     .alpha = fmaxf(roughness * roughness, 1e-3f),
                                     .glossy = true };
    double sum = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        const float cosine = sqrtf(((float)i + 0.5f) / DIRECTIONS);
        const struct bsdf bsdf =
            bsdf_make(&surface, lobe, vec3_make(sqrtf(1 - cosine * cosine), 0, cosine), 0);
        struct random random = random_begin(1, (uint64_t)i, 0);
        for (int k = 0; k < RAYS; k++) {
            struct vec3 incoming;
            struct bsdf_value value;
            if (bsdf_sample(&bsdf, &random, &incoming, &value))
                sum += (double)(value.diffuse.x + value.specular.x) / (double)value.pdf;
        }
    }
    return sum / (DIRECTIONS * RAYS);
}

static void the_library_is_told_what_surfaces_send_back(void **state)
{
    (void)state;
    static const float colors[] = { 0.02f, 0.2f, 0.5f, 0.95f }, roughness[] = { 0.05f, 0.3f, 0.6f, 0.8f, 1 };
    struct lobe lobe;
    lobe_init(&lobe);
    for (int metal = 0; metal < 2; metal++)
        for (int c = 0; c < 4; c++)
            for (int r = 0; r < 5; r++) {
                const struct host_albedo told =
                    host_albedo_of((float[]){ colors[c], colors[c], colors[c] }, (float)metal, roughness[r]);
                const double all = (double)told.color[0] + (double)told.specular,
                             truth = path_traced(&lobe, colors[c], (float)metal, roughness[r]);
                printf("%s of %.2f, roughness %.2f: %.3f, path traced %.3f\n", metal ? "metal" : "dielectric",
                       (double)colors[c], (double)roughness[r], all, truth);
                REQUIRE_NEAR(all, truth, 0.01);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(the_library_is_told_what_surfaces_send_back) };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

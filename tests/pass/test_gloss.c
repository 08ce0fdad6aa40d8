/* SPDX-License-Identifier: MIT
 * How much of even light the host's gloss sends to the viewer, against quadrature of its lobe: reflections
 * are multiplied by that. */
#include "gpu_test_compute.h"
#include "oracle_gloss.h"
#include "require.h"
#include "test_group.h"

#include "encode_gloss.comp.h"

#include <math.h>
#include <stdio.h>

/* Along each side of the unit square from which facets are chosen. */
enum { STRATA = 192 };

/* Shares of even light towards a viewer, where Fresnel's term is 1 (x) and Schlick's weight (y). */
struct shares {
    double x, y;
};

/* What the facet sends to the viewer that a point of the unit square chooses from those of GGX that the
 * viewer sees (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"). */
static struct shares of_facet(double cosine, double alpha, double u, double v)
{
    const double sine = sqrt(1 - cosine * cosine), norm = sqrt(alpha * alpha * sine * sine + cosine * cosine);
    const double view_x = alpha * sine / norm, view_z = cosine / norm;
    /* A point of the disc that the stretched hemisphere covers for the viewer. */
    const double radius = sqrt(u), turn = 2 * 3.14159265358979 * v, across = radius * cos(turn),
                 lean = (1 + view_z) / 2,
                 along = (1 - lean) * sqrt(1 - across * across) + lean * radius * sin(turn),
                 up = sqrt(fmax(1 - across * across - along * along, 0));
    /* The axes of the disc are y, and z x view. */
    const double x = alpha * (up * view_x - along * view_z), y = alpha * across,
                 z = fmax(up * view_z + along * view_x, 1e-9), length = sqrt(x * x + y * y + z * z);
    const double of_facet = (x * sine + z * cosine) / length, out = 2 * of_facet * z / length - cosine;
    if (out <= 0)
        return (struct shares){ 0, 0 };
    const double share = oracle_smith(cosine, out, alpha) / oracle_smith(cosine, 1, alpha);
    return (struct shares){ share, share * oracle_fresnel(0, of_facet) };
}

static struct shares of_lobe(double cosine, double alpha)
{
    struct shares sum = { 0, 0 };
    for (int i = 0; i < STRATA * STRATA; i++) {
        const struct shares facet =
            of_facet(cosine, alpha, (i % STRATA + 0.5) / STRATA, (i / STRATA + 0.5) / STRATA);
        sum.x += facet.x / (STRATA * STRATA);
        sum.y += facet.y / (STRATA * STRATA);
    }
    return sum;
}

static void gloss_reflects_even_light_as_its_lobe_does(void **state)
{
    (void)state;
    static const double cosines[] = { 0.03, 0.08, 0.15, 0.25, 0.4, 0.6, 0.8, 1 },
                        roughness[] = { 0.05, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1 }, f0[] = { 0.04, 0.3, 1 };
    enum { LOBES = 8 * 8, COUNT = LOBES * 3 };
    static float data[COUNT][4];
    static struct shares shares[LOBES];
    for (int i = 0; i < COUNT; i++) {
        data[i][0] = (float)cosines[i % 8];
        data[i][1] = (float)(roughness[i / 8 % 8] * roughness[i / 8 % 8]);
        data[i][2] = (float)f0[i / LOBES];
        data[i][3] = NAN;
    }
    gpu_test_compute_alone(encode_gloss_comp, sizeof encode_gloss_comp, COUNT, data, sizeof data);
    double worst = 0;
    for (int i = 0; i < COUNT; i++) {
        if (i < LOBES)
            shares[i] = of_lobe((double)data[i][0], (double)data[i][1]);
        const struct shares share = shares[i % LOBES];
        const double f = (double)data[i][2], single = f * (share.x - share.y) + share.y,
                     truth = single * (1 + f * (1 - share.x) / share.x),
                     off = fabs((double)data[i][3] / truth - 1);
        if (!(off < 0.015))
            printf("cosine %.2f, alpha %.4f, f0 %.2f: %.5f instead of %.5f\n", (double)data[i][0],
                   (double)data[i][1], f, (double)data[i][3], truth);
        worst = off > worst || isnan(off) ? off : worst;
    }
    printf("directional albedo of gloss: off by %.4f at most\n", worst);
    REQUIRE_CMP(worst, <, 0.015);
}

TEST_GROUP(gloss)
{
    if (!gpu_test_available())
        return GPU_TEST_SKIP;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gloss_reflects_even_light_as_its_lobe_does),
    };
    return cmocka_run_group_tests_name("gloss", tests, NULL, NULL);
}

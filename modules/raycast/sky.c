/* SPDX-License-Identifier: MIT */
#include "lights.h"

struct vec3 sky_radiance(const struct sky *s, struct vec3 d)
{
    if (s->map.rgb)
        return environment_radiance(&s->map, d);
    return vec3_lerp(s->horizon, d.y >= 0.0f ? s->zenith : s->ground, fabsf(d.y));
}

bool sky_is_black(const struct sky *s)
{
    return !(s->mean_luminance > 0.0f);
}

/* The lower end of band k, in d.y. */
static float band_start(int k)
{
    return 2.0f * (float)k / SKY_BANDS - 1.0f;
}

static float band_share(const struct sky *s, int k)
{
    return s->cdf[k] - (k > 0 ? s->cdf[k - 1] : 0.0f);
}

/* The radiance is linear in d.y on either side of zero, which is a border of bands: a band's middle is its
 * mean. */
void sky_bands_build(struct sky *s)
{
    double sum = 0.0, total = 0.0;
    if (s->map.rgb) {
        s->mean_luminance = s->map.mean_luminance;
        return;
    }
    for (int k = 0; k < SKY_BANDS; k++)
        total += vec3_luminance(sky_radiance(s, vec3_make(0.0f, band_start(k) + 1.0f / SKY_BANDS, 0.0f)));
    s->mean_luminance = (float)(total / SKY_BANDS);
    for (int k = 0; k < SKY_BANDS; k++) {
        sum += vec3_luminance(sky_radiance(s, vec3_make(0.0f, band_start(k) + 1.0f / SKY_BANDS, 0.0f)));
        s->cdf[k] = total > 0.0 ? (float)(sum / total) : 0.0f;
    }
}

float sky_pdf(const struct sky *s, struct vec3 d)
{
    if (s->map.rgb)
        return environment_pdf(&s->map, d);
    const int band = (int)((d.y + 1.0f) * 0.5f * SKY_BANDS);
    const int k = band < 0 ? 0 : band >= SKY_BANDS ? SKY_BANDS - 1 : band;
    return band_share(s, k) * SKY_BANDS / (4.0f * VEC3_PI);
}

static void bands_sample(const struct sky *s, struct random *r, struct vec3 *direction)
{
    const float x = random_float(r), u = random_float(r), phi = 2.0f * VEC3_PI * random_float(r);
    int k = 0;
    while (k < SKY_BANDS - 1 && s->cdf[k] <= x)
        k++;
    const float y = band_start(k) + u * 2.0f / SKY_BANDS, ring = sqrtf(fmaxf(0.0f, 1.0f - y * y));
    *direction = vec3_make(ring * cosf(phi), y, ring * sinf(phi));
}

void sky_sample(const struct sky *s, struct random *r, struct light_sample *out)
{
    if (s->map.rgb)
        environment_sample(&s->map, r, &out->direction);
    else
        bands_sample(s, r, &out->direction);
    out->at_infinity = true;
    out->pdf = sky_pdf(s, out->direction);
    /* Rounding may lead to a texel beside the one that was chosen, which may be black. */
    const float weight = out->pdf > 0.0f ? 1.0f / out->pdf : 0.0f;
    out->radiance = vec3_scale(sky_radiance(s, out->direction), weight);
}

/* SPDX-License-Identifier: MIT
 * sdfgi compare: how far a picture is from its reference. */
#include "cli.h"
#include "commands.h"
#include "run_options.h"
#include "compare/compare.h"
#include "file/json_write.h"
#include "file/output_names.h"
#include "image/flip.h"
#include "image/tone.h"

#include <base/text.h>
#include <cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct options {
    const char *picture, *reference, *mask, *error_map, *strip;
    bool json;
    struct run_common common;
};

struct images {
    struct image picture, reference, mask;
    float *flip_map;
};

static bool load(const struct options *options, struct images *images, char *error, size_t error_size)
{
    if (!image_read(&images->picture, options->picture, error, error_size) ||
        !image_read(&images->reference, options->reference, error, error_size) ||
        (options->mask && !image_read(&images->mask, options->mask, error, error_size)))
        return false;
    images->flip_map = calloc((size_t)images->reference.width * images->reference.height, sizeof(float));
    if (!images->flip_map)
        snprintf(error, error_size, "compare: out of memory");
    return images->flip_map != NULL;
}

static void release(struct images *images)
{
    image_finish(&images->picture);
    image_finish(&images->reference);
    image_finish(&images->mask);
    free(images->flip_map);
}

/* One panel is the map of errors alone. */
static bool write_map(const char *path, const struct images *images, double exposure, uint32_t panels,
                      char *error, size_t error_size)
{
    const struct image *const reference = &images->reference;
    const size_t count = (size_t)reference->width * reference->height;
    if (reference->width > IMAGE_SIDE_MAX / panels)
        return base_text_error(error, error_size, "%s: the pictures are wider than %u pixels", path,
                               IMAGE_SIDE_MAX / panels);
    uint8_t *const rgba = malloc(4 * count * panels);
    if (!rgba)
        return base_text_error(error, error_size, "compare: out of memory");
    if (panels == 1)
        compare_paint_map(images->flip_map, count, rgba);
    else
        compare_paint_strip(&images->picture, reference, images->flip_map, exposure, rgba);
    const bool written =
        image_write_png(path, rgba, panels * reference->width, reference->height, 3, error, error_size);
    free(rgba);
    return written;
}

static bool write_maps(const struct options *options, const struct images *images, double exposure,
                       char *error, size_t error_size)
{
    return (!options->error_map || write_map(options->error_map, images, exposure, 1, error, error_size)) &&
           (!options->strip ||
            write_map(options->strip, images, exposure, COMPARE_STRIP_PANELS, error, error_size));
}

static void print_text(const struct compare_result *r)
{
    printf("mean luminance     %.6g, reference %.6g\n", r->mean, r->reference_mean);
    if (isnan(r->mean_ratio))
        printf("mean ratio         none: the reference is black; largest luminance %.6g\n", r->max);
    else
        printf("mean ratio         %.5f\n", r->mean_ratio);
    printf("relMSE             %.6g   (epsilon %g)\n", r->relmse, COMPARE_RELMSE_EPSILON);
    printf("p99 relative error %.5f\n", r->p99_relative_error);
    printf("PSNR               %.3f dB\n", r->psnr_db);
    printf("FLIP               %.6f   (maximum %.4f, %.4g pixels per degree)\n", r->flip, r->flip_max,
           FLIP_PIXELS_PER_DEGREE);
    printf("pixels             %llu, exposure %.6g\n", (unsigned long long)r->pixels, r->exposure);
}

/* NaN and infinity have no place in JSON: they become null. */
static cJSON *result_to_json(const struct compare_result *r)
{
    cJSON *json = cJSON_CreateObject();
    const bool complete =
        json_add_number(json, "pixels", (double)r->pixels) && json_add_number(json, "mean", r->mean) &&
        json_add_number(json, "reference_mean", r->reference_mean) &&
        json_add_number(json, "mean_ratio", r->mean_ratio) && json_add_number(json, "max", r->max) &&
        json_add_number(json, "relmse", r->relmse) &&
        json_add_number(json, "relmse_epsilon", COMPARE_RELMSE_EPSILON) &&
        json_add_number(json, "p99_relative_error", r->p99_relative_error) &&
        json_add_number(json, "psnr_db", r->psnr_db) && json_add_number(json, "flip", r->flip) &&
        json_add_number(json, "flip_max", r->flip_max) &&
        json_add_number(json, "pixels_per_degree", FLIP_PIXELS_PER_DEGREE) &&
        json_add_number(json, "exposure", r->exposure) &&
        cJSON_AddStringToObject(json, "tone_curve", tone_description);
    if (complete)
        return json;
    cJSON_Delete(json);
    return NULL;
}

static bool print_json(const struct compare_result *r)
{
    cJSON *json = result_to_json(r);
    char *text = json ? cJSON_Print(json) : NULL;
    if (text)
        puts(text);
    cJSON_free(text);
    cJSON_Delete(json);
    return text != NULL;
}

static int compare(const struct options *options, struct images *images)
{
    char error[CLI_ERROR_BYTES] = "";
    if (!load(options, images, error, sizeof error))
        return cli_error("%s", error);
    const struct compare_input picture = { &images->picture, options->picture };
    const struct compare_input reference = { &images->reference, options->reference };
    const struct compare_input mask = { &images->mask, options->mask };
    struct compare_result result;
    if (!compare_images(&picture, &reference, options->mask ? &mask : NULL, &result, images->flip_map, error,
                        sizeof error) ||
        !write_maps(options, images, result.exposure, error, sizeof error))
        return cli_error("%s", error);
    if (options->common.report &&
        !json_write_file(result_to_json(&result), options->common.report, error, sizeof error))
        return cli_error("%s", error);
    if (options->common.quiet)
        return CLI_EXIT_OK;
    if (!options->json)
        print_text(&result);
    else if (!print_json(&result))
        return cli_error("compare: out of memory");
    return CLI_EXIT_OK;
}

int cmd_compare(int argc, char **argv)
{
    struct options o = { 0 };
    const struct cli_option table[] = {
        { "json", CLI_FLAG, &o.json, .help = "print JSON" },
        { "mask", CLI_TEXT, &o.mask, "FILE", .help = "compare where this picture's red is above 0.5" },
        { "error-map", CLI_TEXT, &o.error_map, "FILE.png", .help = "write FLIP's error of each pixel" },
        { "strip", CLI_TEXT, &o.strip, "FILE.png",
          .help = "write PICTURE, REFERENCE and the error map side by side" },
        RUN_COMMON_OPTIONS(&o.common, RUN_NO_DEVICE, "what is printed, as JSON"),
    };
    const struct cli_positional positionals[] = { { "PICTURE", &o.picture, true },
                                                  { "REFERENCE", &o.reference, true } };
    const struct cli_spec spec = { "compare", "Measures how far PICTURE is from REFERENCE.", CLI_ARRAY(table),
                                   CLI_ARRAY(positionals),
                                   "Reads .exr, .hdr, .pfm and .png. For PSNR and FLIP, pictures that hold "
                                   "radiance are tone-mapped alike:\n"
                                   "x = exposure * radiance, x / (1 + x) per channel, sRGB; the exposure "
                                   "brings the log-average luminance of\n"
                                   "REFERENCE to 0.18." };
    const enum cli_outcome outcome = cli_parse(&spec, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    char error[CLI_ERROR_BYTES];
    const struct output_name outputs[] = { { o.error_map, "--error-map", NULL },
                                           { o.strip, "--strip", NULL },
                                           { o.common.report, "--report", NULL } };
    if (!output_names_check(outputs, 3, error, sizeof error))
        return cli_error("%s", error);
    struct images images = { 0 };
    const int code = compare(&o, &images);
    release(&images);
    return code;
}

/* SPDX-License-Identifier: MIT */
#include "view_option.h"

#include "image/image.h"
#include "view_file.h"
#include "view_frame.h"

#include <base/text.h>
#include <base/vec.h>
#include <math.h>
#include <modules/gltf/gltf_scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS_MAX = 9, NUMBER_BYTES = 64 };

static const double position_max_m = 1.5e11, light_max = 1e20, radians_per_degree = 0.017453292519943295;

/* How many numbers there are between commas; 0 where the text is something else. */
static int numbers_read(const char *text, double values[NUMBERS_MAX])
{
    for (int count = 0; count < NUMBERS_MAX; count++) {
        char number[NUMBER_BYTES];
        const size_t length = strcspn(text, ",");
        if (length >= sizeof number)
            return 0;
        memcpy(number, text, length);
        number[length] = '\0';
        if (!base_text_to_double(number, &values[count]))
            return 0;
        if (text[length] == '\0')
            return count + 1;
        text += length + 1;
    }
    return 0;
}

static bool are_between(const double *values, int count, double least, double most)
{
    for (int i = 0; i < count; i++)
        if (!(values[i] >= least && values[i] <= most))
            return false;
    return true;
}

static void floats_from(const double *values, float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (float)values[i];
}

static void environment_drop(struct host_view *view)
{
    free(view->environment.rgb);
    view->environment = (struct host_environment){ NULL, 0, 0 };
}

bool view_option_sky(const char *text, struct host_view *view, char *error, size_t error_size)
{
    double v[NUMBERS_MAX] = { 0 };
    const int count = numbers_read(text, v);
    if (strcmp(text, "none") == 0 || strcmp(text, "day") == 0) {
        view->sky = text[0] == 'd' ? view_day_sky : (struct host_sky){ { 0 }, { 0 }, { 0 } };
        environment_drop(view);
        return true;
    }
    if ((count != 1 && count != 3 && count != 9) || !are_between(v, count, 0, light_max))
        return base_text_error(error, error_size,
                               "is \"%s\", expected none, day, one radiance, R,G,B, or three colours for "
                               "zenith, horizon and ground, from 0 to %g",
                               text, light_max);
    if (count == 1)
        v[1] = v[2] = v[0];
    floats_from(v, view->sky.zenith);
    floats_from(count == 9 ? v + 3 : v, view->sky.horizon);
    floats_from(count == 9 ? v + 6 : v, view->sky.ground);
    environment_drop(view);
    return true;
}

bool view_option_sun(const char *text, struct host_view *view, char *error, size_t error_size)
{
    double v[NUMBERS_MAX] = { 0 };
    const int count = numbers_read(text, v);
    if (strcmp(text, "none") == 0 || strcmp(text, "day") == 0) {
        view->sun = text[0] == 'd' ? view_day_sun : (struct host_sun){ .enabled = false };
        return true;
    }
    double direction[3] = { v[0], v[1], v[2] };
    if ((count != 3 && count != 6) || !are_between(v, 3, -1e6, 1e6) || !base_vec3d_normalize(direction) ||
        !are_between(v + 3, 3, 0, light_max))
        return base_text_error(error, error_size,
                               "is \"%s\", expected none, day, the way the light travels as X,Y,Z, or "
                               "that and its irradiance as X,Y,Z,R,G,B",
                               text);
    view->sun = view_day_sun;
    floats_from(direction, view->sun.direction);
    if (count == 6)
        floats_from(v + 3, view->sun.irradiance);
    return true;
}

/* ---- Camera ----------------------------------------------------------------------------------------- */

static const struct gltf_camera *camera_find(const struct gltf_scene *scene, const char *text)
{
    char index[16];
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        const struct gltf_camera *const camera = &scene->cameras[i];
        snprintf(index, sizeof index, "%u", i);
        if (strcmp(text, index) == 0 || (camera->name && strcmp(text, camera->name) == 0))
            return camera;
    }
    return NULL;
}

static bool camera_place(const double v[7], int count, struct host_camera *camera)
{
    double forward[3], side[3], up[3] = { 0, 1, 0 };
    base_vec3d_sub(v + 3, v, forward);
    if (!are_between(v, 6, -position_max_m, position_max_m) || !base_vec3d_normalize(forward) ||
        (count == 7 && !are_between(v + 6, 1, 0.1, 179)))
        return false;
    base_vec3d_cross(forward, up, side);
    /* Straight up or down: -Z is up in the picture. */
    if (base_vec3d_length(side) < 1e-4)
        memcpy(up, (const double[3]){ 0, 0, -1 }, sizeof up);
    memcpy(camera->position, v, sizeof camera->position);
    memcpy(camera->look_at, v + 3, sizeof camera->look_at);
    floats_from(up, camera->up);
    if (count == 7)
        camera->yfov_rad = (float)(v[6] * radians_per_degree);
    return true;
}

bool view_option_camera(const char *text, const struct gltf_scene *scene, double aspect,
                        struct host_view *view, char *error, size_t error_size)
{
    double v[NUMBERS_MAX];
    const int count = numbers_read(text, v);
    const struct gltf_camera *const known = camera_find(scene, text);
    if (strcmp(text, "auto") == 0)
        view_frame_scene(scene, aspect, &view->camera);
    else if (known)
        view_camera_from_file(known, &view->camera);
    else if ((count != 6 && count != 7) || !camera_place(v, count, &view->camera))
        return base_text_error(error, error_size,
                               "is \"%s\", expected auto, X,Y,Z,LX,LY,LZ with the angle of view in "
                               "degrees if wanted, or one of the scene's %u cameras",
                               text, scene->camera_count);
    return true;
}

/* ---- Environment ------------------------------------------------------------------------------------ */

/* Three floats of a texel instead of four, none of them negative or not finite. */
static float *texels_take(const struct image *image)
{
    const size_t count = (size_t)image->width * image->height;
    float *const rgb = malloc(3 * count * sizeof *rgb);
    for (size_t i = 0; rgb && i < 3 * count; i++) {
        const float value = image->rgba[4 * (i / 3) + i % 3];
        rgb[i] = value > 0 ? fminf(value, (float)HOST_ENVIRONMENT_MAX) : 0;
    }
    return rgb;
}

bool view_option_environment(const char *path, struct host_view *view, char *error, size_t error_size)
{
    struct image image;
    const enum image_format format = image_format_from_path(path);
    if (format == IMAGE_FORMAT_COUNT || format == IMAGE_PNG)
        return base_text_error(error, error_size,
                               "is \"%s\", expected a picture of radiance: "
                               ".hdr, .exr or .pfm",
                               path);
    if (!image_read(&image, path, error, error_size))
        return false;
    float *const rgb = texels_take(&image);
    const struct host_environment environment = { rgb, image.width, image.height };
    image_finish(&image);
    if (!rgb)
        return base_text_error(error, error_size, "%s: out of memory", path);
    environment_drop(view);
    view->environment = environment;
    view->sky = (struct host_sky){ { 0 }, { 0 }, { 0 } };
    if (memcmp(&view->sun, &view_day_sun, sizeof view->sun) == 0)
        view->sun.enabled = false;
    return true;
}

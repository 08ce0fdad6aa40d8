/* SPDX-License-Identifier: MIT */
#include "scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void sdfgi_scene_init(struct built_scene *s)
{
    memset(s, 0, sizeof *s);
    s->gltf.images = s->images;
    s->gltf.textures = s->textures;
    s->gltf.materials = s->materials;
    s->gltf.primitives = s->primitives;
    s->gltf.instances = s->instances;
    s->gltf.lights = s->lights;
}

void sdfgi_scene_finish(struct built_scene *s)
{
    for (uint32_t i = 0; i < s->gltf.primitive_count; i++) {
        struct gltf_primitive *p = &s->primitives[i];
        free(p->positions);
        free(p->normals);
        free(p->tangents);
        free(p->uv0);
        free(p->indices);
    }
    for (uint32_t i = 0; i < s->gltf.image_count; i++)
        free(s->images[i].texels);
}

struct gltf_material *scene_add_material(struct built_scene *s, float albedo)
{
    const struct gltf_texture_ref none = { .texture = -1, .uv_transform = { 1, 0, 0, 0, 1, 0 } };
    assert_true(s->gltf.material_count < SCENE_CAPACITY);
    struct gltf_material *m = &s->materials[s->gltf.material_count++];
    *m = (struct gltf_material){
        .base_color = { albedo, albedo, albedo, 1 },
        .roughness = 1,
        .normal_scale = 1,
        .occlusion_strength = 1,
        .alpha_cutoff = 0.5f,
        .base_color_texture = none,
        .metallic_roughness_texture = none,
        .normal_texture = none,
        .occlusion_texture = none,
        .emissive_texture = none,
    };
    return m;
}

static void *copied(const void *from, size_t size)
{
    void *to = malloc(size);
    assert_non_null(to);
    return memcpy(to, from, size);
}

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    const float length = sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int k = 0; k < 3; k++)
        out[k] /= length;
}

void scene_add_quad(struct built_scene *s, const float corner[3], const float a[3], const float b[3])
{
    static const float uv[8] = { 0, 0, 1, 0, 1, 1, 0, 1 };
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    const float a_length = sqrtf(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    float positions[12], normals[12], tangents[16], normal[3];
    cross(a, b, normal);
    for (int v = 0; v < 4; v++) {
        for (int k = 0; k < 3; k++) {
            positions[3 * v + k] = corner[k] + uv[2 * v] * a[k] + uv[2 * v + 1] * b[k];
            normals[3 * v + k] = normal[k];
            tangents[4 * v + k] = a[k] / a_length;
        }
        tangents[4 * v + 3] = 1;
    }
    assert_true(s->gltf.primitive_count < SCENE_CAPACITY);
    const uint32_t index = s->gltf.primitive_count++;
    s->primitives[index] = (struct gltf_primitive){
        .vertex_count = 4,
        .index_count = 6,
        .positions = copied(positions, sizeof positions),
        .normals = copied(normals, sizeof normals),
        .tangents = copied(tangents, sizeof tangents),
        .uv0 = copied(uv, sizeof uv),
        .indices = copied(indices, sizeof indices),
        .material = (int32_t)s->gltf.material_count - 1,
    };
    struct gltf_instance *instance = &s->instances[s->gltf.instance_count++];
    *instance = (struct gltf_instance){ .primitive = index };
    for (int k = 0; k < 4; k++)
        instance->transform[5 * k] = 1;
}

void scene_add_floor(struct built_scene *s, float y, float half, bool front_up)
{
    const float z = front_up ? half : -half;
    scene_add_quad(s, (float[]){ -half, y, z }, (float[]){ 2 * half, 0, 0 }, (float[]){ 0, 0, -2 * z });
}

void scene_add_room(struct built_scene *s, float half)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int side = -1; side <= 1; side += 2) {
            float corner[3] = { -half, -half, -half }, a[3] = { 0 }, b[3] = { 0 };
            corner[axis] = (float)side * half;
            a[(axis + (side < 0 ? 1 : 2)) % 3] = 2 * half;
            b[(axis + (side < 0 ? 2 : 1)) % 3] = 2 * half;
            scene_add_quad(s, corner, a, b);
        }
    }
}

int32_t scene_add_texture(struct built_scene *s, uint32_t width, uint32_t height, const uint8_t *rgba)
{
    const uint32_t index = s->gltf.image_count++;
    s->gltf.texture_count++;
    s->images[index] = (struct gltf_image){ .width = width,
                                            .height = height,
                                            .texels = copied(rgba, (size_t)4 * width * height) };
    s->textures[index] = (struct gltf_texture){ .image = (int32_t)index,
                                                .min_filter = GLTF_FILTER_NEAREST,
                                                .mag_filter = GLTF_FILTER_NEAREST };
    return (int32_t)index;
}

struct raycast_view view_make(const double position[3], const double target[3], float yfov_deg)
{
    struct raycast_view v = {
        .camera = { .up = { 0, 1, 0 }, .yfov_deg = yfov_deg },
        .punctual_scale = 1,
        .emissive_scale = 1,
        .default_albedo = { 0.8f, 0.8f, 0.8f },
    };
    memcpy(v.camera.position, position, sizeof v.camera.position);
    memcpy(v.camera.look_at, target, sizeof v.camera.look_at);
    if (position[0] == target[0] && position[2] == target[2]) {
        v.camera.up[1] = 0;
        v.camera.up[2] = -1;
    }
    return v;
}

void view_set_sky(struct raycast_view *v, float radiance)
{
    for (int k = 0; k < 3; k++)
        v->sky.zenith[k] = v->sky.horizon[k] = v->sky.ground[k] = radiance;
}

struct raycast *tracer_create(const struct built_scene *s, const struct raycast_view *v,
                              const struct raycast_settings *settings)
{
    char error[256] = "";
    struct raycast *rc = raycast_create(&s->gltf, v, settings, error, sizeof error);
    if (rc == NULL)
        fail_msg("%s", error);
    return rc;
}

void state_save(const struct raycast *rc, const char *path)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_true(raycast_state_write(rc, file));
    assert_int_equal(fclose(file), 0);
}

double trace_mean(const struct built_scene *s, const struct raycast_view *v, uint32_t width, uint32_t height,
                  uint32_t spp, uint32_t max_bounces, enum raycast_aov aov)
{
    const struct raycast_settings settings = {
        .width = width, .height = height, .max_bounces = max_bounces, .aovs = 1u << aov
    };
    struct raycast *rc = tracer_create(s, v, &settings);
    struct raycast_progress last;
    assert_true(raycast_render(rc, &(struct raycast_budget){ .samples = spp }, NULL, NULL, &last));
    assert_int_equal(last.samples, spp);
    assert_int_equal(last.not_finite, 0);
    const size_t count = (size_t)width * height * raycast_aov_channels(aov);
    float *values = malloc(count * sizeof *values);
    assert_non_null(values);
    assert_true(raycast_image(rc, aov, values));
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    free(values);
    raycast_destroy(rc);
    return sum / (double)count;
}

struct raycast_irradiance gather_up(const struct built_scene *s, const struct raycast_view *v, double x,
                                    double y, double z, uint32_t samples)
{
    struct raycast *rc = tracer_create(s, v, &(struct raycast_settings){ .width = 1, .height = 1 });
    struct raycast_irradiance out;
    raycast_irradiance_gather(rc, (double[]){ x, y, z }, (float[]){ 0, 1, 0 }, 1, samples, &out);
    raycast_destroy(rc);
    return out;
}

void assert_ratio(double actual, double expected, double tolerance)
{
    const double off = fabs(actual / expected - 1);
    if (!(off <= tolerance))
        fail_msg("%.8g, expected %.8g: off by %.3g, allowed %.3g", actual, expected, off, tolerance);
}

/* SPDX-License-Identifier: MIT */
#include "sample_scene.h"

#include "sample_shadow_spirv.h"

#define CGLM_FORCE_DEPTH_ZERO_TO_ONE
#include <cglm/cglm.h>
#include <string.h>

/* ---- Meshes */

/* Adds a rectangle: a corner and two sides, whose cross product is the normal. */
static void add_rectangle(struct sample_scene *s, struct sample_mesh *mesh, vec3 corner, vec3 right, vec3 up)
{
    static const uint16_t order[] = { 0, 1, 2, 0, 2, 3 };
    vec3 normal;
    glm_vec3_crossn(right, up, normal);
    const uint16_t first = (uint16_t)mesh->vertex_count;
    for (int i = 0; i < 4; i++) {
        struct sample_vertex *vertex = &s->vertices[s->vertex_count++];
        for (int k = 0; k < 3; k++) {
            vertex->normal[k] = (int8_t)(127 * normal[k]);
            vertex->position[k] = corner[k] + (i == 1 || i == 2 ? right[k] : 0) + (i >= 2 ? up[k] : 0);
            mesh->low[k] = fminf(mesh->low[k], vertex->position[k]);
            mesh->high[k] = fmaxf(mesh->high[k], vertex->position[k]);
        }
    }
    for (int i = 0; i < 6; i++)
        s->indices[s->index_count++] = (uint16_t)(first + order[i]);
    mesh->vertex_count += 4;
    mesh->index_count += 6;
}

static struct sample_mesh *begin_mesh(struct sample_scene *s, uint32_t index)
{
    s->meshes[index] = (struct sample_mesh){ .first_vertex = s->vertex_count,
                                             .first_index = s->index_count,
                                             .low = { FLT_MAX, FLT_MAX, FLT_MAX },
                                             .high = { -FLT_MAX, -FLT_MAX, -FLT_MAX } };
    return &s->meshes[index];
}

/* A square of 1 x 1 m in the x-z plane that faces up, and a cube of 1 m that stands on it. */
static void make_meshes(struct sample_scene *s)
{
    add_rectangle(s, begin_mesh(s, 0), (vec3){ -0.5f, 0, 0.5f }, (vec3){ 1, 0, 0 }, (vec3){ 0, 0, -1 });
    struct sample_mesh *cube = begin_mesh(s, 1);
    add_rectangle(s, cube, (vec3){ -0.5f, 1, 0.5f }, (vec3){ 1, 0, 0 }, (vec3){ 0, 0, -1 });
    add_rectangle(s, cube, (vec3){ -0.5f, 0, 0.5f }, (vec3){ 1, 0, 0 }, (vec3){ 0, 1, 0 });
    add_rectangle(s, cube, (vec3){ 0.5f, 0, -0.5f }, (vec3){ -1, 0, 0 }, (vec3){ 0, 1, 0 });
    add_rectangle(s, cube, (vec3){ -0.5f, 0, -0.5f }, (vec3){ 0, 0, 1 }, (vec3){ 0, 1, 0 });
    add_rectangle(s, cube, (vec3){ 0.5f, 0, 0.5f }, (vec3){ 0, 0, -1 }, (vec3){ 0, 1, 0 });
}

/* ---- The room */

static struct sample_object place(uint32_t mesh, uint32_t material, vec3 at, vec3 size, float roll_deg,
                                  float pitch_deg)
{
    struct sample_object object = { .mesh = mesh, .material = material };
    mat4 matrix = GLM_MAT4_IDENTITY_INIT;
    glm_translate(matrix, at);
    glm_rotate_z(matrix, glm_rad(roll_deg), matrix);
    glm_rotate_x(matrix, glm_rad(pitch_deg), matrix);
    glm_scale(matrix, size);
    memcpy(object.matrix, matrix, sizeof matrix);
    return object;
}

/* Base colours are multiples of 1/255, which pictures of 8 bits hold. */
static void make_objects(struct sample_scene *s)
{
    const struct sample_material grey = { { 0.6f, 0.6f, 0.6f, 0 }, { 0, 0, 0, 1 } },
                                 red = { { 0.8f, 0.2f, 0.2f, 0 }, { 0, 0, 0, 1 } },
                                 white = { { 0.8f, 0.8f, 0.8f, 0 }, { 0, 0, 0, 1 } },
                                 lit = { { 0.2f, 0.2f, 0.2f, 0 }, { 0, 0.2f, 0.6f, 1 } },
                                 metal = { { 0.8f, 0.8f, 0.8f, 1 }, { 0, 0, 0, 0.04f } };
    s->materials[0] = grey, s->materials[1] = red, s->materials[2] = white, s->materials[3] = lit;
    s->materials[4] = metal;
    s->objects[0] = place(0, 0, (vec3){ 0, 0, 0 }, (vec3){ 8, 1, 6 }, 0, 0);
    s->objects[1] = place(0, 1, (vec3){ -2, 1.5f, 0 }, (vec3){ 3, 1, 6 }, -90, 0);
    s->objects[2] = place(0, 2, (vec3){ 0, 1.5f, -3 }, (vec3){ 8, 1, 3 }, 0, 90);
    s->objects[3] = place(1, 2, (vec3){ 0, 0, 0 }, (vec3){ 0.8f, 1, 1.2f }, 0, 0);
    s->objects[4] = place(1, 3, (vec3){ 2.5f, 0, -2.2f }, (vec3){ 0.4f, 0.8f, 0.4f }, 0, 0);
    s->objects[5] = place(1, 4, (vec3){ -0.4f, 0, 1.6f }, (vec3){ 1.6f, 0.2f, 1 }, 0, 0);
}

/* A perspective of Vulkan's: +Y down, depth from 0 to 1. */
static void look(vec3 eye, vec3 at, float fov_deg, float aspect, mat4 clip_from_world)
{
    mat4 view, projection;
    glm_lookat(eye, at, GLM_YUP, view);
    glm_perspective(glm_rad(fov_deg), aspect, 0.1f, 40, projection);
    projection[1][1] *= -1;
    glm_mat4_mul(projection, view, clip_from_world);
}

/* cglm's own wants 16-byte addresses. */
static void four(vec3 first, float last, float out[static 4])
{
    memcpy(out, first, 3 * sizeof *out);
    out[3] = last;
}

static void make_view(struct sample_view *v, float aspect)
{
    vec3 eye = { 1.5f, 2.2f, 5.5f }, lamp = { 3, 2.5f, 0 }, lit = { -1.2f, 0.9f, 0 };
    const float inner_deg = 24, outer_deg = 32;
    mat4 clip, inverse, lamp_clip;
    vec3 direction;
    look(eye, (vec3){ -0.3f, 0.8f, 0 }, 50, aspect, clip);
    glm_mat4_inv(clip, inverse);
    look(lamp, lit, 2 * outer_deg + 2, 1, lamp_clip);
    glm_vec3_sub(lit, lamp, direction);
    glm_vec3_normalize(direction);
    memcpy(v->clip_from_world, clip, sizeof clip);
    memcpy(v->world_from_clip, inverse, sizeof inverse);
    memcpy(v->lamp_clip_from_world, lamp_clip, sizeof lamp_clip);
    four(eye, 1, v->eye);
    four(lamp, cosf(glm_rad(inner_deg)), v->lamp_position);
    four(direction, cosf(glm_rad(outer_deg)), v->lamp_direction);
    four((vec3){ 250, 235, 212 }, 0, v->lamp_intensity);
    four((vec3){ 0.02f, 0.03f, 0.05f }, 0, v->sky);
}

void sample_scene_make(struct sample_scene *scene, float aspect)
{
    memset(scene, 0, sizeof *scene);
    make_meshes(scene);
    make_objects(scene);
    make_view(&scene->view, aspect);
}

/* Negates what leads into world Y, out of it, or both. */
static void flip_matrix(float m[static 16], bool from_world, bool to_world)
{
    for (int i = 0; i < 4; i++) {
        m[4 + i] *= from_world ? -1 : 1;
        m[4 * i + 1] *= to_world ? -1 : 1;
    }
}

void sample_scene_flip(struct sample_scene *s)
{
    for (uint32_t i = 0; i < s->vertex_count; i++) {
        s->vertices[i].position[1] *= -1;
        s->vertices[i].normal[1] = (int8_t)-s->vertices[i].normal[1];
    }
    for (int i = 0; i < SAMPLE_MESHES; i++) {
        const float low = s->meshes[i].low[1];
        s->meshes[i].low[1] = -s->meshes[i].high[1];
        s->meshes[i].high[1] = -low;
    }
    for (int i = 0; i < SAMPLE_OBJECTS; i++)
        flip_matrix(s->objects[i].matrix, true, true);
    flip_matrix(s->view.clip_from_world, true, false);
    flip_matrix(s->view.lamp_clip_from_world, true, false);
    flip_matrix(s->view.world_from_clip, false, true);
    s->view.eye[1] *= -1;
    s->view.lamp_position[1] *= -1;
    s->view.lamp_direction[1] *= -1;
}

/* ---- On a device */

struct sample_drawing sample_drawing_make(struct sample_gpu *gpu, const struct sample_scene *scene,
                                          VkBufferUsageFlags usage)
{
    struct sample_drawing d;
    d.vertices = sample_buffer_make(gpu, sizeof scene->vertices, usage | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    d.indices = sample_buffer_make(gpu, sizeof scene->indices, usage | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    d.view = sample_buffer_make(gpu, sizeof scene->view, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    memcpy(d.vertices.mapped, scene->vertices, sizeof scene->vertices);
    memcpy(d.indices.mapped, scene->indices, sizeof scene->indices);
    memcpy(d.view.mapped, &scene->view, sizeof scene->view);
    d.shadow = sample_image_make(gpu, SAMPLE_SHADOW_SIDE, SAMPLE_SHADOW_SIDE, VK_FORMAT_D32_SFLOAT,
                                 VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    d.shadow_pass = sample_pass_make(gpu, NULL, 0, VK_IMAGE_LAYOUT_UNDEFINED, &d.shadow);
    const struct sample_code vertex = SAMPLE_CODE(sample_shadow_vert), none = { NULL, 0 };
    d.shadow_pipeline.layout = sample_layout_make(gpu, NULL, 0);
    d.shadow_pipeline.pipeline =
        sample_mesh_pipeline_make(gpu, &d.shadow_pass, d.shadow_pipeline.layout, vertex, none);
    return d;
}

static void draw(const struct sample_drawing *d, const struct sample_scene *scene, const float *before,
                 VkPipelineLayout layout, VkCommandBuffer cmd)
{
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(cmd, 0, 1, &d->vertices.buffer, &start);
    vkCmdBindIndexBuffer(cmd, d->indices.buffer, 0, VK_INDEX_TYPE_UINT16);
    for (int i = 0; i < SAMPLE_OBJECTS; i++) {
        const struct sample_object *object = &scene->objects[i];
        const struct sample_mesh *mesh = &scene->meshes[object->mesh];
        struct sample_push push = { .material = scene->materials[object->material] };
        mat4 matrix;
        memcpy(matrix, object->matrix, sizeof matrix);
        if (before) {
            mat4 outer;
            memcpy(outer, before, sizeof outer);
            glm_mat4_mul(outer, matrix, matrix);
        }
        memcpy(push.matrix, matrix, sizeof matrix);
        vkCmdPushConstants(cmd, layout, VK_SHADER_STAGE_ALL, 0, sizeof push, &push);
        vkCmdDrawIndexed(cmd, mesh->index_count, 1, mesh->first_index, (int32_t)mesh->first_vertex, 0);
    }
}

void sample_drawing_draw(const struct sample_drawing *drawing, const struct sample_scene *scene,
                         VkPipelineLayout layout, VkCommandBuffer cmd)
{
    draw(drawing, scene, NULL, layout, cmd);
}

void sample_drawing_draw_shadow(const struct sample_drawing *drawing, const struct sample_scene *scene,
                                VkCommandBuffer cmd)
{
    sample_pass_begin(cmd, &drawing->shadow_pass);
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing->shadow_pipeline.pipeline);
    draw(drawing, scene, scene->view.lamp_clip_from_world, drawing->shadow_pipeline.layout, cmd);
    vkCmdEndRenderPass(cmd);
}

/* SPDX-License-Identifier: MIT */
#include "view_frame.h"

#include "view_raster.h"

#include <base/vec.h>
#include <modules/gltf/gltf_scene.h>
#include <stdlib.h>
#include <string.h>

/* Share of the picture that the scene's box may fill along a side. */
static const double fill_share = 0.94;
/* Surfaces nearer than this share of the scene's size block the view. */
static const double near_share = 0.02, blocked_share = 0.08;
/* A room must show this much more from inside than from outside. */
static const double inside_gain = 1.4;
/* Triangles that all places together look at; more are sampled. */
static const double triangle_budget = 6e6;

/* Towards the camera, and how much it is liked where places show alike: people look at things from the front,
 * a little from above. glTF's assets face +Z. */
struct place {
    double direction[3], liking;
};
static const struct place places[] = {
    { { 1, 0.7, 1.3 }, 1 },   { { -1, 0.7, 1.3 }, 0.95 }, { { 0, 0.35, 1 }, 0.97 },
    { { 0, 0.05, 1 }, 0.93 }, { { 1, 0.5, 0 }, 0.85 },    { { -1, 0.5, 0 }, 0.85 },
    { { 0, 0.5, -1 }, 0.8 },  { { 1, 0.7, -1.3 }, 0.8 },  { { -1, 0.7, -1.3 }, 0.8 },
    { { 1, 0.05, 0 }, 0.8 },  { { -1, 0.05, 0 }, 0.8 },   { { 0, 0.05, -1 }, 0.75 },
    { { 0, 1, 0.05 }, 0.6 },
};
/* Inside, towards where they look. */
static const struct place looks[] = {
    { { 0, 0, -1 }, 1 }, { { 1, 0, 0 }, 1 },   { { -1, 0, 0 }, 1 }, { { 0, 0, 1 }, 1 },
    { { 1, 0, -1 }, 1 }, { { -1, 0, -1 }, 1 }, { { 1, 0, 1 }, 1 },  { { -1, 0, 1 }, 1 },
};
enum { PLACE_COUNT = sizeof places / sizeof *places, LOOK_COUNT = sizeof looks / sizeof *looks, SIDES = 6 };

struct framing {
    const struct gltf_scene *scene;
    double center[3], half[3], radius_m;
    double tan_x, tan_y;
    uint64_t stride; /* every so many triangles are drawn */
    struct view_raster raster;
    uint32_t *pixels_of; /* by instance and side; one more for what blocks */
    bool is_inside;
};

static void eye_axes(struct view_eye *eye)
{
    double up[3] = { 0, 1, 0 };
    base_vec3d_normalize(eye->forward);
    base_vec3d_cross(eye->forward, up, eye->right);
    if (!base_vec3d_normalize(eye->right))
        memcpy(eye->right, (const double[3]){ 1, 0, 0 }, sizeof eye->right);
    base_vec3d_cross(eye->right, eye->forward, eye->up);
}

/* As near as the corners of the box allow. */
static double fitting_distance(const struct framing *f, const struct view_eye *eye)
{
    double distance_m = 0;
    for (int corner = 0; corner < 8; corner++) {
        double offset[3];
        for (int i = 0; i < 3; i++)
            offset[i] = (corner >> i & 1 ? 1 : -1) * f->half[i];
        const double depth = base_vec3d_dot(offset, eye->forward);
        const double x = fabs(base_vec3d_dot(offset, eye->right)) / (fill_share * eye->tan_x);
        const double y = fabs(base_vec3d_dot(offset, eye->up)) / (fill_share * eye->tan_y);
        distance_m = fmax(distance_m, fmax(x, y) - depth);
    }
    return distance_m > 0 ? distance_m : f->radius_m;
}

static struct view_eye eye_outside(const struct framing *f, const double direction[3])
{
    struct view_eye eye = { .tan_x = f->tan_x, .tan_y = f->tan_y };
    for (int i = 0; i < 3; i++)
        eye.forward[i] = -direction[i];
    eye_axes(&eye);
    const double distance_m = fitting_distance(f, &eye);
    for (int i = 0; i < 3; i++)
        eye.position[i] = f->center[i] - distance_m * eye.forward[i];
    return eye;
}

/* In the middle, where it looks least at walls. */
static struct view_eye eye_inside(const struct framing *f, const double direction[3])
{
    struct view_eye eye = { .tan_x = f->tan_x, .tan_y = f->tan_y };
    memcpy(eye.forward, direction, sizeof eye.forward);
    eye_axes(&eye);
    for (int i = 0; i < 3; i++)
        eye.position[i] = f->center[i] - (i == 1 ? 0.1 : 0.5 * eye.forward[i]) * f->half[i];
    return eye;
}

/* ---- What an eye sees ------------------------------------------------------------------------------- */

static void corner_get(const struct gltf_instance *instance, const float *p, const struct view_eye *eye,
                       double world[3], double seen[3])
{
    const double *const m = instance->transform;
    double relative[3];
    for (int i = 0; i < 3; i++) {
        world[i] = m[i] * (double)p[0] + m[4 + i] * (double)p[1] + m[8 + i] * (double)p[2] + m[12 + i];
        relative[i] = world[i] - eye->position[i];
    }
    seen[0] = base_vec3d_dot(relative, eye->right);
    seen[1] = base_vec3d_dot(relative, eye->up);
    seen[2] = base_vec3d_dot(relative, eye->forward);
}

/* Which of six directions a normal is nearest to. */
static uint32_t side_of_normal(const double n[3])
{
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(n[i]) > fabs(n[axis]))
            axis = i;
    return 2 * (uint32_t)axis + (n[axis] < 0);
}

static void normal_of(double world[3][3], double sign, double normal[3])
{
    double a[3], b[3];
    base_vec3d_sub(world[1], world[0], a);
    base_vec3d_sub(world[2], world[0], b);
    base_vec3d_cross(a, b, normal);
    for (int i = 0; i < 3; i++)
        normal[i] *= sign;
}

static double determinant_sign(const double m[16])
{
    double cross[3];
    base_vec3d_cross(m, m + 4, cross);
    return base_vec3d_dot(cross, m + 8) < 0 ? -1 : 1;
}

/* Backs are left out where the renderer leaves them out. From inside they block the view: who sees them
 * stands in something solid. */
static uint32_t part_of(const struct framing *f, uint32_t instance, bool is_back, const double normal[3])
{
    return is_back && f->is_inside ? SIDES * f->scene->instance_count
                                   : SIDES * instance + side_of_normal(normal);
}

static void instance_draw(struct framing *f, const struct view_eye *eye, uint32_t index, uint64_t *turn)
{
    const struct gltf_instance *const instance = &f->scene->instances[index];
    const struct gltf_primitive *const p = &f->scene->primitives[instance->primitive];
    const bool double_sided = f->scene->materials[p->material].double_sided;
    const double sign = determinant_sign(instance->transform);
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        double world[3][3], seen[3][3], normal[3], towards[3];
        if ((*turn)++ % f->stride != 0)
            continue;
        for (int k = 0; k < 3; k++)
            corner_get(instance, p->positions + 3 * (size_t)p->indices[i + (uint32_t)k], eye, world[k],
                       seen[k]);
        normal_of(world, sign, normal);
        base_vec3d_sub(eye->position, world[0], towards);
        const bool is_back = base_vec3d_dot(normal, towards) < 0;
        if (is_back && !double_sided && !f->is_inside)
            continue;
        for (int k = 0; is_back && k < 3; k++)
            normal[k] = -normal[k];
        view_raster_triangle(&f->raster, eye, seen, near_share * f->radius_m,
                             part_of(f, index, is_back, normal));
    }
}

/* What is seen: the share that is covered, and the entropy of its parts. Nothing, where too much is close. */
static double value_of_view(struct framing *f, const struct view_eye *eye, double *covered)
{
    uint64_t turn = 0;
    uint32_t pixels = 0, blocked = 0;
    double entropy = 0;
    memset(&f->raster, 0, sizeof f->raster);
    for (uint32_t i = 0; i < f->scene->instance_count; i++)
        instance_draw(f, eye, i, &turn);
    for (int i = 0; i < VIEW_RASTER_PIXELS; i++)
        if (f->raster.nearness[i] > 0) {
            f->pixels_of[f->raster.what[i]]++;
            pixels++;
            blocked += 1 / (double)f->raster.nearness[i] < blocked_share * f->radius_m ||
                       f->raster.what[i] == SIDES * f->scene->instance_count;
        }
    for (int i = 0; i < VIEW_RASTER_PIXELS; i++) {
        uint32_t *const part = &f->pixels_of[f->raster.what[i]];
        const double share = *part / (double)VIEW_RASTER_PIXELS;
        entropy -= share > 0 ? share * log(share) : 0;
        *part = 0;
    }
    *covered = pixels / (double)VIEW_RASTER_PIXELS;
    return blocked > VIEW_RASTER_PIXELS / 20 ? 0 : entropy + *covered;
}

/* ---- The choice ------------------------------------------------------------------------------------- */

static double best_outside(struct framing *f, struct view_eye *best)
{
    double most = -1, covered;
    for (int i = 0; i < PLACE_COUNT; i++) {
        const struct view_eye eye = eye_outside(f, places[i].direction);
        const double value = places[i].liking * value_of_view(f, &eye, &covered);
        if (value > most) {
            most = value;
            *best = eye;
        }
    }
    return most;
}

/* Only where walls are all around. */
static double best_inside(struct framing *f, struct view_eye *best)
{
    double most = -1, covered, least_covered = 1;
    f->is_inside = true;
    for (int i = 0; i < LOOK_COUNT; i++) {
        const struct view_eye eye = eye_inside(f, looks[i].direction);
        const double value = value_of_view(f, &eye, &covered);
        least_covered = fmin(least_covered, value > 0 ? covered : 0);
        if (value > most) {
            most = value;
            *best = eye;
        }
    }
    return least_covered > 0.8 ? most : -1;
}

static void use_eye(const struct framing *f, const struct view_eye *eye, struct host_camera *camera)
{
    double offset[3];
    base_vec3d_sub(f->center, eye->position, offset);
    /* What it turns around when it is moved: the middle, if it is in front. */
    const double depth = fmax(base_vec3d_dot(offset, eye->forward), 0.25 * f->radius_m);
    for (int i = 0; i < 3; i++) {
        camera->position[i] = eye->position[i];
        camera->look_at[i] = eye->position[i] + depth * eye->forward[i];
        camera->up[i] = (float)eye->up[i];
    }
}

static bool framing_init(struct framing *f, const struct gltf_scene *scene, double aspect, double yfov_rad)
{
    uint64_t triangles = 0;
    f->scene = scene;
    f->tan_y = tan(yfov_rad / 2);
    f->tan_x = aspect * f->tan_y;
    for (int i = 0; i < 3; i++) {
        f->center[i] = scene->bounds_min[i] / 2 + scene->bounds_max[i] / 2;
        f->half[i] = scene->bounds_max[i] / 2 - scene->bounds_min[i] / 2;
    }
    f->radius_m = base_vec3d_length(f->half);
    if (!(f->radius_m > 0) || !isfinite(f->radius_m))
        f->radius_m = f->half[0] = f->half[1] = f->half[2] = 1;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        triangles += scene->primitives[scene->instances[i].primitive].index_count / 3;
    f->stride = 1 + (uint64_t)((double)triangles * (PLACE_COUNT + LOOK_COUNT) / triangle_budget);
    f->pixels_of = calloc((size_t)SIDES * (scene->instance_count + 1), sizeof *f->pixels_of);
    return f->pixels_of != NULL;
}

void view_frame_scene(const struct gltf_scene *scene, double aspect, struct host_camera *camera)
{
    struct framing *const f = calloc(1, sizeof *f);
    struct view_eye outside, inside;
    /* Without memory the camera stays where it was. */
    if (f && framing_init(f, scene, aspect, (double)camera->yfov_rad)) {
        const double without = best_outside(f, &outside), within = best_inside(f, &inside);
        use_eye(f, within > inside_gain * without ? &inside : &outside, camera);
    }
    if (f)
        free(f->pixels_of);
    free(f);
}

double view_cells_scale(const struct gltf_scene *scene, const struct host_camera *camera, double finest_m,
                        double coarsest_m)
{
    double reach_m = 0;
    for (int i = 0; i < 3; i++)
        reach_m = fmax(reach_m, fmax(fabs(scene->bounds_min[i] - camera->position[i]),
                                     fabs(scene->bounds_max[i] - camera->position[i])));
    const double needed_m = 2 * reach_m;
    if (!(needed_m > 0) || !isfinite(needed_m))
        return 1;
    return needed_m > coarsest_m ? needed_m / coarsest_m : needed_m < finest_m ? needed_m / finest_m : 1;
}

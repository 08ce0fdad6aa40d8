/* SPDX-License-Identifier: MIT
 * Instances as voxelisers read them. */
#include "volume.h"

#include <math.h>

/* Places are clamped, so that the difference of two fits 64 bits. */
#define FARTHEST_PLACE (INT64_C(1) << 61)

static double determinant(const float m[9])
{
    return (double)m[0] * (m[4] * m[8] - m[5] * m[7]) - (double)m[3] * (m[1] * m[8] - m[2] * m[7]) +
           (double)m[6] * (m[1] * m[5] - m[2] * m[4]);
}

/* Whether the cross product of the edges of a triangle, once transformed, points behind its front. */
static bool is_reversed(const struct scene *scene, const struct instance *instance, VkFrontFace front_face)
{
    const bool mirrored = determinant(instance->desc.transform.basis) < 0;
    return (mirrored != scene->left_handed) != (front_face == VK_FRONT_FACE_CLOCKWISE);
}

/* What wraps round is put together again where 64 bits are read. */
static uint32_t low_word(int64_t place)
{
    return (uint32_t)((uint64_t)place & UINT32_MAX);
}

static int32_t high_word(int64_t place)
{
    return (int32_t)(place >> 32);
}

static int64_t place_of(double subvoxels)
{
    const double most = (double)FARTHEST_PLACE;
    return (int64_t)fmin(fmax(floor(ldexp(subvoxels, SDFGI_PLACE_BITS)), -most), most);
}

struct sdfgi_instance_params sdfgi_params_of_instance(const struct cascades *cascades,
                                                      const struct scene *scene,
                                                      const struct instance *instance)
{
    const struct sdfgi_transform *t = &instance->desc.transform;
    const struct mesh *mesh = sdfgi_pool_get(&scene->meshes, instance->desc.mesh.id);
    vec3 rows[3];
    int64_t place[3];
    for (int i = 0; i < 3; i++) {
        const double scale = SDFGI_SUBVOXELS / cascades->at[0].cell_size[i];
        rows[i] = (vec3){ (float)(t->basis[i] * scale), (float)(t->basis[3 + i] * scale),
                          (float)(t->basis[6 + i] * scale) };
        place[i] = place_of(t->translation[i] * scale);
    }
    const bool reversed = is_reversed(scene, instance, mesh->desc.front_face);
    return (struct sdfgi_instance_params){
        .row_x = rows[0],
        .place_low_x = low_word(place[0]),
        .row_y = rows[1],
        .place_low_y = low_word(place[1]),
        .row_z = rows[2],
        .place_low_z = low_word(place[2]),
        .place_high = { high_word(place[0]), high_word(place[1]), high_word(place[2]) },
        .material = sdfgi_pool_index(&scene->materials, instance->desc.material.id) |
                    (reversed ? SDFGI_INSTANCE_REVERSED : 0),
    };
}

int64_t sdfgi_params_corner(const struct cascades *cascades, uint32_t cascade, int axis)
{
    const int64_t unit = ((int64_t)SDFGI_SUBVOXELS << SDFGI_PLACE_BITS) << cascade,
                  most = FARTHEST_PLACE / unit, at = cascades->at[cascade].origin[axis];
    return (at < -most ? -most : at > most ? most : at) * unit;
}

/* SPDX-License-Identifier: MIT
 * The scene functions of sdfgi.h. */
#include "context.h"

enum sdfgi_result sdfgi_material_create(sdfgi *gi, const struct sdfgi_material_desc *desc,
                                        sdfgi_material *out)
{
    return sdfgi_scene_material_create(&gi->scene, desc, out);
}

enum sdfgi_result sdfgi_material_update(sdfgi *gi, sdfgi_material material,
                                        const struct sdfgi_material_desc *desc)
{
    return sdfgi_scene_material_update(&gi->scene, material, desc);
}

enum sdfgi_result sdfgi_material_destroy(sdfgi *gi, sdfgi_material material)
{
    return sdfgi_scene_material_destroy(&gi->scene, material);
}

enum sdfgi_result sdfgi_mesh_create(sdfgi *gi, const struct sdfgi_mesh_desc *desc, sdfgi_mesh *out)
{
    return sdfgi_scene_mesh_create(&gi->scene, desc, out);
}

enum sdfgi_result sdfgi_mesh_destroy(sdfgi *gi, sdfgi_mesh mesh)
{
    return sdfgi_scene_mesh_destroy(&gi->scene, mesh);
}

enum sdfgi_result sdfgi_instance_create(sdfgi *gi, const struct sdfgi_instance_desc *desc,
                                        sdfgi_instance *out)
{
    return sdfgi_scene_instance_create(&gi->scene, desc, out);
}

enum sdfgi_result sdfgi_instances_create(sdfgi *gi, uint32_t count, const struct sdfgi_instance_desc *descs,
                                         sdfgi_instance *out)
{
    return sdfgi_scene_instances_create(&gi->scene, count, descs, out);
}

enum sdfgi_result sdfgi_instances_destroy(sdfgi *gi, uint32_t count, const sdfgi_instance *instances)
{
    return sdfgi_scene_instances_destroy(&gi->scene, count, instances);
}

enum sdfgi_result sdfgi_instance_set_transform(sdfgi *gi, sdfgi_instance instance,
                                               const struct sdfgi_transform *transform)
{
    return sdfgi_scene_instance_set_transform(&gi->scene, instance, transform);
}

enum sdfgi_result sdfgi_instance_destroy(sdfgi *gi, sdfgi_instance instance)
{
    return sdfgi_scene_instance_destroy(&gi->scene, instance);
}

enum sdfgi_result sdfgi_light_create(sdfgi *gi, const struct sdfgi_light_desc *desc, sdfgi_light *out)
{
    return sdfgi_scene_light_create(&gi->scene, desc, out);
}

enum sdfgi_result sdfgi_light_update(sdfgi *gi, sdfgi_light light, const struct sdfgi_light_desc *desc)
{
    return sdfgi_scene_light_update(&gi->scene, light, desc);
}

enum sdfgi_result sdfgi_light_destroy(sdfgi *gi, sdfgi_light light)
{
    return sdfgi_scene_light_destroy(&gi->scene, light);
}

enum sdfgi_result sdfgi_set_sky(sdfgi *gi, const struct sdfgi_sky *sky)
{
    return sdfgi_scene_set_sky(&gi->scene, sky);
}

enum sdfgi_result sdfgi_set_sky_harmonics(sdfgi *gi, const struct sdfgi_sky_harmonics *harmonics)
{
    return sdfgi_scene_set_harmonics(&gi->scene, harmonics);
}

enum sdfgi_result sdfgi_invalidate_box(sdfgi *gi, const double box_min[3], const double box_max[3])
{
    return sdfgi_scene_invalidate_box(&gi->scene, box_min, box_max);
}

/* SPDX-License-Identifier: MIT
 * X(type, field, one or many, whether it shows, values) in the order of the structures. Values of one field
 * are valid together with those of all others. */
#include "wake_fields.h"

#include "require.h"

/* clang-format off */
#define SEEN   true
#define UNSEEN false
#define ONE    0
#define MANY   { 0 }
#define MOVED  { { 0 }, { 0 } }
/* A structure with a table of its own. */
#define NESTED UNSEEN, 0

#define TEXTURE_FIELDS(X)                                                                                    \
    X(VkImageView,          view,         ONE,  SEEN,   -1, 0, 1)                                            \
    X(VkImageLayout,        layout,       ONE,  UNSEEN, 0, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)         \
    X(float,                uv_transform, MANY, SEEN,   0, 0.5, 1, -1, 3)                                    \
    X(VkSamplerAddressMode, address_u,    ONE,  SEEN,   0, 1, 2)                                             \
    X(VkSamplerAddressMode, address_v,    ONE,  SEEN,   0, 1, 2)                                             \
    X(bool,                 decode_srgb,  ONE,  SEEN,   0, 1)

#define MATERIAL_FIELDS(X)                                                                                   \
    X(float,                albedo,                MANY, SEEN,   0, 0.2, 0.4, 0.6)                           \
    X(float,                alpha,                 ONE,  SEEN,   0, 0.5, 0.9, 1)                             \
    X(float,                emission,              MANY, SEEN,   0, 0.5, 2, 6)                               \
    X(float,                alpha_cutoff,          ONE,  SEEN,   0, 0.3, 0.6, 0.95)                          \
    X(bool,                 double_sided_emission, ONE,  SEEN,   0, 1)                                       \
    X(float,                smoothness,            ONE,  UNSEEN, 0, 0.3, 0.8, 1)                            \
    X(float,                specular_albedo,       ONE,  SEEN,   0, 0.1, 0.3, 0.5)                          \
    X(float,                metallic,              ONE,  UNSEEN, 0, 0.6, 0.8, 1)                            \
    X(struct sdfgi_texture, albedo_texture,        MANY, NESTED)                                             \
    X(struct sdfgi_texture, emission_texture,      MANY, NESTED)

#define MESH_FIELDS(X)                                                                                       \
    X(VkBuffer,     position_buffer, ONE,  SEEN,   WAKE_POSITIONS, WAKE_OTHER_POSITIONS)                     \
    X(VkDeviceSize, position_offset, ONE,  SEEN,   0, 36)                                                    \
    X(VkDeviceSize, position_range,  ONE,  UNSEEN, 0, 4096)                                                  \
    X(uint32_t,     position_stride, ONE,  SEEN,   0, 12, 16, 24)                                            \
    X(VkFormat,     position_format, ONE,  SEEN,   0, VK_FORMAT_R32G32B32_SFLOAT, VK_FORMAT_R32G32_SFLOAT)   \
    X(VkBuffer,     uv_buffer,       ONE,  SEEN,   -1, WAKE_UVS, WAKE_OTHER_UVS)                             \
    X(VkDeviceSize, uv_offset,       ONE,  SEEN,   0, 8, 20)                                                 \
    X(VkDeviceSize, uv_range,        ONE,  UNSEEN, 0, 4096)                                                  \
    X(uint32_t,     uv_stride,       ONE,  SEEN,   0, 8, 12)                                                 \
    X(VkFormat,     uv_format,       ONE,  SEEN,   0, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R16G16_UNORM)       \
    X(VkBuffer,     color_buffer,    ONE,  SEEN,   -1, WAKE_COLORS, WAKE_OTHER_COLORS)                       \
    X(VkDeviceSize, color_offset,    ONE,  SEEN,   0, 16, 36)                                                \
    X(VkDeviceSize, color_range,     ONE,  UNSEEN, 0, 4096)                                                  \
    X(uint32_t,     color_stride,    ONE,  SEEN,   0, 16, 20)                                                \
    X(VkFormat,     color_format,    ONE,  SEEN,   0, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16_UNORM)   \
    X(VkBuffer,     index_buffer,    ONE,  SEEN,   -1, WAKE_INDICES, WAKE_OTHER_INDICES)                     \
    X(VkDeviceSize, index_offset,    ONE,  SEEN,   0, 12, 24)                                                \
    X(VkDeviceSize, index_range,     ONE,  UNSEEN, 0, 4096)                                                  \
    X(VkIndexType,  index_type,      ONE,  SEEN,   VK_INDEX_TYPE_UINT16, VK_INDEX_TYPE_UINT32,               \
                                                   VK_INDEX_TYPE_UINT8_EXT)                                  \
    X(uint32_t,     first_index,     ONE,  SEEN,   0, 3)                                                     \
    X(int32_t,      vertex_offset,   ONE,  SEEN,   0, 3)                                                     \
    X(uint32_t,     vertex_count,    ONE,  UNSEEN, 51, 54, 60)                                               \
    X(uint32_t,     triangle_count,  ONE,  SEEN,   6, 12, 15)                                                \
    X(float,        bounds_min,      MANY, UNSEEN, -1, -1.2)                                                 \
    X(float,        bounds_max,      MANY, UNSEEN, 1, 1.2)                                                   \
    X(VkFrontFace,  front_face,      ONE,  SEEN,   0, 1)

#define TRANSFORM_FIELDS(X)                                                                                  \
    X(float,  basis,       MANY, SEEN, 0.25, 0.6, 1, -0.6)                                                   \
    X(double, translation, MANY, SEEN, -4.4, 4.4)

#define INSTANCE_FIELDS(X)                                                                                   \
    X(sdfgi_mesh,             mesh,      MANY,  SEEN,   1, 2)                                                \
    X(sdfgi_material,         material,  MANY,  SEEN,   0, 1, 2, 3)                                          \
    X(struct sdfgi_transform, transform, MOVED, NESTED)                                                      \
    X(enum sdfgi_mobility,    mobility,  ONE,   SEEN,   0, 1)

#define LIGHT_FIELDS(X)                                                                                      \
    X(enum sdfgi_light_type, type,            ONE,  SEEN, 0, 1, 2)                                           \
    X(double,                position,        MANY, SEEN, -1.3, -0.2, 0.5, 1.4)                              \
    X(float,                 direction,       MANY, SEEN, -1, -0.4, 0.3, 0.8)                                \
    X(float,                 intensity,       MANY, SEEN, 0, 2, 5, 12)                                       \
    X(float,                 range_m,         ONE,  SEEN, 0, 1, 2)                                           \
    X(float,                 inner_angle_rad, ONE,  SEEN, 0, 0.2, 0.4)                                       \
    X(float,                 outer_angle_rad, ONE,  SEEN, 0.5, 0.8, 1.4)                                     \
    X(float,                 indirect_energy, ONE,  SEEN, 0, 0.5, 1, 2)                                      \
    X(bool,                  casts_shadow,    ONE,  SEEN, 0, 1)

#define SKY_FIELDS(X)                                                                                        \
    X(float, zenith,  MANY, SEEN, 0, 0.3, 1, 2)                                                              \
    X(float, horizon, MANY, SEEN, 0, 0.3, 1, 2)                                                              \
    X(float, ground,  MANY, SEEN, 0, 0.3, 1, 2)

#define FRAME_FIELDS(X)                                                                                      \
    X(double,   camera_position, MANY, SEEN,   0, 3.7, -4.1)                                                 \
    X(double,   origin,          MANY, UNSEEN, 0, 0.7, -120, 5000)                                           \
    X(uint32_t, seed,            ONE,  UNSEEN, 0, 1, 77)                                                     \
    X(float,    exposure,        ONE,  UNSEEN, 0, 1, 0.02, 1e-4, 300)                                        \
    X(bool,     cut,             ONE,  UNSEEN, 0, 1)                                                         \
    X(bool,     forward_reflections, ONE, UNSEEN, 0, 1)
/* clang-format on */

#define TABLES(TABLE)                                                                                        \
    TABLE(sdfgi_texture, TEXTURE_FIELDS)                                                                     \
    TABLE(sdfgi_material_desc, MATERIAL_FIELDS)                                                              \
    TABLE(sdfgi_mesh_desc, MESH_FIELDS)                                                                      \
    TABLE(sdfgi_transform, TRANSFORM_FIELDS)                                                                 \
    TABLE(sdfgi_instance_desc, INSTANCE_FIELDS)                                                              \
    TABLE(sdfgi_light_desc, LIGHT_FIELDS)                                                                    \
    TABLE(sdfgi_sky, SKY_FIELDS)                                                                             \
    TABLE(sdfgi_frame_desc, FRAME_FIELDS)

/* Nothing is missing: each entry of a table is an initialiser, and -Wmissing-field-initializers finds the
 * structure that has more fields than its table has entries. */
#define ZERO(type, field, initial, ...) initial,
#define COMPLETE(name, FIELDS)                                                                               \
    static const struct name complete_##name __attribute__((unused)) = { FIELDS(ZERO) };
TABLES(COMPLETE)

/* ---- Rows */

/* clang-format off */
#define TYPE(type)                                                                                           \
    _Generic(*(type *)0, bool: WAKE_TYPE_BOOL, float: WAKE_TYPE_F32, double: WAKE_TYPE_F64,                 \
             VkDeviceSize: WAKE_TYPE_U64, VkBuffer: WAKE_TYPE_BUFFER, VkImageView: WAKE_TYPE_VIEW,           \
             default: WAKE_TYPE_U32)
/* clang-format on */
#define COUNT(array) (sizeof(array) / sizeof *(array))
#define VALUES(...)                                                                                          \
    (const double[])                                                                                         \
    {                                                                                                        \
        __VA_ARGS__                                                                                          \
    }
#define PART(structure, type_, field, shows_, ...)                                                           \
    { .name = #field,                                                                                        \
      .shows = shows_,                                                                                       \
      .type = TYPE(type_),                                                                                   \
      .offset = offsetof(structure, field),                                                                  \
      .count = sizeof(((structure *)0)->field) / sizeof(type_),                                              \
      .values = VALUES(__VA_ARGS__),                                                                         \
      .value_count = COUNT((VALUES(__VA_ARGS__))) },

#define TEXTURE_PART(type, field, initial, ...)   PART(struct sdfgi_texture, type, field, __VA_ARGS__)
#define MATERIAL_PART(type, field, initial, ...)  PART(struct sdfgi_material_desc, type, field, __VA_ARGS__)
#define MESH_PART(type, field, initial, ...)      PART(struct sdfgi_mesh_desc, type, field, __VA_ARGS__)
#define TRANSFORM_PART(type, field, initial, ...) PART(struct sdfgi_transform, type, field, __VA_ARGS__)
#define INSTANCE_PART(type, field, initial, ...)  PART(struct sdfgi_instance_desc, type, field, __VA_ARGS__)
#define LIGHT_PART(type, field, initial, ...)     PART(struct sdfgi_light_desc, type, field, __VA_ARGS__)
#define SKY_PART(type, field, initial, ...)       PART(struct sdfgi_sky, type, field, __VA_ARGS__)
#define FRAME_PART(type, field, initial, ...)     PART(struct sdfgi_frame_desc, type, field, __VA_ARGS__)

static const struct wake_part texture_parts[] = { TEXTURE_FIELDS(TEXTURE_PART) },
                              material_parts[] = { MATERIAL_FIELDS(MATERIAL_PART) },
                              mesh_parts[] = { MESH_FIELDS(MESH_PART) },
                              transform_parts[] = { TRANSFORM_FIELDS(TRANSFORM_PART) },
                              instance_parts[] = { INSTANCE_FIELDS(INSTANCE_PART) },
                              light_parts[] = { LIGHT_FIELDS(LIGHT_PART) },
                              sky_parts[] = { SKY_FIELDS(SKY_PART) },
                              frame_parts[] = { FRAME_FIELDS(FRAME_PART) };

/* Whether an object is there; and what a buffer or a texture holds. */
static const struct wake_part exists_parts[] = { { "exists", SEEN, WAKE_TYPE_BOOL, 0, 1, VALUES(0, 1), 2 } },
                              content_parts[] = { { "content", SEEN, WAKE_TYPE_U32, 0, 1, VALUES(0, 1, 2),
                                                    3 } };

/* The room stays: it holds all points that are looked at. */
#define GROUP(name, object, first, end, member, at, stride, parts)                                           \
    {                                                                                                        \
        name, object, first, end, offsetof(struct wake_world, member) + (at), stride, parts, COUNT(parts)    \
    }
#define SINGLE(name, object, member, parts) GROUP(name, object, 0, 1, member, 0, 0, parts)
#define ALL(name, object, first, end, member, parts)                                                         \
    GROUP(name, object, first, end, member, 0, sizeof *((struct wake_world *)0)->member, parts)

static const struct wake_group groups[] = {
    SINGLE("frame", WAKE_FRAME, frame, frame_parts),
    SINGLE("sky", WAKE_SKY, sky, sky_parts),
    ALL("light", WAKE_LIGHT, 0, WAKE_LIGHTS, lights, light_parts),
    ALL("material", WAKE_MATERIAL, 0, WAKE_MATERIALS, materials, material_parts),
    GROUP("albedo_texture", WAKE_MATERIAL, 0, WAKE_MATERIALS, materials,
          offsetof(struct sdfgi_material_desc, albedo_texture), sizeof(struct sdfgi_material_desc),
          texture_parts),
    GROUP("emission_texture", WAKE_MATERIAL, 0, WAKE_MATERIALS, materials,
          offsetof(struct sdfgi_material_desc, emission_texture), sizeof(struct sdfgi_material_desc),
          texture_parts),
    ALL("mesh", WAKE_MESH, 1, WAKE_MESHES, meshes, mesh_parts),
    ALL("instance", WAKE_INSTANCE, 1, WAKE_INSTANCES, instances, instance_parts),
    GROUP("transform", WAKE_INSTANCE, 1, WAKE_INSTANCES, instances,
          offsetof(struct sdfgi_instance_desc, transform), sizeof(struct sdfgi_instance_desc),
          transform_parts),
    ALL("light", WAKE_LIGHT_EXISTS, 0, WAKE_LIGHTS, light_exists, exists_parts),
    ALL("instance", WAKE_INSTANCE_EXISTS, 1, WAKE_INSTANCES, instance_exists, exists_parts),
    ALL("buffer", WAKE_BUFFER_CONTENT, WAKE_THINGS, WAKE_BUFFERS, contents.buffers, content_parts),
    ALL("texture", WAKE_TEXTURE_CONTENT, 0, WAKE_TEXTURES, contents.textures, content_parts),
};

/* Fields with one value are structures, which have groups of their own. */
static struct wake_field find(uint32_t index, uint32_t *count)
{
    uint32_t i = 0;
    for (const struct wake_group *group = groups; group < groups + COUNT(groups); group++)
        for (const struct wake_part *part = group->parts; part < group->parts + group->part_count; part++)
            if (part->value_count > 1 && i++ == index)
                return (struct wake_field){ group, part };
    *count = i;
    return (struct wake_field){ NULL, NULL };
}

uint32_t wake_field_count(void)
{
    uint32_t count = 0;
    find(UINT32_MAX, &count);
    return count;
}

struct wake_field wake_field_get(uint32_t index)
{
    uint32_t count = UINT32_MAX;
    const struct wake_field field = find(index, &count);
    REQUIRE_TRUE(field.part != NULL);
    return field;
}

/* ---- Values */

static size_t element_size(enum wake_type type)
{
    static const size_t sizes[] = {
        [WAKE_TYPE_BOOL] = sizeof(bool),        [WAKE_TYPE_U32] = sizeof(uint32_t),
        [WAKE_TYPE_U64] = sizeof(uint64_t),     [WAKE_TYPE_F32] = sizeof(float),
        [WAKE_TYPE_F64] = sizeof(double),       [WAKE_TYPE_BUFFER] = sizeof(VkBuffer),
        [WAKE_TYPE_VIEW] = sizeof(VkImageView),
    };
    return sizes[type];
}

static void *address(const struct wake_field *field, const struct wake_world *world, uint32_t object,
                     uint32_t element)
{
    return (char *)(uintptr_t)world + field->group->offset + object * field->group->stride +
           field->part->offset + element * element_size(field->part->type);
}

static double buffer_index(const struct wake_device *device, VkBuffer buffer)
{
    for (int i = 0; i < WAKE_BUFFERS; i++)
        if (device->buffers[i].buffer == buffer)
            return i;
    return -1;
}

static double view_index(const struct wake_device *device, VkImageView view)
{
    for (int i = 0; i < WAKE_TEXTURES; i++)
        if (device->textures[i].view == view)
            return i;
    return -1;
}

double wake_field_read(const struct wake_field *field, const struct wake_device *device,
                       const struct wake_world *world, uint32_t object, uint32_t element)
{
    const void *at = address(field, world, object, element);
    switch (field->part->type) {
    case WAKE_TYPE_BOOL:
        return *(const bool *)at;
    case WAKE_TYPE_U32:
        return *(const uint32_t *)at;
    case WAKE_TYPE_U64:
        return (double)*(const uint64_t *)at;
    case WAKE_TYPE_F32:
        return (double)*(const float *)at;
    case WAKE_TYPE_F64:
        return *(const double *)at;
    case WAKE_TYPE_BUFFER:
        return buffer_index(device, *(const VkBuffer *)at);
    case WAKE_TYPE_VIEW:
        break;
    }
    return view_index(device, *(const VkImageView *)at);
}

void wake_field_write(const struct wake_field *field, const struct wake_device *device,
                      struct wake_world *world, uint32_t object, uint32_t element, double value)
{
    void *at = address(field, world, object, element);
    switch (field->part->type) {
    case WAKE_TYPE_BOOL:
        *(bool *)at = value != 0;
        break;
    case WAKE_TYPE_U32:
        *(uint32_t *)at = (uint32_t)value;
        break;
    case WAKE_TYPE_U64:
        *(uint64_t *)at = (uint64_t)value;
        break;
    case WAKE_TYPE_F32:
        *(float *)at = (float)value;
        break;
    case WAKE_TYPE_F64:
        *(double *)at = value;
        break;
    case WAKE_TYPE_BUFFER:
        *(VkBuffer *)at = value < 0 ? VK_NULL_HANDLE : device->buffers[(int)value].buffer;
        break;
    case WAKE_TYPE_VIEW:
        *(VkImageView *)at = value < 0 ? VK_NULL_HANDLE : device->textures[(int)value].view;
        break;
    }
}

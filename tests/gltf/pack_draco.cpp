// SPDX-License-Identifier: MIT
#include "pack.h"

#include <cstring>
#include <memory>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#pragma GCC diagnostic pop

static void attribute_add(draco::Mesh &mesh, draco::GeometryAttribute::Type type, int8_t components,
                          const float *values)
{
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, components, draco::DT_FLOAT32, false,
                   static_cast<int64_t>(sizeof(float)) * components, 0);
    const int id = mesh.AddAttribute(attribute, true, GRID_VERTICES);
    for (uint32_t i = 0; i < GRID_VERTICES; i++)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              values + static_cast<size_t>(components) * i);
}

extern "C" size_t draco_encode(const struct grid *grid, bool edgebreaker, uint8_t *out, size_t capacity)
{
    draco::Mesh mesh;
    mesh.set_num_points(GRID_VERTICES);
    for (size_t i = 0; i < GRID_TRIANGLES; i++) {
        draco::Mesh::Face face;
        for (size_t k = 0; k < 3; k++)
            face[k] = draco::PointIndex(grid->indices[3 * i + k]);
        mesh.AddFace(face);
    }
    attribute_add(mesh, draco::GeometryAttribute::POSITION, 3, grid->positions);
    attribute_add(mesh, draco::GeometryAttribute::NORMAL, 3, grid->normals);
    attribute_add(mesh, draco::GeometryAttribute::TEX_COORD, 2, grid->uv);
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                          : draco::MESH_SEQUENTIAL_ENCODING);
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok() || buffer.size() > capacity)
        return 0;
    memcpy(out, buffer.data(), buffer.size());
    return buffer.size();
}

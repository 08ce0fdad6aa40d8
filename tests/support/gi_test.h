/* SPDX-License-Identifier: MIT
 * A context of the library on a test device, with meshes made in code, and a look at what its buffers hold.
 */
#ifndef TEST_GI_TEST_H
#define TEST_GI_TEST_H

#include "gpu_test.h"
#include "context.h"
#include "meshes.h"
#include "oracle_bits.h"

enum { GI_TEST_MAX_MESHES = 64 };

struct gi_test {
    struct gpu_test gpu;
    sdfgi *gi;
    struct gpu_test_buffer buffers[2 * GI_TEST_MAX_MESHES];
    uint32_t buffer_count;
    struct sdfgi_frame_desc frame;
    enum sdfgi_up_axis up_axis; /* of contexts that gi_test_restart makes */
    bool left_handed;
    uint32_t messages[SDFGI_MESSAGE_COUNT]; /* how often each was logged */
    char last_message[256];
};

/* Opens a device and a context that is switched on with `settings`; the camera stands in the origin. Must
 * stay where it is until it is closed. Devices stay open for contexts to come, with their pipelines: making
 * those takes longer than most scenes of tests. */
void gi_test_open(struct gi_test *t, const struct sdfgi_settings *settings);
void gi_test_close(struct gi_test *t);
/* Opens the device alone, for a context that the test makes itself; gi_test_close closes both. */
void gi_test_open_device(struct gi_test *t);
/* Destroys the context and its meshes; the device stays. */
void gi_test_destroy(struct gi_test *t);
/* Another context, without a scene, on the same device: drivers may run out of instances after some sixty.
 * Contexts share compute pipelines. */
void gi_test_restart(struct gi_test *t, const struct sdfgi_settings *settings);
/* An empty scene and a start from nothing in the same context, whose pipelines stay: they take longer to make
 * than most scenes of tests. Opens what is closed. */
void gi_test_renew(struct gi_test *t, const struct sdfgi_settings *settings);

/* What such a context is made from: for tests that open the device and make the context themselves. */
struct sdfgi_desc gi_test_desc(struct gi_test *t, const struct sdfgi_settings *settings);

/* Small and quick: 64 cells a side, one cascade, 0.25 m, enabled. */
struct sdfgi_settings gi_test_settings(void);

sdfgi_mesh gi_test_mesh(struct gi_test *t, const struct test_mesh *mesh);
/* Claims the bounds of `bounded`, for a mesh with vertices that are not finite. */
sdfgi_mesh gi_test_mesh_within(struct gi_test *t, const struct test_mesh *mesh,
                               const struct test_mesh *bounded);
sdfgi_material gi_test_material(struct gi_test *t, const float albedo[static 3],
                                const float emission[static 3]);
/* An instance of `mesh` in world space, without a transform. */
sdfgi_instance gi_test_add(struct gi_test *t, const struct test_mesh *mesh, sdfgi_material material);

/* Updates `count` times, as a host with several frames in flight would. */
void gi_test_update(struct gi_test *t, uint32_t count);
/* Updates until light has settled; fails after `limit` frames. Returns how many it took. */
uint32_t gi_test_converge(struct gi_test *t, uint32_t limit);

/* A copy of a buffer; the caller frees it. */
void *gi_test_read(struct gi_test *t, enum resource resource, uint64_t *size);
/* Bytes of a buffer, from its first on, that do not depend on the order in which threads run. */
uint64_t gi_test_ordered_bytes(const struct gi_test *t, enum resource resource);
/* Of bytes; FNV-1a. */
uint64_t gi_test_hash(const void *bytes, uint64_t size);
/* The value of a half float that is finite. */
float gi_test_half(uint16_t half);
/* Solid bits of a cascade in cell space, whatever texels they are stored at. */
struct oracle_bits gi_test_bits(struct gi_test *t, uint32_t cascade);
/* Those of all cascades, 64 for each cell as it is stored; the caller frees them. */
uint64_t *gi_test_subvoxels(struct gi_test *t);
/* World space to sub-voxels of a cascade. */
struct oracle_grid gi_test_grid(const struct gi_test *t, uint32_t cascade);
/* Index of a local cell in volumes with one element per cell. */
uint32_t gi_test_cell(const struct gi_test *t, uint32_t cascade, uint32_t x, uint32_t y, uint32_t z);
/* Index of a light cell in buffers with one element per entry of the light lists; the test fails if it is
 * none. */
uint32_t gi_test_light_entry(struct gi_test *t, uint32_t cascade, const uint32_t cell[static 3]);
/* Direct light of an entry of a cascade's list, in a copy of RESOURCE_DIRECT. */
struct gi_test_direct {
    uint32_t color, axes;
    uint32_t lights; /* from which it comes, a bit each */
};
struct gi_test_direct gi_test_direct_at(const uint32_t *copy, uint64_t room, uint32_t cascade,
                                        uint64_t entry);
/* Distances in cells, N^3, x fastest; the caller frees them. */
float *gi_test_distances(struct gi_test *t, uint32_t cascade);

/* Irradiance (W/m^2) by the host's lookup at points relative to the frame's origin, seen from 0.1 m in front
 * of each. */
struct gi_test_point {
    float position[3], normal[3];
};
void gi_test_irradiance(struct gi_test *t, const struct gi_test_point *points, uint32_t count,
                        float (*irradiance)[3]);
/* The same seen from one place. */
void gi_test_irradiance_from(struct gi_test *t, const float *viewer, const struct gi_test_point *points,
                             uint32_t count, float (*irradiance)[3]);
/* The same with a set of the library's, which may be that of a context without light; `viewer` may be NULL.
 */
void gi_test_lookup(struct gi_test *t, VkDescriptorSet set, const float *viewer,
                    const struct gi_test_point *points, uint32_t count, float (*irradiance)[3]);

/* A test's shader that looks light up with `lookups`, a set of the library's: the one for software drivers
 * where the context is for these. */
#define GI_TEST_SHADER(gi, lookups, name)                                                                    \
    ((struct gpu_test_shader){ sdfgi_is_software(gi) ? name##_software_comp : name##_comp,                   \
                               sdfgi_is_software(gi) ? sizeof name##_software_comp : sizeof name##_comp,     \
                               sdfgi_get_descriptor_set_layout(gi), lookups })

/* Records a gather that must succeed, and waits for it. */
void gi_test_gather(struct gi_test *t, const struct sdfgi_gather_desc *desc);
/* The same of a view's resolve. */
void gi_test_resolve(struct gi_test *t, sdfgi_view *view, const struct sdfgi_resolve_desc *desc);
/* An image for sdfgi_gather: the output if it has four half floats a texel, else a depth or normals. */
struct gpu_test_image gi_test_gather_image(struct gi_test *t, VkFormat format, uint32_t texel_size,
                                           uint32_t width, uint32_t height, const void *texels);

#endif

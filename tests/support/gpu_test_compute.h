/* SPDX-License-Identifier: MIT
 * Compute shaders of the tests' own: set 1, binding 0 is a storage buffer, the push constant a count, and
 * workgroups have 64 threads, one per element. */
#ifndef TEST_GPU_TEST_COMPUTE_H
#define TEST_GPU_TEST_COMPUTE_H

#include "gpu_test.h"

struct gpu_test_shader {
    const uint32_t *code;
    size_t code_size;             /* bytes */
    VkDescriptorSetLayout layout; /* of set 0; null: an empty one */
    VkDescriptorSet set;          /* null: none is bound */
};

/* Runs `shader` for `count` elements on a copy of `data`, and brings back what it left there. The pipeline is
 * kept for the next call with the same code. Its layout of set 0 may be another one of equal definition: that
 * of another context. */
void gpu_test_compute(struct gpu_test *gpu, const struct gpu_test_shader *shader, uint32_t count, void *data,
                      size_t size);

/* The same on a device without features, which is opened for it and closed. */
void gpu_test_compute_alone(const uint32_t *code, size_t code_size, uint32_t count, void *data, size_t size);

/* Destroys the pipeline that was kept. */
void gpu_test_compute_forget(struct gpu_test *gpu);

#endif

/* SPDX-License-Identifier: MIT
 * What the sample hosts draw with: passes, pipelines, and a descriptor set. */
#ifndef SAMPLE_DRAW_H
#define SAMPLE_DRAW_H

#include "sample_gpu.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { SAMPLE_MAX_COLORS = 4, SAMPLE_MAX_BINDINGS = 8, SAMPLE_MAX_SETS = 2, SAMPLE_PUSH_BYTES = 96 };

/* A render pass with a framebuffer. All images are cleared, and are in `after` when it ends. */
struct sample_pass {
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    uint32_t width, height, color_count;
    VkClearValue clear[SAMPLE_MAX_COLORS + 1]; /* depth is last, and 1 */
};

struct sample_pass sample_pass_make(struct sample_gpu *gpu, const struct sample_image *colors,
                                    uint32_t color_count, VkImageLayout colors_after,
                                    const struct sample_image *depth);
void sample_pass_begin(VkCommandBuffer cmd, const struct sample_pass *pass);

/* One descriptor of the host's set; every stage sees it. */
struct sample_binding {
    VkDescriptorType type;
    VkBuffer buffer;
    VkImageView view;
    VkImageLayout layout;
};

struct sample_set {
    VkDescriptorSetLayout layout;
    VkDescriptorSet set;
    VkSampler sampler; /* of all its pictures */
};

/* Bindings count from 0. Sampled images are read between texels, and white beyond their edges. */
struct sample_set sample_set_make(struct sample_gpu *gpu, const struct sample_binding *bindings,
                                  uint32_t count);

/* Puts another picture in the place of one, in a set that no command buffer has bound yet. */
void sample_set_replace(struct sample_gpu *gpu, const struct sample_set *set, uint32_t binding,
                        const struct sample_binding *by);

struct sample_code {
    const uint32_t *words;
    size_t bytes;
};

#define SAMPLE_CODE(words)                                                                                   \
    {                                                                                                        \
        words, sizeof(words)                                                                                 \
    }

struct sample_pipeline {
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

/* SAMPLE_PUSH_BYTES of push constants, for every stage. */
VkPipelineLayout sample_layout_make(struct sample_gpu *gpu, const VkDescriptorSetLayout *sets,
                                    uint32_t count);
/* Draws meshes of sample_scene.h. Without `fragment` depth alone, shifted away from the viewer. */
VkPipeline sample_mesh_pipeline_make(struct sample_gpu *gpu, const struct sample_pass *pass,
                                     VkPipelineLayout layout, struct sample_code vertex,
                                     struct sample_code fragment);
VkPipeline sample_compute_pipeline_make(struct sample_gpu *gpu, VkPipelineLayout layout,
                                        struct sample_code code);

#ifdef __cplusplus
}
#endif
#endif

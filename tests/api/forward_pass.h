/* SPDX-License-Identifier: MIT
 * A host that draws: one graphics pipeline, whatever the switch, whose shader looks light up. */
#ifndef TEST_FORWARD_PASS_H
#define TEST_FORWARD_PASS_H

#include "gpu_test.h"

#include "sdfgi/sdfgi.h"

enum { FORWARD_SIDE = 8 };

struct forward_pass {
    struct gpu_test_image image;
    VkRenderPass pass;
    VkFramebuffer framebuffer;
    VkPipelineLayout layout;
    VkPipeline pipeline;
};

void forward_pass_open(struct forward_pass *forward, struct gpu_test *gpu, const sdfgi *gi);
void forward_pass_close(struct forward_pass *forward, struct gpu_test *gpu);

/* Draws with a set of the library's: GI in rgb, 0.25 in alpha. */
void forward_pass_draw(struct forward_pass *forward, struct gpu_test *gpu, VkDescriptorSet lookup,
                       float texels[FORWARD_SIDE * FORWARD_SIDE][4]);

#endif

/* SPDX-License-Identifier: MIT
 * A window that shows what a sample host draws, through GLFW. Without one (NULL) frames are just submitted.
 */
#ifndef SAMPLE_WINDOW_H
#define SAMPLE_WINDOW_H

#include "sample_gpu.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sample_window;

/* NULL unless a window is wanted. */
struct sample_window *sample_window_open(bool wanted, uint32_t width, uint32_t height);
/* What instance and device need for it. */
const char *const *sample_window_instance_extensions(const struct sample_window *window, uint32_t *count);
const char *const *sample_window_device_extensions(const struct sample_window *window, uint32_t *count);

/* Waits for a picture of the window to draw to, before anything of the frame is recorded. False once the
 * window was closed. */
bool sample_window_acquire(struct sample_window *window, struct sample_gpu *gpu);
/* Submits the frame, and shows `image`, which is in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL. */
void sample_window_show(struct sample_window *window, struct sample_gpu *gpu,
                        const struct sample_image *image);
/* The device must be idle. */
void sample_window_close(struct sample_window *window, struct sample_gpu *gpu);

#ifdef __cplusplus
}
#endif
#endif

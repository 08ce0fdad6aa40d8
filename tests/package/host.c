/* SPDX-License-Identifier: MIT
 * A host that links the library and needs no device: C11 and, under another name, C++17. */
#include <sdfgi/debug.h>
#include <sdfgi/inspect.h>
#include <sdfgi/sdfgi.h>
#include <stdio.h>
#include <string.h>

static enum sdfgi_message heard = SDFGI_MESSAGE_COUNT;

static void hear(void *user, enum sdfgi_log_level level, enum sdfgi_message id, const char *text)
{
    (void)user;
    (void)level;
    (void)text;
    heard = id;
}

/* The functions of a host with its own layer over Vulkan: the library's may have the same names inside. */
int gpu_fill(void);
int gpu_buffer_init(void);

int gpu_fill(void)
{
    return 1;
}

int gpu_buffer_init(void)
{
    return 2;
}

int main(void)
{
    struct sdfgi_desc desc;
    struct sdfgi_memory memory;
    struct sdfgi_inspect_surface surface;
    const uint32_t no_emission[2] = { 0, 0 };
    sdfgi *gi = NULL;
    memset(&desc, 0, sizeof desc);
    desc.log.fn = hear;

    if (sdfgi_version() != SDFGI_VERSION || SDFGI_VERSION < SDFGI_MAKE_VERSION(0, 1, 0))
        return 1;
    if (sdfgi_estimate_memory(NULL, 2, &memory) != SDFGI_OK || memory.total_bytes == 0)
        return 2;
    if (sdfgi_create(&desc, &gi) != SDFGI_ERROR_INVALID_ARGUMENT || heard != SDFGI_MESSAGE_INVALID_ARGUMENT)
        return 3;
    sdfgi_inspect_decode_block(NULL, no_emission, 0, 1, &surface);
    if (surface.albedo[0][0] != 0 || sdfgi_debug_view_find("solid") != SDFGI_DEBUG_SOLID)
        return 4;
    printf("%d.%d.%d\n", SDFGI_VERSION_MAJOR, SDFGI_VERSION_MINOR, SDFGI_VERSION_PATCH);
    return gpu_fill() + gpu_buffer_init() == 3 ? 0 : 5;
}

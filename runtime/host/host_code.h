/* SPDX-License-Identifier: MIT
 * The host's shaders as C has them. */
#ifndef HOST_CODE_H
#define HOST_CODE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct host_code {
    const uint32_t *words;
    size_t bytes;
};

#define HOST_CODE(name) ((struct host_code){ name, sizeof(name) })

struct host_gi;
/* Whether shaders that look light up are those for software drivers. */
bool host_gi_is_software(const struct host_gi *gi);

/* A shader that looks light up: of its two forms the one that fits the context. */
#define HOST_LOOKUP_CODE(gi, name, stage)                                                                    \
    (host_gi_is_software(gi) ? HOST_CODE(name##_software_##stage) : HOST_CODE(name##_##stage))

#endif

/* SPDX-License-Identifier: MIT
 * The arguments of a pass: `SDFGI_PUSH(sdfgi_region_args);` declares them as push constants `args`. */
#ifndef SDFGI_PUSH_GLSL
#define SDFGI_PUSH_GLSL

#ifdef SDFGI_ZERO
#define SDFGI_PUSH(type)                                                                                     \
    layout(push_constant) uniform sdfgi_push                                                                 \
    {                                                                                                        \
        type sdfgi_args[1];                                                                                  \
    }
#define args sdfgi_args[SDFGI_ZERO]
#else
#define SDFGI_PUSH(type)                                                                                     \
    layout(push_constant) uniform sdfgi_push                                                                 \
    {                                                                                                        \
        type args;                                                                                           \
    }
#endif

#endif

/* SPDX-License-Identifier: MIT
 * Why uniforms are elements of arrays on a CPU. lavapipe looks for conditions that hang on uniforms alone. It
 * copies and compiles a shader that has any for their values, in every dispatch: a gather of 16x16 pixels
 * took 21 ms. It does not look at elements whose index it cannot know. Devices with processors of their own
 * know the index: the specialization constant is 0 there, and 1 on a CPU. */
#ifndef SDFGI_ON_CPU_GLSL
#define SDFGI_ON_CPU_GLSL

layout(constant_id = 0) const uint on_cpu = 0u;

/* What never holds. Shaders of draws define it before they include this. */
#ifndef SDFGI_NEVER
#define SDFGI_NEVER (gl_NumWorkGroups.x == 0u)
#endif

/* Index of the only element. */
#define SDFGI_ZERO (on_cpu & uint(SDFGI_NEVER))

#endif

/* SPDX-License-Identifier: MIT
 * Why uniforms are elements of arrays with one element. lavapipe looks for conditions that depend on uniforms
 * alone. If a shader has any, lavapipe copies it, puts the values in and compiles the copy, in every
 * dispatch: a gather of 16x16 pixels took 21 ms. It leaves elements alone whose index it does not know. On
 * GPUs the specialization constant is 0, so that compilers do know it; on a CPU it is 1. */
#ifndef SDFGI_ON_CPU_GLSL
#define SDFGI_ON_CPU_GLSL

layout(constant_id = 0) const uint on_cpu = 0u;

/* A condition that never holds. Shaders of draws define it before they include this. */
#ifndef SDFGI_NEVER
#define SDFGI_NEVER (gl_NumWorkGroups.x == 0u)
#endif

/* Index of the only element. */
#define SDFGI_ZERO (on_cpu & uint(SDFGI_NEVER))

#endif

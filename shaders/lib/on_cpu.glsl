/* SPDX-License-Identifier: MIT
 * Why uniforms are elements of arrays with one element. lavapipe looks for conditions that depend on uniforms
 * alone. If a shader has any, lavapipe copies it, puts the values in and compiles the copy, in every
 * dispatch: a gather of 16x16 pixels took 21 ms. It leaves elements alone whose index it does not know.
 * Compilers for GPUs do know it, as on_cpu is 0. It is 1 in shaders for software drivers, and in the host's
 * where it makes the pipeline so. */
#ifndef SDFGI_ON_CPU_GLSL
#define SDFGI_ON_CPU_GLSL

#ifdef SDFGI_SOFTWARE
const uint on_cpu = 1u;
#else
layout(constant_id = 0) const uint on_cpu = 0u;
#endif

/* A condition that never holds. Shaders of draws define it before they include this. */
#ifndef SDFGI_NEVER
#define SDFGI_NEVER (gl_NumWorkGroups.x == 0u)
#endif

/* Index of the only element. */
#define SDFGI_ZERO (on_cpu & uint(SDFGI_NEVER))

#endif

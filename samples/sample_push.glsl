/* SPDX-License-Identifier: MIT
 * struct sample_push */
layout(push_constant) uniform push_block
{
    mat4 matrix;
    vec4 base_color, glow;
};

/* SPDX-License-Identifier: MIT
 * Nothing, compiled at once: for tests that make many pipelines and run none. */
#version 460

layout(local_size_x = 1) in;

void main()
{
}

/* SPDX-License-Identifier: MIT
 * Octahedral maps (Meyer et al. 2010, "On floating-point normal vectors") with +Y at the centre. In maps of
 * odd size, up is then a texel centre, and light from the sky on level ground needs no interpolation. */
#ifndef SDFGI_OCTAHEDRAL_GLSL
#define SDFGI_OCTAHEDRAL_GLSL

vec2 sdfgi_octahedral_sign(vec2 v)
{
    return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

/* Unit direction to [-1, 1]^2. */
vec2 sdfgi_octahedral_encode(vec3 dir)
{
    const vec3 d = dir / (abs(dir.x) + abs(dir.y) + abs(dir.z));
    return d.y >= 0.0 ? d.xz : (1.0 - abs(d.zx)) * sdfgi_octahedral_sign(d.xz);
}

/* [-1, 1]^2 to the point of the octahedron |x| + |y| + |z| = 1. */
vec3 sdfgi_octahedral_point(vec2 uv)
{
    const vec3 d = vec3(uv.x, 1.0 - abs(uv.x) - abs(uv.y), uv.y);
    if (d.y >= 0.0)
        return d;
    const vec2 folded = (1.0 - abs(d.zx)) * sdfgi_octahedral_sign(d.xz);
    return vec3(folded.x, d.y, folded.y);
}

vec3 sdfgi_octahedral_decode(vec2 uv)
{
    return normalize(sdfgi_octahedral_point(uv));
}

/* Solid angle per unit of map area at `point`, up to a constant: 1 / r^3. */
float sdfgi_octahedral_solid_angle(vec3 point)
{
    const float r2 = dot(point, point);
    return 1.0 / (r2 * sqrt(r2));
}

/* The texel of an n x n map that has the value of the border texel `coord` in [-1, n]. Beyond an edge the map
 * continues mirrored along that edge; beyond a corner it continues at the opposite corner. */
ivec2 sdfgi_octahedral_border_source(ivec2 coord, int n)
{
    const bool outside_x = coord.x < 0 || coord.x >= n;
    const bool outside_y = coord.y < 0 || coord.y >= n;
    const ivec2 inside = clamp(coord, ivec2(0), ivec2(n - 1));
    if (outside_x && outside_y)
        return ivec2(n - 1) - inside;
    if (outside_x)
        return ivec2(inside.x, n - 1 - inside.y);
    if (outside_y)
        return ivec2(n - 1 - inside.x, inside.y);
    return inside;
}

#endif

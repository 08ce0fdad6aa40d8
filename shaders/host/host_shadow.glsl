/* SPDX-License-Identifier: MIT
 * Shadow map lookups. Every texel of the filter is compared at its own centre with the plane of the receiver,
 * so a flat surface never shadows itself and the bias can stay below a texel: walls of 5 cm cast shadows to
 * their foot. Depths grow towards the light. Needs host_frame.glsl. */

struct shadow_plane {
    vec2 texel;  /* where the receiver is, in texels */
    float depth; /* of the receiver */
    vec2 slope;  /* depth per texel along the map's axes */
    float bias;  /* depth */
};

/* Where facets meet in a hollow, the neighbour rises above the receiver's plane and would shade it along the
 * edge; an offset along the normal covers that. Fine maps see walls and ceilings, and keep it so small that
 * their corners stay closed (two_rooms_dark gets 2e-5 of the light with the coarse one); coarse ones see
 * terrain, whose bends need more (the sample world's hills showed lines with the fine one). */
float shadow_bias_m(float texel_m, float cosine)
{
    const float fine = 0.1, coarse = 0.7 / max(cosine, 0.1);
    return texel_m * mix(fine, coarse, smoothstep(0.015, 0.035, texel_m));
}

/* Steeper slopes belong to receivers that the light grazes: they get next to nothing of it. */
const float SHADOW_MAX_SLOPE = 16.0;

/* What is nearer to the light than this, `offset` texels from the receiver, shades it. */
float shadow_receiver_depth(shadow_plane p, vec2 offset)
{
    return p.depth + dot(p.slope, offset) + p.bias;
}

/* Share of a 4x4 tent around the receiver that is lit. */
float shadow_tent(sampler2DArray map, int layer, shadow_plane p)
{
    const ivec2 size = textureSize(map, 0).xy;
    const vec2 base = floor(p.texel - 0.5);
    const vec2 f = p.texel - 0.5 - base;
    /* A box of 3x3 bilinear lookups: weights (1 - f, 1, 1, f) / 3 along each axis. */
    const vec4 weight_x = vec4(1.0 - f.x, 1.0, 1.0, f.x), weight_y = vec4(1.0 - f.y, 1.0, 1.0, f.y);
    float lit = 0.0;
    for (int y = 0; y < 4; y++) {
        for (int x = 0; x < 4; x++) {
            const ivec2 texel = clamp(ivec2(base) + ivec2(x - 1, y - 1), ivec2(0), size - 1);
            const float stored = texelFetch(map, ivec3(texel, layer), 0).r;
            const float here = shadow_receiver_depth(p, base + vec2(x, y) - 0.5 - p.texel);
            lit += stored <= here ? weight_x[x] * weight_y[y] : 0.0;
        }
    }
    return lit / 9.0;
}

/* Share of wider disc of `radius` texels, for suns that have a size. */
float shadow_disc(sampler2DArray map, int layer, shadow_plane p, float radius)
{
    const ivec2 size = textureSize(map, 0).xy;
    const int count = 24;
    float lit = 0.0;
    for (int i = 0; i < count; i++) {
        /* Vogel's spiral, turned by the receiver's place so that the steps dissolve. */
        const float turn =
            2.39996323 * float(i) + 6.2831853 * fract(dot(p.texel, vec2(0.7548777, 0.5698403)));
        const vec2 at = p.texel + radius * sqrt((float(i) + 0.5) / float(count)) * vec2(cos(turn), sin(turn));
        const ivec2 texel = clamp(ivec2(floor(at)), ivec2(0), size - 1);
        const float here = shadow_receiver_depth(p, vec2(texel) + 0.5 - p.texel);
        lit += texelFetch(map, ivec3(texel, layer), 0).r <= here ? 1.0 : 0.0;
    }
    return lit / float(count);
}

/* Mean distance, in units of depth, from the receiver to what shades it; 0 where nothing does. */
float shadow_blocker_distance(sampler2DArray map, int layer, shadow_plane p, float radius)
{
    const ivec2 size = textureSize(map, 0).xy;
    float sum = 0.0, count = 0.0;
    for (int i = 0; i < 9; i++) {
        const vec2 at = p.texel + radius * (vec2(i % 3, i / 3) - 1.0);
        const ivec2 texel = clamp(ivec2(floor(at)), ivec2(0), size - 1);
        const float here = shadow_receiver_depth(p, vec2(texel) + 0.5 - p.texel);
        const float above = texelFetch(map, ivec3(texel, layer), 0).r - here;
        if (above > 0.0) {
            sum += above;
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

/* Depth per texel of the plane with this normal, from its derivatives along three axes: n = (x, y, towards
 * light). */
vec2 shadow_slope(vec3 n)
{
    return clamp(-n.xy / max(n.z, 1e-4), -SHADOW_MAX_SLOPE, SHADOW_MAX_SLOPE);
}

float shadow_sun(int sun, vec3 position, vec3 normal)
{
    const int map_size = textureSize(sun_map, 0).x;
    for (int c = 0; c < HOST_CASCADES; c++) {
        const vec4 p = vec4(position, 1.0);
        const vec4 rx = frame.suns[sun].rows[3 * c], ry = frame.suns[sun].rows[3 * c + 1];
        const vec4 rz = frame.suns[sun].rows[3 * c + 2];
        const vec2 ndc = vec2(dot(rx, p), dot(ry, p));
        const float margin = 1.0 - 6.0 / float(map_size);
        if (max(abs(ndc.x), abs(ndc.y)) > margin)
            continue;
        const float texel_m = frame.suns[sun].scale[c].x, range_m = frame.suns[sun].scale[c].y;
        /* The rows are scaled axes of the light's space; their directions give the normal there. */
        const vec3 n = vec3(dot(normalize(rx.xyz), normal), dot(normalize(ry.xyz), normal),
                            dot(frame.suns[sun].direction.xyz, normal));
        shadow_plane plane;
        plane.texel = (ndc * 0.5 + 0.5) * float(map_size);
        plane.depth = dot(rz, p);
        plane.slope = shadow_slope(n) * (texel_m / range_m);
        plane.bias = shadow_bias_m(texel_m, n.z) / range_m + 1e-6;
        const float disc = frame.suns[sun].direction.w;
        if (disc == 0.0)
            return shadow_tent(sun_map, 4 * sun + c, plane);
        const float search = clamp(disc * 0.1 * range_m / texel_m, 2.0, 24.0);
        const float above_m = range_m * shadow_blocker_distance(sun_map, 4 * sun + c, plane, search);
        const float radius = above_m * disc / texel_m;
        return radius < 2.0 ? shadow_tent(sun_map, 4 * sun + c, plane)
                            : shadow_disc(sun_map, 4 * sun + c, plane, min(radius, 64.0));
    }
    return 1.0;
}

/* 1 where a sun reaches a point in the air, else 0. */
float shadow_sun_in_air(int sun, vec3 position)
{
    const int map_size = textureSize(sun_map, 0).x;
    for (int c = 0; c < HOST_CASCADES; c++) {
        const vec4 p = vec4(position, 1.0);
        const vec2 ndc = vec2(dot(frame.suns[sun].rows[3 * c], p), dot(frame.suns[sun].rows[3 * c + 1], p));
        if (max(abs(ndc.x), abs(ndc.y)) > 1.0)
            continue;
        const ivec2 texel = clamp(ivec2((ndc * 0.5 + 0.5) * float(map_size)), ivec2(0), ivec2(map_size - 1));
        const float stored = texelFetch(sun_map, ivec3(texel, 4 * sun + c), 0).r;
        return stored <= dot(frame.suns[sun].rows[3 * c + 2], p) ? 1.0 : 0.0;
    }
    return 1.0;
}

int shadow_cube_face(vec3 d)
{
    const vec3 a = abs(d);
    if (a.x >= a.y && a.x >= a.z)
        return d.x > 0.0 ? 0 : 1;
    if (a.y >= a.z)
        return d.y > 0.0 ? 2 : 3;
    return d.z > 0.0 ? 4 : 5;
}

/* `d` leads from the light to the receiver. Stored depth is near / z, so a plane n.d = h has the depth
 * near * dot(n, (x, y, 1)) / h at the tangents (x, y): linear, as the filter needs it. */
float shadow_punctual(host_light_data light, vec3 d, vec3 normal)
{
    if (light.intensity.w < 0.0)
        return 1.0;
    const int layer = int(light.intensity.w) + (light.direction.w > 0.5 ? shadow_cube_face(d) : 0);
    const host_layer_data face = layers[layer];
    const float map_size = float(textureSize(punctual_map, 0).x);
    const float z = dot(face.forward.xyz, d);
    if (z <= 0.0)
        return 1.0;
    const vec3 axis_x = normalize(face.right.xyz), axis_y = normalize(face.up.xyz);
    const vec3 n = vec3(dot(axis_x, normal), dot(axis_y, normal), dot(face.forward.xyz, normal));
    const float height = min(dot(normal, d), -1e-4 * z);
    shadow_plane plane;
    plane.texel = (vec2(dot(face.right.xyz, d), dot(face.up.xyz, d)) / z * 0.5 + 0.5) * map_size;
    plane.depth = face.right.w / z;
    const float limit = SHADOW_MAX_SLOPE * plane.depth;
    plane.slope = face.up.w * clamp(face.right.w * n.xy / height, vec2(-limit), vec2(limit));
    plane.bias = plane.depth * (shadow_bias_m(face.up.w * z, -dot(normal, normalize(d))) / z + 1e-6);
    return shadow_tent(punctual_map, layer, plane);
}

/* 1 where a lamp reaches a point in the air, else 0. `d` leads from the lamp to it. */
float shadow_punctual_in_air(host_light_data light, vec3 d)
{
    if (light.intensity.w < 0.0)
        return 1.0;
    const int layer = int(light.intensity.w) + (light.direction.w > 0.5 ? shadow_cube_face(d) : 0);
    const host_layer_data face = layers[layer];
    const int map_size = textureSize(punctual_map, 0).x;
    const float z = dot(face.forward.xyz, d);
    if (z <= 0.0)
        return 1.0;
    const vec2 at = vec2(dot(face.right.xyz, d), dot(face.up.xyz, d)) / z * 0.5 + 0.5;
    const ivec2 texel = clamp(ivec2(at * float(map_size)), ivec2(0), ivec2(map_size - 1));
    return texelFetch(punctual_map, ivec3(texel, layer), 0).r <= face.right.w / z ? 1.0 : 0.0;
}

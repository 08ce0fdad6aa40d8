/* SPDX-License-Identifier: MIT
 * Where froxels are, and how much fog is between two places. Columns of froxels stand at the corners of tiles
 * of the picture, so that every pixel is between four of them. Slices cut them along the camera's axis and
 * grow with the distance: the first begins at the camera, and the far sides of all are a constant factor
 * apart. A position in the grid is (column, row, slice): whole columns and rows are corners of tiles, whole
 * slices are near sides. Needs host_frame.glsl. */

/* Metres. Nothing is farther off than the sky. */
const float FOG_SKY_M = 1e9;
/* The most that a half float holds. */
const float FOG_MAX_STORED = 65504.0;

/* Metres along the camera's axis. */
float fog_distance(float slice)
{
    return slice <= 0.0 ? 0.0 : frame.fog_slices.x * exp2((slice - 1.0) * frame.fog_slices.y);
}

/* The inverse, from the first slice's far side on. */
float fog_slice(float distance_m)
{
    return 1.0 + log2(distance_m / frame.fog_slices.x) / frame.fog_slices.y;
}

/* Columns along the picture's width and height: one for each corner of a tile. */
ivec2 fog_columns()
{
    const int side = int(frame.fog_grid.z);
    return (ivec2(frame.fog_grid.xy) + side - 1) / side + 1;
}

vec2 fog_ndc(vec2 column)
{
    return 2.0 * column * frame.fog_grid.z / frame.fog_grid.xy - 1.0;
}

/* Along a column, 1 m along the camera's axis. */
vec3 fog_ray(vec2 column)
{
    return camera_ray(fog_ndc(column));
}

/* In a column, so many metres along the camera's axis. */
vec3 fog_position(vec2 column, float distance_m)
{
    return camera_ray_start(fog_ndc(column)) + distance_m * fog_ray(column);
}

/* Optical depth between two places. Density changes exponentially with height: (1 - exp(-x)) / x of its value
 * at the lower end is the mean. Exponents are bounded so that nothing overflows. */
float fog_optical_depth(vec3 from, vec3 to)
{
    const float low = min(from.y, to.y) - frame.fog_density.y, falloff = frame.fog_density.z;
    const float densest = frame.fog_density.x * exp(clamp(-falloff * low, -60.0, 40.0));
    const float x = falloff * abs(to.y - from.y);
    const float mean = x < 1e-3 ? 1.0 - 0.5 * x : (1.0 - exp(-min(x, 60.0))) / x;
    return densest * mean * length(to - from);
}

/* Henyey and Greenstein's phase function, 1/sr: of the cosine between the ways on which light comes and goes.
 */
float fog_phase(float cosine)
{
    const float g = frame.fog_medium.w, base = max(1.0 + g * g - 2.0 * g * cosine, 1e-4);
    return (1.0 - g * g) / (12.5663706 * base * sqrt(base));
}

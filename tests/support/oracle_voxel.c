/* SPDX-License-Identifier: MIT */
#include "oracle_voxel.h"

#include <math.h>
#include <stdlib.h>

/* A triangle in grid units; false if it cannot be used. */
static bool triangle_load(const struct oracle_grid *grid, const struct test_mesh *mesh, uint32_t triangle,
                          double v[static 3][3])
{
    for (int corner = 0; corner < 3; corner++) {
        const uint32_t index = mesh->indices[3 * (size_t)triangle + corner];
        if (index >= mesh->vertex_count)
            return false;
        for (int k = 0; k < 3; k++) {
            v[corner][k] = ((double)mesh->positions[3 * (size_t)index + k] - grid->origin[k]) / grid->step[k];
            if (!isfinite(v[corner][k]))
                return false;
        }
    }
    return true;
}

static double min3(double a, double b, double c)
{
    return fmin(a, fmin(b, c));
}

static double max3(double a, double b, double c)
{
    return fmax(a, fmax(b, c));
}

/* Integers from ceil(low) to floor(high) that lie in the grid; empty if first > last. */
static void grid_range(uint32_t size, double low, double high, int *first, int *last)
{
    *first = (int)fmin(fmax(ceil(low), 0), size);
    *last = (int)fmax(fmin(floor(high), (double)size - 1), -1);
}

static void bits_set_swizzled(struct oracle_bits *bits, int axis, int w, int a, int b)
{
    uint32_t coord[3];
    coord[axis] = (uint32_t)w;
    coord[(axis + 1) % 3] = (uint32_t)a;
    coord[(axis + 2) % 3] = (uint32_t)b;
    oracle_bits_set(bits, coord[0], coord[1], coord[2]);
}

/* One triangle seen along one axis: a and b span the plane, w is the depth. */
struct view {
    int axis;
    double a[3], b[3], w[3]; /* per corner */
    double area2;            /* twice the signed area of the projection */
};

static struct view view_create(const double v[static 3][3], int axis)
{
    struct view view = { .axis = axis };
    for (int corner = 0; corner < 3; corner++) {
        view.w[corner] = v[corner][axis];
        view.a[corner] = v[corner][(axis + 1) % 3];
        view.b[corner] = v[corner][(axis + 2) % 3];
    }
    view.area2 =
        (view.a[1] - view.a[0]) * (view.b[2] - view.b[0]) - (view.b[1] - view.b[0]) * (view.a[2] - view.a[0]);
    return view;
}

/* Side of the point on the directed edge i -> j: positive to the left. Computed from the same end whichever
 * way the edge is walked, so that two triangles that share an edge can never both miss a point on it. */
static double view_edge(const struct view *view, int i, int j, double a, double b)
{
    const bool swap = view->a[i] > view->a[j] || (view->a[i] == view->a[j] && view->b[i] > view->b[j]);
    const int p = swap ? j : i, q = swap ? i : j;
    const double side =
        (view->a[q] - view->a[p]) * (b - view->b[p]) - (view->b[q] - view->b[p]) * (a - view->a[p]);
    return swap ? -side : side;
}

/* Sets the voxels of column (a, b) whose segment, shortened by `shrink` at both ends, meets [low, high]. */
static void column_set(struct oracle_bits *bits, int axis, int a, int b, double low, double high,
                       double shrink)
{
    int first, last;
    grid_range(bits->size, low - 1 + shrink, high - shrink, &first, &last);
    for (int w = first; w <= last; w++)
        bits_set_swizzled(bits, axis, w, a, b);
}

static void view_column(struct oracle_bits *bits, const struct view *view, const double length[static 3],
                        int a, int b, double shrink)
{
    const double sign = view->area2 > 0 ? 1 : -1;
    double side[3];
    for (int i = 0; i < 3; i++) {
        side[i] = sign * view_edge(view, (i + 1) % 3, (i + 2) % 3, a + 0.5, b + 0.5);
        if (side[i] < shrink * length[i])
            return;
    }
    const double *w = view->w;
    const double depth = w[0] + (side[1] * (w[1] - w[0]) + side[2] * (w[2] - w[0])) / fabs(view->area2);
    const double clamped = fmin(fmax(depth, min3(w[0], w[1], w[2])), max3(w[0], w[1], w[2]));
    column_set(bits, view->axis, a, b, clamped, clamped, shrink);
}

/* A triangle that projects to an area: at most one crossing per column. */
static void view_set(struct oracle_bits *bits, const struct view *view, double shrink)
{
    double length[3];
    for (int i = 0; i < 3; i++)
        length[i] =
            hypot(view->a[(i + 2) % 3] - view->a[(i + 1) % 3], view->b[(i + 2) % 3] - view->b[(i + 1) % 3]);
    int a_first, a_last, b_first, b_last;
    grid_range(bits->size, min3(view->a[0], view->a[1], view->a[2]) - 0.5,
               max3(view->a[0], view->a[1], view->a[2]) - 0.5, &a_first, &a_last);
    grid_range(bits->size, min3(view->b[0], view->b[1], view->b[2]) - 0.5,
               max3(view->b[0], view->b[1], view->b[2]) - 0.5, &b_first, &b_last);
    for (int b = b_first; b <= b_last; b++)
        for (int a = a_first; a <= a_last; a++)
            view_column(bits, view, length, a, b, shrink);
}

/* Depths at which the line over (a, b) runs inside an edge of a triangle seen exactly edge-on. */
static void edge_on_extend(const struct view *view, int i, int j, double a, double b, double range[static 2])
{
    const bool along_a = fabs(view->a[j] - view->a[i]) >= fabs(view->b[j] - view->b[i]);
    const double from = along_a ? view->a[i] : view->b[i], to = along_a ? view->a[j] : view->b[j];
    const double at = along_a ? a : b;
    if (at < fmin(from, to) || at > fmax(from, to) || view_edge(view, i, j, a, b) != 0)
        return;
    /* The far end of an upright edge (from == to) is the end of another edge, which adds it. */
    const double depth =
        from == to ? view->w[i] : view->w[i] + (at - from) * (view->w[j] - view->w[i]) / (to - from);
    range[0] = fmin(range[0], depth);
    range[1] = fmax(range[1], depth);
}

/* A triangle that projects to a line or a point: whole stretches of a column can lie in it. An edge that
 * projects to a point passes the test of its line for every (a, b), so the point itself is compared. */
static void view_set_edge_on(struct oracle_bits *bits, const struct view *view)
{
    int a_first, a_last, b_first, b_last;
    grid_range(bits->size, min3(view->a[0], view->a[1], view->a[2]) - 0.5,
               max3(view->a[0], view->a[1], view->a[2]) - 0.5, &a_first, &a_last);
    grid_range(bits->size, min3(view->b[0], view->b[1], view->b[2]) - 0.5,
               max3(view->b[0], view->b[1], view->b[2]) - 0.5, &b_first, &b_last);
    for (int b = b_first; b <= b_last; b++) {
        for (int a = a_first; a <= a_last; a++) {
            double range[2] = { INFINITY, -INFINITY };
            for (int i = 0; i < 3; i++) {
                const int j = (i + 1) % 3;
                const bool point = view->a[i] == view->a[j] && view->b[i] == view->b[j];
                if (!point || (view->a[i] == a + 0.5 && view->b[i] == b + 0.5))
                    edge_on_extend(view, i, j, a + 0.5, b + 0.5, range);
            }
            if (range[0] <= range[1])
                column_set(bits, view->axis, a, b, range[0], range[1], 0);
        }
    }
}

void oracle_voxel_separating(struct oracle_bits *bits, const struct oracle_grid *grid,
                             const struct test_mesh *mesh, double shrink)
{
    double v[3][3];
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        if (!triangle_load(grid, mesh, i, v))
            continue;
        for (int axis = 0; axis < 3; axis++) {
            const struct view view = view_create((const double(*)[3])v, axis);
            if (view.area2 != 0)
                view_set(bits, &view, shrink);
            else if (shrink == 0)
                view_set_edge_on(bits, &view);
        }
    }
}

/* ---- Insets ---- */

static void add_triangle(struct test_mesh *mesh, const struct oracle_grid *grid, const double *a,
                         const double *b, const double *c)
{
    const double *corners[3] = { a, b, c };
    for (int corner = 0; corner < 3; corner++) {
        mesh->indices[mesh->vertex_count] = mesh->vertex_count;
        for (int k = 0; k < 3; k++)
            mesh->positions[3 * (size_t)mesh->vertex_count + (size_t)k] =
                (float)(grid->origin[k] + corners[corner][k] * grid->step[k]);
        mesh->vertex_count++;
    }
    mesh->triangle_count++;
}

/* The triangle moved by half a voxel along `axis`, against its normal. */
static void add_inset(struct test_mesh *to, const struct oracle_grid *grid, const double v[static 3][3],
                      const double normal[static 3], int axis, bool skirts)
{
    double moved[3][3];
    for (int corner = 0; corner < 3; corner++)
        for (int k = 0; k < 3; k++)
            moved[corner][k] = v[corner][k] - (k == axis ? copysign(0.5, normal[k]) : 0);
    add_triangle(to, grid, moved[0], moved[1], moved[2]);
    for (int i = 0; skirts && i < 3; i++) {
        const int j = (i + 1) % 3;
        add_triangle(to, grid, v[i], v[j], moved[j]);
        add_triangle(to, grid, v[i], moved[j], moved[i]);
    }
}

static void inset_triangle(struct test_mesh *to, const struct oracle_grid *grid, const double v[static 3][3],
                           double tolerance)
{
    double normal[3], largest = 0;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        normal[k] = (v[1][a] - v[0][a]) * (v[2][b] - v[0][b]) - (v[1][b] - v[0][b]) * (v[2][a] - v[0][a]);
        largest = fmax(largest, fabs(normal[k]));
    }
    for (int axis = 0; axis < 3 && largest > 0; axis++) {
        const double others = fmax(fabs(normal[(axis + 1) % 3]), fabs(normal[(axis + 2) % 3]));
        if (fabs(normal[axis]) * (1 + tolerance) >= others)
            add_inset(to, grid, v, normal, axis,
                      others * (1 + tolerance) > ORACLE_FLAT_SLOPE * fabs(normal[axis]));
    }
}

struct test_mesh oracle_voxel_inset(const struct oracle_grid *grid, const struct test_mesh *mesh,
                                    double tolerance)
{
    /* A triangle and six of its skirts, along up to three axes. */
    const size_t triangles = (size_t)mesh->triangle_count * 3 * 7;
    struct test_mesh to = { .positions = calloc(triangles * 9, sizeof *to.positions),
                            .indices = calloc(triangles * 3, sizeof *to.indices) };
    double v[3][3];
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        if (triangle_load(grid, mesh, i, v))
            inset_triangle(&to, grid, (const double(*)[3])v, tolerance);
    return to;
}

/* ---- Touching: separating axes (Akenine-Moller 2001), with closed intervals throughout ---- */

static void cross(const double a[static 3], const double b[static 3], double product[static 3])
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[static 3], const double b[static 3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* v is the triangle relative to the box's centre. */
static bool axis_separates(const double v[static 3][3], const double half_extent[static 3],
                           const double axis[static 3])
{
    const double p[3] = { dot(v[0], axis), dot(v[1], axis), dot(v[2], axis) };
    const double reach =
        half_extent[0] * fabs(axis[0]) + half_extent[1] * fabs(axis[1]) + half_extent[2] * fabs(axis[2]);
    return min3(p[0], p[1], p[2]) > reach || max3(p[0], p[1], p[2]) < -reach;
}

bool oracle_triangle_touches_box(const double triangle[static 3][3], const double center[static 3],
                                 const double half_extent[static 3])
{
    static const double unit[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    double v[3][3], edge[3][3], axis[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            v[i][k] = triangle[i][k] - center[k];
            edge[i][k] = triangle[(i + 1) % 3][k] - triangle[i][k];
        }
    const double(*relative)[3] = (const double(*)[3])v;
    cross(edge[0], edge[1], axis);
    if (axis_separates(relative, half_extent, axis))
        return false;
    for (int k = 0; k < 3; k++) {
        if (axis_separates(relative, half_extent, unit[k]))
            return false;
        for (int i = 0; i < 3; i++) {
            cross(edge[i], unit[k], axis);
            if (axis_separates(relative, half_extent, axis))
                return false;
        }
    }
    return true;
}

/* Depth range of the triangle's plane over a square column, cut to the triangle's own range. */
static void column_depths(const double v[static 3][3], const double normal[static 3], int axis, double a,
                          double b, double half, double range[static 2])
{
    const int ka = (axis + 1) % 3, kb = (axis + 2) % 3;
    range[0] = min3(v[0][axis], v[1][axis], v[2][axis]);
    range[1] = max3(v[0][axis], v[1][axis], v[2][axis]);
    if (normal[axis] == 0)
        return;
    const double slope_a = -normal[ka] / normal[axis], slope_b = -normal[kb] / normal[axis];
    const double middle = v[0][axis] + slope_a * (a - v[0][ka]) + slope_b * (b - v[0][kb]);
    const double slack = (fabs(slope_a) + fabs(slope_b)) * half + 1e-6;
    range[0] = fmax(range[0], middle - slack);
    range[1] = fmin(range[1], middle + slack);
}

static int dominant_axis(const double normal[static 3])
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(normal[k]) > fabs(normal[axis]))
            axis = k;
    return axis;
}

static void column_touch(struct oracle_bits *bits, const double v[static 3][3], const double normal[static 3],
                         int axis, int a, int b, double half)
{
    const double half_extent[3] = { half, half, half };
    double range[2];
    int first, last;
    column_depths(v, normal, axis, a + 0.5, b + 0.5, half, range);
    grid_range(bits->size, range[0] - 0.5 - half, range[1] - 0.5 + half, &first, &last);
    for (int w = first; w <= last; w++) {
        double center[3];
        center[axis] = w + 0.5;
        center[(axis + 1) % 3] = a + 0.5;
        center[(axis + 2) % 3] = b + 0.5;
        if (oracle_triangle_touches_box(v, center, half_extent))
            bits_set_swizzled(bits, axis, w, a, b);
    }
}

static void triangle_touch(struct oracle_bits *bits, const double v[static 3][3], double half)
{
    double normal[3];
    const double u[3] = { v[1][0] - v[0][0], v[1][1] - v[0][1], v[1][2] - v[0][2] };
    const double t[3] = { v[2][0] - v[0][0], v[2][1] - v[0][1], v[2][2] - v[0][2] };
    cross(u, t, normal);
    const int axis = dominant_axis(normal), ka = (axis + 1) % 3, kb = (axis + 2) % 3;
    int a_first, a_last, b_first, b_last;
    grid_range(bits->size, min3(v[0][ka], v[1][ka], v[2][ka]) - 0.5 - half,
               max3(v[0][ka], v[1][ka], v[2][ka]) - 0.5 + half, &a_first, &a_last);
    grid_range(bits->size, min3(v[0][kb], v[1][kb], v[2][kb]) - 0.5 - half,
               max3(v[0][kb], v[1][kb], v[2][kb]) - 0.5 + half, &b_first, &b_last);
    for (int b = b_first; b <= b_last; b++)
        for (int a = a_first; a <= a_last; a++)
            column_touch(bits, v, normal, axis, a, b, half);
}

void oracle_voxel_touched(struct oracle_bits *bits, const struct oracle_grid *grid,
                          const struct test_mesh *mesh, double grow)
{
    double v[3][3];
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        if (triangle_load(grid, mesh, i, v))
            triangle_touch(bits, (const double(*)[3])v, 0.5 + grow);
}

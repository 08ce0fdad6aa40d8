/* SPDX-License-Identifier: MIT */
#include "instance_tree.h"

#include "core/hooks.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

void sdfgi_tree_init(struct instance_tree *tree)
{
    *tree = (struct instance_tree){ .root = TREE_NONE, .free = TREE_NONE };
}

void sdfgi_tree_finish(struct instance_tree *tree, const struct hooks *hooks)
{
    sdfgi_hooks_free(hooks, tree->nodes);
    sdfgi_hooks_free(hooks, tree->parents);
    sdfgi_tree_init(tree);
}

bool sdfgi_tree_reserve(struct instance_tree *tree, const struct hooks *hooks, uint32_t slots)
{
    enum { FIRST_CAPACITY = 64 };
    uint32_t capacity = tree->capacity ? tree->capacity : FIRST_CAPACITY;
    while (capacity < slots)
        capacity *= 2;
    if (capacity == tree->capacity)
        return true;
    struct tree_node *nodes = sdfgi_hooks_alloc(hooks, capacity * sizeof *nodes);
    uint32_t *parents = sdfgi_hooks_alloc(hooks, capacity * sizeof *parents);
    if (!nodes || !parents) {
        sdfgi_hooks_free(hooks, nodes);
        sdfgi_hooks_free(hooks, parents);
        return false;
    }
    if (tree->capacity > 0) {
        memcpy(nodes, tree->nodes, tree->used * sizeof *nodes);
        memcpy(parents, tree->parents, tree->capacity * sizeof *parents);
    }
    sdfgi_hooks_free(hooks, tree->nodes);
    sdfgi_hooks_free(hooks, tree->parents);
    tree->nodes = nodes;
    tree->parents = parents;
    tree->capacity = capacity;
    return true;
}

/* ---- Boxes */

static float rounded_down(double value)
{
    const float nearest = (float)fmin(fmax(value, -FLT_MAX), FLT_MAX);
    return (double)nearest > value ? nextafterf(nearest, -INFINITY) : nearest;
}

static float rounded_up(double value)
{
    const float nearest = (float)fmin(fmax(value, -FLT_MAX), FLT_MAX);
    return (double)nearest < value ? nextafterf(nearest, INFINITY) : nearest;
}

static struct tree_box tree_box_of(const struct box *box)
{
    struct tree_box out;
    for (int i = 0; i < 3; i++) {
        out.min[i] = rounded_down(box->min[i]);
        out.max[i] = rounded_up(box->max[i]);
    }
    return out;
}

static struct tree_box around(const struct tree_box *a, const struct tree_box *b)
{
    struct tree_box box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = a->min[i] < b->min[i] ? a->min[i] : b->min[i];
        box.max[i] = a->max[i] > b->max[i] ? a->max[i] : b->max[i];
    }
    return box;
}

static bool overlaps(const struct tree_box *a, const struct tree_box *b)
{
    return a->min[0] <= b->max[0] && a->max[0] >= b->min[0] && a->min[1] <= b->max[1] &&
           a->max[1] >= b->min[1] && a->min[2] <= b->max[2] && a->max[2] >= b->min[2];
}

/* Half of its surface: how often searches come across a box grows with that (Goldsmith and Salmon 1987,
 * "Automatic creation of object hierarchies for ray tracing"). */
static double half_area(const struct tree_box *b)
{
    const double x = (double)b->max[0] - (double)b->min[0], y = (double)b->max[1] - (double)b->min[1],
                 z = (double)b->max[2] - (double)b->min[2];
    return x * y + y * z + z * x;
}

static double area_around(const struct tree_box *a, const struct tree_box *b)
{
    const struct tree_box both = around(a, b);
    return half_area(&both);
}

/* ---- Links */

static bool is_leaf(uint32_t child)
{
    return child & TREE_LEAF;
}

static uint32_t slot_of(uint32_t leaf)
{
    return leaf & ~TREE_LEAF;
}

static uint32_t height_of(const struct instance_tree *tree, uint32_t child)
{
    return is_leaf(child) ? 0 : tree->nodes[child].height;
}

static void set_parent(struct instance_tree *tree, uint32_t child, uint32_t parent)
{
    if (is_leaf(child))
        tree->parents[slot_of(child)] = parent;
    else
        tree->nodes[child].parent = parent;
}

/* Which child of its parent a child is. */
static int side_of(const struct tree_node *parent, uint32_t child)
{
    return parent->child[1] == child;
}

static void set_child(struct instance_tree *tree, uint32_t parent, int side, uint32_t child,
                      const struct tree_box *box)
{
    tree->nodes[parent].child[side] = child;
    tree->nodes[parent].boxes[side] = *box;
    set_parent(tree, child, parent);
}

/* Puts a child where another one was: below a parent, or at the root. */
static void replace(struct instance_tree *tree, uint32_t parent, uint32_t old, uint32_t child,
                    const struct tree_box *box)
{
    if (parent != TREE_NONE) {
        set_child(tree, parent, side_of(&tree->nodes[parent], old), child, box);
        return;
    }
    tree->root = child;
    tree->whole = *box;
    set_parent(tree, child, TREE_NONE);
}

static struct tree_box box_of_node(const struct instance_tree *tree, uint32_t node)
{
    return around(&tree->nodes[node].boxes[0], &tree->nodes[node].boxes[1]);
}

static void measure(struct instance_tree *tree, uint32_t node)
{
    struct tree_node *n = &tree->nodes[node];
    const uint32_t a = height_of(tree, n->child[0]), b = height_of(tree, n->child[1]);
    n->height = 1 + (a > b ? a : b);
}

/* ---- Balance */

/* Lifts the higher child of a node above it, where it is higher by two: its own higher child stays with it,
 * the other one goes to the node. Returns what stands in the node's place. */
static uint32_t balanced(struct instance_tree *tree, uint32_t node)
{
    struct tree_node *n = &tree->nodes[node];
    const uint32_t heights[2] = { height_of(tree, n->child[0]), height_of(tree, n->child[1]) };
    const int high = heights[1] > heights[0];
    if (heights[high] < heights[!high] + 2)
        return node;
    const uint32_t lifted = n->child[high], parent = n->parent;
    struct tree_node *l = &tree->nodes[lifted];
    const int kept = height_of(tree, l->child[1]) > height_of(tree, l->child[0]);
    const uint32_t given = l->child[!kept];
    const struct tree_box given_box = l->boxes[!kept];
    set_child(tree, node, high, given, &given_box);
    measure(tree, node);
    const struct tree_box node_box = box_of_node(tree, node);
    if (parent == TREE_NONE) {
        tree->root = lifted;
        l->parent = TREE_NONE;
    } else {
        tree->nodes[parent].child[side_of(&tree->nodes[parent], node)] = lifted;
        l->parent = parent;
    }
    set_child(tree, lifted, !kept, node, &node_box);
    measure(tree, lifted);
    return lifted;
}

/* Brings boxes and heights from a node up to the root in order. */
static void mend(struct instance_tree *tree, uint32_t node)
{
    while (node != TREE_NONE) {
        measure(tree, node);
        node = balanced(tree, node);
        const uint32_t parent = tree->nodes[node].parent;
        if (parent == TREE_NONE)
            tree->whole = box_of_node(tree, node);
        else
            tree->nodes[parent].boxes[side_of(&tree->nodes[parent], node)] = box_of_node(tree, node);
        node = parent;
    }
}

/* ---- Changes */

static uint32_t take_node(struct instance_tree *tree)
{
    if (tree->free == TREE_NONE) {
        assert(tree->used < tree->capacity);
        return tree->used++;
    }
    const uint32_t node = tree->free;
    tree->free = tree->nodes[node].parent;
    return node;
}

/* A leaf to stand beside: from the root down to the child whose box grows least. Beside an inner node, which
 * may be cheaper, one rotation on each level would not bring the tree in balance. */
static uint32_t sibling_for(const struct instance_tree *tree, const struct tree_box *box,
                            struct tree_box *sibling_box)
{
    uint32_t at = tree->root;
    *sibling_box = tree->whole;
    while (!is_leaf(at)) {
        const struct tree_node *n = &tree->nodes[at];
        double growth[2];
        for (int i = 0; i < 2; i++)
            growth[i] = area_around(&n->boxes[i], box) - half_area(&n->boxes[i]);
        const int side = growth[1] < growth[0];
        at = n->child[side];
        *sibling_box = n->boxes[side];
    }
    return at;
}

void sdfgi_tree_add(struct instance_tree *tree, uint32_t slot, const struct box *bounds)
{
    assert(slot < tree->capacity);
    const struct tree_box box = tree_box_of(bounds);
    const uint32_t leaf = slot | TREE_LEAF;
    if (tree->root == TREE_NONE) {
        replace(tree, TREE_NONE, TREE_NONE, leaf, &box);
        return;
    }
    struct tree_box sibling_box;
    const uint32_t sibling = sibling_for(tree, &box, &sibling_box), node = take_node(tree),
                   above = tree->parents[slot_of(sibling)];
    const struct tree_box both = around(&sibling_box, &box);
    replace(tree, above, sibling, node, &both);
    set_child(tree, node, 0, sibling, &sibling_box);
    set_child(tree, node, 1, leaf, &box);
    mend(tree, node);
}

void sdfgi_tree_remove(struct instance_tree *tree, uint32_t slot)
{
    const uint32_t leaf = slot | TREE_LEAF, node = tree->parents[slot];
    if (node == TREE_NONE) {
        assert(tree->root == leaf);
        tree->root = TREE_NONE;
        return;
    }
    struct tree_node *n = &tree->nodes[node];
    const int other = !side_of(n, leaf);
    const uint32_t above = n->parent;
    const struct tree_box box = n->boxes[other];
    replace(tree, above, node, n->child[other], &box);
    n->parent = tree->free;
    tree->free = node;
    mend(tree, above);
}

struct box sdfgi_tree_bounds(const struct instance_tree *tree)
{
    struct box bounds = sdfgi_box_nothing();
    for (int i = 0; i < 3 && tree->root != TREE_NONE; i++) {
        bounds.min[i] = (double)tree->whole.min[i];
        bounds.max[i] = (double)tree->whole.max[i];
    }
    return bounds;
}

/* ---- Searches */

void sdfgi_tree_search(struct tree_search *search, const struct instance_tree *tree, const struct box *box)
{
    search->tree = tree;
    search->box = tree_box_of(box);
    search->count = search->visited = 0;
    if (tree->root != TREE_NONE && overlaps(&tree->whole, &search->box))
        search->left[search->count++] = tree->root;
}

bool sdfgi_tree_next(struct tree_search *search, uint32_t *slot)
{
    while (search->count > 0) {
        const uint32_t at = search->left[--search->count];
        if (is_leaf(at)) {
            *slot = slot_of(at);
            return true;
        }
        const struct tree_node *n = &search->tree->nodes[at];
        search->visited++;
        assert(search->count + 2 <= TREE_MOST_HEIGHT);
        for (int i = 0; i < 2; i++) {
            if (!overlaps(&n->boxes[i], &search->box))
                continue;
            search->left[search->count++] = n->child[i];
            if (!is_leaf(n->child[i]))
                __builtin_prefetch(&search->tree->nodes[n->child[i]]);
        }
    }
    return false;
}

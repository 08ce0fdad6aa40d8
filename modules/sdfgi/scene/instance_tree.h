/* SPDX-License-Identifier: MIT
 * Finds the instances whose bounds touch a box: a binary tree of boxes, balanced as an AVL tree is. Adding,
 * moving and removing an instance takes O(log n), a search O(log n) for each instance that it finds.
 *
 * An inner node holds the boxes of its two children, so that a search reads one cache line for each. Boxes
 * are floats, rounded outwards: who searches compares exact bounds afterwards. Leaves are slots of instances.
 */
#ifndef SDFGI_INSTANCE_TREE_H
#define SDFGI_INSTANCE_TREE_H

#include "core/box.h"

struct hooks;

/* A child: the number of an inner node, or a slot with TREE_LEAF set. */
#define TREE_LEAF UINT32_C(0x80000000)
#define TREE_NONE UINT32_C(0xffffffff)

struct tree_box {
    float min[3], max[3];
};

struct tree_node {
    struct tree_box boxes[2];
    uint32_t child[2];
    uint32_t parent; /* TREE_NONE: the root. Of a free node, the next free one */
    uint32_t height; /* above the leaves: at least 1 */
};

struct instance_tree {
    struct tree_node *nodes; /* inner ones */
    uint32_t *parents;       /* of leaves, by slot */
    uint32_t capacity;       /* slots, and nodes */
    uint32_t root;           /* a child, or TREE_NONE */
    uint32_t used, free;     /* nodes ever used; first free one below, or TREE_NONE */
    struct tree_box whole;   /* box of the root */
};

void sdfgi_tree_init(struct instance_tree *tree);
void sdfgi_tree_finish(struct instance_tree *tree, const struct hooks *hooks);
/* Makes room for slots below `slots`. False, and nothing changes, if memory is short. */
bool sdfgi_tree_reserve(struct instance_tree *tree, const struct hooks *hooks, uint32_t slots);
/* Adds a slot that is not in the tree, for which there is room. */
void sdfgi_tree_add(struct instance_tree *tree, uint32_t slot, const struct box *bounds);
void sdfgi_tree_remove(struct instance_tree *tree, uint32_t slot);

/* A box around the bounds of all slots. */
struct box sdfgi_tree_bounds(const struct instance_tree *tree);

enum { TREE_MOST_HEIGHT = 48 }; /* an AVL tree of 2^31 leaves is lower */

/* A search that can be interrupted, as long as the tree stays the same. */
struct tree_search {
    const struct instance_tree *tree;
    struct tree_box box;
    uint32_t left[TREE_MOST_HEIGHT]; /* children to look at */
    uint32_t count;
    uint64_t visited; /* nodes so far */
};

void sdfgi_tree_search(struct tree_search *search, const struct instance_tree *tree, const struct box *box);
/* The next slot that may touch the box; false: there is none. */
bool sdfgi_tree_next(struct tree_search *search, uint32_t *slot);

#endif

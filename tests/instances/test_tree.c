/* SPDX-License-Identifier: MIT
 * The tree of instances finds what a look at each of them finds, however they came and went, and looks at
 * little else. Without a device. */
#include "core/hooks.h"
#include "require.h"
#include "scene/instance_tree.h"
#include "test_memory.h"

#include <stdlib.h>

enum { COUNT = 4000 };

static const struct hooks hooks;
static struct instance_tree tree;
static struct box bounds[COUNT];
static bool is_there[COUNT];
static struct test_random dice;

static struct box box_at(const double at[static 3], double size)
{
    struct box box;
    for (int i = 0; i < 3; i++) {
        box.min[i] = at[i];
        box.max[i] = at[i] + size;
    }
    return box;
}

static struct box random_box(double reach, double most)
{
    double at[3];
    for (int i = 0; i < 3; i++)
        at[i] = test_random_real(&dice, -reach, reach);
    return box_at(at, test_random_real(&dice, 0, most));
}

static void add(uint32_t slot, struct box box)
{
    REQUIRE_TRUE(sdfgi_tree_reserve(&tree, &hooks, slot + 1));
    bounds[slot] = box;
    is_there[slot] = true;
    sdfgi_tree_add(&tree, slot, &bounds[slot]);
}

static void take_away(uint32_t slot)
{
    sdfgi_tree_remove(&tree, slot);
    is_there[slot] = false;
}

static int open_tree(void **state)
{
    (void)state;
    memset(is_there, 0, sizeof is_there);
    dice.state = 1;
    sdfgi_tree_init(&tree);
    return 0;
}

static int close_tree(void **state)
{
    (void)state;
    sdfgi_tree_finish(&tree, &hooks);
    return 0;
}

/* Nodes that a search looked at. Finds each slot that touches the box once. */
static uint64_t require_search(const struct box *box, uint32_t *found)
{
    static bool seen[COUNT];
    struct tree_search search;
    uint32_t slot;
    memset(seen, 0, sizeof seen);
    *found = 0;
    sdfgi_tree_search(&search, &tree, box);
    while (sdfgi_tree_next(&search, &slot)) {
        REQUIRE_TRUE(slot < COUNT && is_there[slot] && !seen[slot]);
        seen[slot] = true;
        ++*found;
    }
    for (uint32_t i = 0; i < COUNT; i++)
        if (is_there[i] && sdfgi_box_overlaps(&bounds[i], box))
            REQUIRE_TRUE(seen[i]);
    return search.visited;
}

/* Rounded outwards to floats, and no farther. */
static void require_bounds(void)
{
    struct box all = sdfgi_box_nothing();
    for (uint32_t i = 0; i < COUNT; i++)
        if (is_there[i])
            all = sdfgi_box_around(&all, &bounds[i]);
    const struct box found = sdfgi_tree_bounds(&tree);
    for (int i = 0; i < 3; i++) {
        REQUIRE_TRUE(found.min[i] <= all.min[i] && found.max[i] >= all.max[i]);
        if (tree.root == TREE_NONE)
            REQUIRE_TRUE(found.min[i] > found.max[i]);
        else
            REQUIRE_TRUE(found.min[i] >= all.min[i] - 1e-5 && found.max[i] <= all.max[i] + 1e-5);
    }
}

static void require_searches(uint32_t count)
{
    uint32_t found;
    require_bounds();
    for (uint32_t i = 0; i < count; i++) {
        const struct box box = random_box(60, 30);
        require_search(&box, &found);
    }
}

/* Fails where the children of a node differ by more than one. */
static uint32_t height_below(uint32_t child)
{
    if (child & TREE_LEAF)
        return 0;
    const struct tree_node *n = &tree.nodes[child];
    const uint32_t a = height_below(n->child[0]), b = height_below(n->child[1]);
    REQUIRE_TRUE(a <= b + 1 && b <= a + 1);
    REQUIRE_CMP(n->height, ==, 1 + (a > b ? a : b));
    return n->height;
}

static void searches_find_what_touches(void **state)
{
    (void)state;
    require_searches(1);
    for (uint32_t i = 0; i < COUNT; i++) {
        add(i, random_box(50, i % 10 == 0 ? 40 : 1));
        if (i < 20)
            require_searches(5);
        if (i % 100 == 0)
            height_below(tree.root);
    }
    require_searches(100);
}

static void what_leaves_is_not_found(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < COUNT; i++)
        add(i, random_box(50, i % 10 == 0 ? 80 : 2));
    for (uint32_t round = 0; round < 20000; round++) {
        const uint32_t slot = test_random_uint(&dice) % COUNT;
        if (is_there[slot])
            take_away(slot);
        else
            add(slot, random_box(50, 2));
        if (round % 500 == 0) {
            require_searches(3);
            height_below(tree.root);
        }
    }
    for (uint32_t i = 0; i < COUNT; i++)
        if (is_there[i])
            take_away(i);
    require_searches(3);
    REQUIRE_TRUE(tree.root == TREE_NONE);
    add(7, random_box(1, 1));
    require_searches(3);
}

/* A row of boxes in order is what makes a tree that is not balanced a list. */
static void a_row_in_order_makes_a_low_tree(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < COUNT; i++)
        add(i, box_at((double[3]){ i, 0, 0 }, 0.5));
    REQUIRE_CMP(height_below(tree.root), <=, 17u); /* 1.44 log2 4000 */
    for (uint32_t i = 0; i < COUNT; i += 3)
        take_away(i);
    REQUIRE_CMP(height_below(tree.root), <=, 17u);
}

/* A grid, and a slab that cuts it: two nodes for each box that is found, and the way there. */
static void a_search_looks_at_little_else(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < COUNT; i++)
        add(i, box_at((double[3]){ i % 64, 0, i / 64 }, 0.5));
    uint32_t found;
    const struct box slab = { { 20, -100, -100 }, { 24.2, 100, 100 } },
                     air = { { 20.6, 0, 0 }, { 20.9, 1, 99 } }, none = { { 200, 0, 0 }, { 300, 1, 1 } };
    uint64_t visited = require_search(&slab, &found);
    REQUIRE_CMP(found, ==, 5u * ((COUNT + 63) / 64));
    REQUIRE_CMP(visited, <=, 3ull * found);
    visited = require_search(&air, &found);
    REQUIRE_CMP(found, ==, 0u);
    REQUIRE_CMP(visited, <=, COUNT / 4ull);
    REQUIRE_CMP(require_search(&none, &found), <=, 1ull);
}

/* Places where floats are coarser than the boxes, and beyond all floats. */
static void far_places_are_found(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 500; i++)
        add(i, box_at((double[3]){ 1e9 + i * 0.25, -1e9, 5e12 }, 0.125));
    for (uint32_t i = 500; i < 520; i++)
        add(i, box_at((double[3]){ i % 2 ? 1e200 : -1e300, 1e39, 0 }, 1e30));
    uint32_t found;
    for (uint32_t i = 0; i < 520; i++) {
        require_search(&bounds[i], &found);
        REQUIRE_CMP(found, >, 0u);
    }
}

static void *no_memory(void *user, size_t size)
{
    (void)user;
    (void)size;
    return NULL;
}

static void free_nothing(void *user, void *memory)
{
    (void)user;
    (void)memory;
}

static void without_memory_the_tree_stays(void **state)
{
    (void)state;
    const struct hooks poor = { .allocator = { no_memory, free_nothing, NULL } };
    for (uint32_t i = 0; i < 64; i++)
        add(i, random_box(50, 2));
    REQUIRE_TRUE(sdfgi_tree_reserve(&tree, &poor, 64));
    REQUIRE_TRUE(!sdfgi_tree_reserve(&tree, &poor, 65));
    require_searches(10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(searches_find_what_touches, open_tree, close_tree),
        cmocka_unit_test_setup_teardown(what_leaves_is_not_found, open_tree, close_tree),
        cmocka_unit_test_setup_teardown(a_row_in_order_makes_a_low_tree, open_tree, close_tree),
        cmocka_unit_test_setup_teardown(a_search_looks_at_little_else, open_tree, close_tree),
        cmocka_unit_test_setup_teardown(far_places_are_found, open_tree, close_tree),
        cmocka_unit_test_setup_teardown(without_memory_the_tree_stays, open_tree, close_tree),
    };
    return cmocka_run_group_tests_name("instance_tree", tests, NULL, NULL);
}

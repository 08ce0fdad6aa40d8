/* SPDX-License-Identifier: MIT
 * Handles: which slots they name, and that none is valid twice. */
#include "unit.h"

#include "core/hooks.h"
#include "core/pool.h"

#include <stdlib.h>

/* With so many slots a handle has 12 bits for the generation. */
enum { MANY = (1 << 20) - 2, GENERATIONS = 1 << 12 };

static const struct hooks hooks;
static struct pool pool;

static uint32_t add(void)
{
    uint32_t id;
    assert_non_null(sdfgi_pool_add(&pool, &hooks, &id));
    assert_int_not_equal(id, 0);
    return id;
}

static int compare(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static void a_stale_handle_is_never_valid_again(void **state)
{
    (void)state;
    enum { COUNT = 5 * GENERATIONS / 2 };
    static uint32_t ids[COUNT];
    sdfgi_pool_init(&pool, 4, MANY);
    for (int i = 0; i < COUNT; i++) {
        ids[i] = add();
        sdfgi_pool_remove(&pool, ids[i]);
        assert_null(sdfgi_pool_get(&pool, ids[0]));
        assert_null(sdfgi_pool_get(&pool, ids[i]));
    }
    qsort(ids, COUNT, sizeof *ids, compare);
    for (int i = 1; i < COUNT; i++)
        assert_int_not_equal(ids[i], ids[i - 1]);
    sdfgi_pool_finish(&pool, &hooks);
}

/* Few slots leave a handle more bits for generations: a light a frame must not use them up within hours. */
static void few_slots_have_many_generations(void **state)
{
    (void)state;
    sdfgi_pool_init(&pool, 4, 3);
    const uint32_t first = add();
    sdfgi_pool_remove(&pool, first);
    for (int i = 0; i < 16 * GENERATIONS; i++) {
        const uint32_t id = add();
        assert_int_equal(sdfgi_pool_index(&pool, id), 0);
        assert_null(sdfgi_pool_get(&pool, first));
        sdfgi_pool_remove(&pool, id);
    }
    sdfgi_pool_finish(&pool, &hooks);
}

static void a_pool_without_handles_is_full(void **state)
{
    (void)state;
    sdfgi_pool_init(&pool, 4, 2);
    const uint32_t used = add(), other = add();
    pool.generations[0] = (1u << 30) - 1;
    sdfgi_pool_remove(&pool, sdfgi_pool_id(&pool, 0));
    uint32_t id;
    assert_null(sdfgi_pool_add(&pool, &hooks, &id));
    assert_null(sdfgi_pool_get(&pool, used));
    sdfgi_pool_remove(&pool, other);
    assert_int_equal(sdfgi_pool_index(&pool, add()), 1);
    assert_null(sdfgi_pool_add(&pool, &hooks, &id));
    sdfgi_pool_finish(&pool, &hooks);
}

static void the_lowest_free_slot_is_taken(void **state)
{
    (void)state;
    uint32_t ids[100];
    sdfgi_pool_init(&pool, 4, MANY);
    for (uint32_t i = 0; i < 100; i++) {
        ids[i] = add();
        assert_int_equal(sdfgi_pool_index(&pool, ids[i]), i);
    }
    static const uint32_t holes[] = { 70, 3, 99, 4 }, filled[] = { 3, 4, 70, 99, 100 };
    for (int i = 0; i < 4; i++)
        sdfgi_pool_remove(&pool, ids[holes[i]]);
    for (int i = 0; i < 5; i++)
        assert_int_equal(sdfgi_pool_index(&pool, add()), filled[i]);
    assert_int_equal(pool.count, 101);
    assert_int_equal(pool.end, 101);
    sdfgi_pool_finish(&pool, &hooks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stale_handle_is_never_valid_again),
        cmocka_unit_test(few_slots_have_many_generations),
        cmocka_unit_test(a_pool_without_handles_is_full),
        cmocka_unit_test(the_lowest_free_slot_is_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT
 *
 * Deferred destruction: what frames in flight may still use is destroyed once they are over, and once. */
#include "unit.h"

#include <gpu.h>

#include <string.h>

enum { ITEMS = 4 };

struct thing {
    struct gpu_retired retired;
    int destroyed;
};

static void destroy(struct gpu_retired *item, void *user)
{
    ((struct thing *)item)->destroyed++;
    ++*(int *)user;
}

static void an_object_outlives_the_frames_in_flight(void **state)
{
    (void)state;
    int count = 0;
    struct thing thing = { .destroyed = 0 };
    struct gpu_retire_queue queue = { .frame = 10, .frames_in_flight = 3 };
    gpu_retire(&queue, &thing.retired, destroy, &count);
    for (queue.frame = 10; queue.frame < 13; queue.frame++) {
        gpu_retire_collect(&queue);
        assert_int_equal(thing.destroyed, 0);
    }
    gpu_retire_collect(&queue);
    gpu_retire_collect(&queue);
    assert_int_equal(thing.destroyed, 1);
    assert_int_equal(count, 1);
}

static void each_object_waits_for_its_own_frames(void **state)
{
    (void)state;
    int count = 0;
    struct thing things[ITEMS];
    memset(things, 0, sizeof things);
    struct gpu_retire_queue queue = { .frames_in_flight = 2 };
    for (int i = 0; i < ITEMS; i++, queue.frame++) {
        gpu_retire(&queue, &things[i].retired, destroy, &count);
        gpu_retire_collect(&queue);
        for (int k = 0; k < ITEMS; k++)
            assert_int_equal(things[k].destroyed, k + 2 <= i);
    }
}

static void everything_goes_at_the_end(void **state)
{
    (void)state;
    int count = 0;
    struct thing things[ITEMS];
    struct gpu_retire_queue queue = { .frames_in_flight = 8 };
    for (int i = 0; i < ITEMS; i++)
        gpu_retire(&queue, &things[i].retired, destroy, &count);
    gpu_retire_all(&queue);
    assert_int_equal(count, ITEMS);
    gpu_retire_all(&queue);
    assert_int_equal(count, ITEMS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_object_outlives_the_frames_in_flight),
        cmocka_unit_test(each_object_waits_for_its_own_frames),
        cmocka_unit_test(everything_goes_at_the_end),
    };
    return cmocka_run_group_tests_name("gpu_retire", tests, NULL, NULL);
}

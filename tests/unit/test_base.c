/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include <base/arena.h>
#include <base/text.h>
#include <base/vec.h>
#include <stdlib.h>
#include <string.h>

/* An allocator that gives a fixed number of blocks and counts those not given back. */
struct counting_heap {
    int left, live;
};

static void *heap_alloc(void *user, size_t size)
{
    struct counting_heap *heap = user;
    if (heap->left-- <= 0)
        return NULL;
    heap->live++;
    return malloc(size);
}

static void heap_free(void *user, void *memory)
{
    ((struct counting_heap *)user)->live--;
    free(memory);
}

static void arena_gives_zeroed_aligned_memory_that_does_not_overlap(void **state)
{
    (void)state;
    struct base_arena arena;
    base_arena_init(&arena, NULL, 64);
    unsigned char *parts[40];
    for (int i = 0; i < 40; i++) {
        parts[i] = base_arena_alloc(&arena, (size_t)i + 1, 3);
        assert_non_null(parts[i]);
        assert_int_equal((uintptr_t)parts[i] % _Alignof(max_align_t), 0);
        for (int k = 0; k < 3 * (i + 1); k++)
            assert_int_equal(parts[i][k], 0);
        memset(parts[i], i + 1, 3 * (size_t)(i + 1));
    }
    for (int i = 0; i < 40; i++)
        for (int k = 0; k < 3 * (i + 1); k++)
            assert_int_equal(parts[i][k], i + 1);
    base_arena_finish(&arena);
}

static void arena_remembers_failure_and_returns_every_block(void **state)
{
    (void)state;
    struct counting_heap heap = { .left = 2 };
    const struct base_allocator allocator = { heap_alloc, heap_free, &heap };
    struct base_arena arena;
    base_arena_init(&arena, &allocator, 16);
    assert_non_null(base_arena_alloc(&arena, 100, 1));
    assert_non_null(base_arena_alloc(&arena, 100, 1));
    assert_null(base_arena_alloc(&arena, 100, 1));
    heap.left = 10;
    assert_null(base_arena_alloc(&arena, 1, 1));
    assert_true(arena.failed);
    base_arena_finish(&arena);
    assert_int_equal(heap.live, 0);
    assert_false(arena.failed);
}

static void arena_refuses_a_size_that_overflows(void **state)
{
    (void)state;
    struct base_arena arena;
    base_arena_init(&arena, NULL, 64);
    assert_null(base_arena_alloc(&arena, SIZE_MAX / 2, 3));
    assert_true(arena.failed);
    base_arena_finish(&arena);
    assert_null(base_arena_alloc(&arena, SIZE_MAX, 1));
    base_arena_finish(&arena);
}

static void a_message_is_one_line_that_fits(void **state)
{
    (void)state;
    char text[16];
    assert_false(base_text_error(text, sizeof text, "%s", "a\nb\tc\x7f"));
    assert_string_equal(text, "a?b?c?");
    base_text_error(text, sizeof text, "%s", "0123456789abcdefgh");
    assert_string_equal(text, "0123456789ab...");
    base_text_error(text, sizeof text, "%s", "0123456789abcde");
    assert_string_equal(text, "0123456789abcde");
    assert_false(base_text_error(NULL, 0, "%s", "nothing"));
}

static void a_number_must_be_plain_finite_and_whole_text(void **state)
{
    (void)state;
    static const char *const wrong[] = { "",    " 1",   "1 ",    "1x",  "0x10", "nan",
                                         "inf", "-inf", "1e999", "--1", "e",    "." };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        double value = 7;
        assert_false(base_text_to_double(wrong[i], &value));
        assert_true(value == 7);
    }
    double value;
    assert_true(base_text_to_double("-2.5e-3", &value));
    assert_true(value == -2.5e-3);
}

static void a_vector_without_direction_is_not_normalised(void **state)
{
    (void)state;
    double zero[3] = { 0 }, wide[3] = { 1e300, 1e300, 0 }, good[3] = { 0, 3, 4 };
    assert_false(base_vec3d_normalize(zero));
    assert_false(base_vec3d_normalize(wide));
    assert_true(base_vec3d_normalize(good));
    assert_true(fabs(good[1] - 0.6) < 1e-15 && fabs(good[2] - 0.8) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arena_gives_zeroed_aligned_memory_that_does_not_overlap),
        cmocka_unit_test(arena_remembers_failure_and_returns_every_block),
        cmocka_unit_test(arena_refuses_a_size_that_overflows),
        cmocka_unit_test(a_message_is_one_line_that_fits),
        cmocka_unit_test(a_number_must_be_plain_finite_and_whole_text),
        cmocka_unit_test(a_vector_without_direction_is_not_normalised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

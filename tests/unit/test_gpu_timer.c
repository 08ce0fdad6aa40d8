/* SPDX-License-Identifier: MIT
 *
 * Timestamps, with a device that counts how often it is asked: spans begin and end at stamps that they share,
 * and a command buffer resets its queries once. */
#include "unit.h"

#include <gpu.h>

#include <string.h>

enum { SLOTS = 2, TICKS = 3 /* from one stamp to the next */, NS_PER_TICK = 10 };

static struct {
    uint32_t resets, stamps;
    bool ready[SLOTS * GPU_TIMER_STAMPS]; /* reset since it was written last */
    uint64_t ticks[SLOTS * GPU_TIMER_STAMPS];
    uint64_t now;
} fake;

static void VKAPI_CALL reset_queries(VkCommandBuffer cmd, VkQueryPool pool, uint32_t first, uint32_t count)
{
    (void)cmd, (void)pool;
    fake.resets++;
    for (uint32_t i = 0; i < count; i++) {
        assert_true(first + i < SLOTS * GPU_TIMER_STAMPS);
        fake.ready[first + i] = true;
    }
}

static void VKAPI_CALL write_timestamp(VkCommandBuffer cmd, VkPipelineStageFlagBits stage, VkQueryPool pool,
                                       uint32_t query)
{
    (void)cmd, (void)stage, (void)pool;
    assert_true(query < SLOTS * GPU_TIMER_STAMPS && fake.ready[query]);
    fake.ready[query] = false;
    fake.stamps++;
    fake.ticks[query] = fake.now += TICKS;
}

static VkResult VKAPI_CALL get_results(VkDevice handle, VkQueryPool pool, uint32_t first, uint32_t count,
                                       size_t size, void *data, VkDeviceSize stride, VkQueryResultFlags flags)
{
    (void)handle, (void)pool, (void)flags;
    assert_int_equal(stride, sizeof(uint64_t));
    assert_true(size >= count * stride);
    for (uint32_t i = 0; i < count; i++)
        ((uint64_t *)data)[i] = fake.ticks[first + i];
    return VK_SUCCESS;
}

static struct gpu_device device;
static struct gpu_timer timer;
static struct gpu_recorder recorder;
static struct gpu_timer_span spans[GPU_TIMER_STAMPS];
static uint32_t tags[SLOTS * GPU_TIMER_STAMPS], counts[SLOTS];

static int setup(void **state)
{
    (void)state;
    memset(&fake, 0, sizeof fake);
    memset(counts, 0, sizeof counts);
    device = (struct gpu_device){ .timestamp_bits = 64, .limits = { .timestampPeriod = NS_PER_TICK } };
    device.fn.CmdResetQueryPool = reset_queries;
    device.fn.CmdWriteTimestamp = write_timestamp;
    device.fn.GetQueryPoolResults = get_results;
    recorder = (struct gpu_recorder){ .device = &device };
    timer = (struct gpu_timer){
        .pool = (VkQueryPool)(uintptr_t)1, .slots = SLOTS, .tags = tags, .counts = counts
    };
    return 0;
}

static uint32_t read_slot(uint32_t slot)
{
    uint32_t count;
    assert_int_equal(gpu_timer_read(&device, &timer, slot, spans, &count), VK_SUCCESS);
    for (uint32_t i = 0; i < count; i++)
        assert_int_equal(spans[i].ns, TICKS * NS_PER_TICK);
    return count;
}

static void spans_share_their_stamps(void **state)
{
    (void)state;
    gpu_timer_begin_frame(&timer, 1);
    gpu_timer_reset(&timer, &recorder, 5);
    gpu_timer_stamp(&timer, &recorder, 7);
    gpu_timer_stamp(&timer, &recorder, 8);
    gpu_timer_stamp(&timer, &recorder, GPU_TIMER_NOTHING);
    gpu_timer_stamp(&timer, &recorder, 9);
    gpu_timer_stamp(&timer, &recorder, GPU_TIMER_NOTHING);
    assert_int_equal(fake.resets, 1);
    assert_int_equal(fake.stamps, 5);
    assert_int_equal(read_slot(0), 0);
    assert_int_equal(read_slot(1), 3);
    for (uint32_t i = 0; i < 3; i++)
        assert_int_equal(spans[i].tag, 7 + i);
}

/* As an update and a gather: what the first has written stays. */
static void a_second_command_buffer_goes_on(void **state)
{
    (void)state;
    gpu_timer_begin_frame(&timer, 0);
    for (uint32_t tag = 0; tag < 2; tag++) {
        gpu_timer_reset(&timer, &recorder, 2);
        gpu_timer_stamp(&timer, &recorder, tag);
        gpu_timer_stamp(&timer, &recorder, GPU_TIMER_NOTHING);
    }
    assert_int_equal(read_slot(0), 2);
    assert_int_equal(spans[1].tag, 1);
    gpu_timer_begin_frame(&timer, 0);
    assert_int_equal(read_slot(0), 0);
}

static void what_does_not_fit_is_not_timed(void **state)
{
    (void)state;
    gpu_timer_begin_frame(&timer, 1);
    for (uint32_t i = 0; i < 2 * GPU_TIMER_STAMPS; i++) {
        gpu_timer_reset(&timer, &recorder, 1);
        gpu_timer_stamp(&timer, &recorder, i);
    }
    assert_int_equal(fake.stamps, GPU_TIMER_STAMPS);
    assert_int_equal(read_slot(1), 0);
}

static void what_has_not_been_reset_is_not_timed(void **state)
{
    (void)state;
    gpu_timer_begin_frame(&timer, 1);
    gpu_timer_stamp(&timer, &recorder, 1);
    gpu_timer_reset(&timer, &recorder, 3);
    for (uint32_t i = 0; i < 5; i++)
        gpu_timer_stamp(&timer, &recorder, i);
    assert_int_equal(fake.stamps, 3);
    assert_int_equal(read_slot(1), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(spans_share_their_stamps, setup),
        cmocka_unit_test_setup(a_second_command_buffer_goes_on, setup),
        cmocka_unit_test_setup(what_does_not_fit_is_not_timed, setup),
        cmocka_unit_test_setup(what_has_not_been_reset_is_not_timed, setup),
    };
    return cmocka_run_group_tests_name("gpu_timer", tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT
 * A host that is switched on, off and on again within a frame waits for all that GI needs all the same.
 * sdfgi_prepare is defined here: it waits until it may make one object. */
#include "unit.h"

#include <host/host_prepare.h>
#include <semaphore.h>
#include <string.h>
#include <time.h>

enum { OBJECTS = 3 };

static struct {
    uint32_t made, calls;
    enum sdfgi_result result;
    sem_t begun, may;
} fake;

enum sdfgi_result sdfgi_prepare(sdfgi *gi, const struct sdfgi_prepare_desc *desc,
                                struct sdfgi_progress *progress)
{
    (void)gi;
    assert_int_equal(desc->max_objects, 1);
    fake.calls++;
    sem_post(&fake.begun);
    sem_wait(&fake.may);
    *progress = (struct sdfgi_progress){ ++fake.made, OBJECTS };
    return fake.result;
}

void sdfgi_get_settings(const sdfgi *gi, struct sdfgi_settings *settings)
{
    (void)gi;
    memset(settings, 0, sizeof *settings);
}

void sdfgi_release_prepared(sdfgi *gi)
{
    (void)gi;
    fake.made = 0;
}

static const struct sdfgi_settings settings = { .enabled = true };

static void wait_until_done(const struct host_prepare *prepare)
{
    while (!prepare->done)
        nanosleep(&(struct timespec){ 0, 100000 }, NULL);
}

/* Lets as many objects be made, after which the host is told that it may switch. */
static void require_ready_after(struct host_prepare *prepare, int objects)
{
    for (int i = 0; i < objects; i++) {
        assert_false(host_prepare_step(prepare, &settings));
        sem_wait(&fake.begun);
        sem_post(&fake.may);
    }
    wait_until_done(prepare);
    assert_true(host_prepare_step(prepare, &settings));
}

static int begin(void **state)
{
    (void)state;
    memset(&fake, 0, sizeof fake);
    return sem_init(&fake.begun, 0, 0) | sem_init(&fake.may, 0, 0);
}

static void it_is_ready_once_all_is_made(void **state)
{
    (void)state;
    struct host_prepare prepare = { 0 };
    require_ready_after(&prepare, OBJECTS);
    assert_int_equal(fake.made, OBJECTS);
}

/* On, off, and on while the thread has just heard of off: it begins again. */
static void a_thread_that_stopped_begins_again(void **state)
{
    (void)state;
    struct host_prepare prepare = { 0 };
    assert_false(host_prepare_step(&prepare, &settings));
    sem_wait(&fake.begun);
    assert_false(host_prepare_stop(&prepare));
    sem_post(&fake.may);
    wait_until_done(&prepare);
    assert_false(host_prepare_step(&prepare, &settings));
    require_ready_after(&prepare, OBJECTS - 1);
    assert_int_equal(fake.made, OBJECTS);
}

/* The switch that follows says why. */
static void what_cannot_be_made_is_ready_too(void **state)
{
    (void)state;
    struct host_prepare prepare = { 0 };
    fake.result = SDFGI_ERROR_OUT_OF_MEMORY;
    require_ready_after(&prepare, 1);
    assert_int_equal(fake.calls, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(it_is_ready_once_all_is_made, begin),
        cmocka_unit_test_setup(a_thread_that_stopped_begins_again, begin),
        cmocka_unit_test_setup(what_cannot_be_made_is_ready_too, begin),
    };
    return cmocka_run_group_tests_name("host_prepare", tests, NULL, NULL);
}

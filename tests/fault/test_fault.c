/* SPDX-License-Identifier: MIT
 * Every call of the program fails once: Vulkan calls run out of memory or lose the device, allocations find
 * none. The program says so in one line, leaves with an error, crashes never, and leaves nothing behind but
 * whole files. By default each function takes its turn in each command, and each place that allocates in the
 * first command that comes by; with SDFGI_TEST_FULL=1 every single call does. Arguments: PROGRAM PRELOADED
 * SCENE PATH GNUPLOT [real]. */
#define _GNU_SOURCE
#include "fault_run.h"
#include "files.h"
#include "require.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { WORKERS = 2, MOST_PROBLEMS_SHOWN = 40, MOST_PLACES = 4096 };

static struct fault_command command;
static char folder[128];
static bool full;

/* ---- What may and what may not be -------------------------------------------------------------------- */

/* Without them the program goes on: pipelines are not kept, what a frame found out comes with the next one,
 * and nothing is left to wait for. */
static bool is_dispensable(const char *kind, const char *name)
{
    static const char *const names[] = { "vkCreatePipelineCache", "vkGetPipelineCacheData",
                                         "vkInvalidateMappedMemoryRanges", "vkDeviceWaitIdle" };
    if (strcmp(name, "vkGetQueryPoolResults") == 0)
        return strcmp(kind, "lost") != 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

/* tinygltf's destructors of JSON allocate, and may not throw. */
static bool is_fault_of_tinygltf(const struct fault_outcome *o)
{
    return o->exit_code < 0 &&
           strstr(o->errors, "terminate called after throwing an instance of 'std::bad_alloc'");
}

static uint32_t line_count(const char *text)
{
    uint32_t count = 0;
    for (; *text; text++)
        count += *text == '\n';
    return count;
}

static bool message_fits(const char *kind, const char *text)
{
    if (strncmp(text, "sdfgi: ", 7) != 0)
        return false;
    if (strcmp(kind, "lost") == 0)
        return strstr(text, "lost");
    return strstr(text, "out of memory") || strstr(text, "Cannot allocate memory") ||
           (strcmp(kind, "device") == 0 ? strstr(text, "out of device memory")
                                        : strstr(text, "out of host memory"));
}

static const struct fault_file *file_named(const struct fault_outcome *outcome, const char *name)
{
    for (uint32_t i = 0; i < outcome->file_count; i++)
        if (strcmp(outcome->files[i].name, name) == 0)
            return &outcome->files[i];
    return NULL;
}

/* Whole files stay, each as it is when nothing fails; reports have times in them. */
static bool file_is_whole(const struct fault_file *file, const struct fault_outcome *good)
{
    const struct fault_file *like = file_named(good, file->name);
    const bool varies = strstr(file->name, ".json");
    const size_t end = sizeof file->tail - 2;
    return like &&
           (varies ? memcmp(like->tail + end, file->tail + end, 2) == 0
                   : like->size == file->size && memcmp(like->tail, file->tail, sizeof file->tail) == 0);
}

/* Not one that was there when nothing failed either. */
static const char *new_leak(const struct fault_outcome *outcome, const struct fault_outcome *good)
{
    for (uint32_t i = 0; i < outcome->leak_count; i++) {
        bool known = false;
        for (uint32_t k = 0; k < good->leak_count && !known; k++)
            known = strcmp(outcome->leaks[i], good->leaks[k]) == 0;
        if (!known)
            return outcome->leaks[i];
    }
    return NULL;
}

/* Says what is wrong with a run; NULL if nothing is. */
static const char *problem_of(const char *kind, const struct fault_outcome *o,
                              const struct fault_outcome *good)
{
    const bool tolerated = o->exit_code == 0;
    if (is_fault_of_tinygltf(o))
        return NULL;
    if (o->exit_code < 0)
        return "a signal ended it";
    if (!o->failed[0])
        return "nothing failed";
    if (o->misuse[0])
        return "misuse of Vulkan";
    if (new_leak(o, good))
        return "leak";
    const bool warned = strncmp(o->errors, "sdfgi: warning: ", 16) == 0;
    if (tolerated && strcmp(kind, "allocation") != 0 && !warned && !is_dispensable(kind, o->failed))
        return "no error";
    if (tolerated && o->file_count != good->file_count)
        return "no error, but files are missing";
    const bool kept = strstr(o->errors, "--resume goes on from r.exr.state"); /* what has been traced */
    if (!tolerated && line_count(o->errors) != 1u + kept)
        return "not one line of error";
    if (!tolerated && !message_fits(kind, o->errors))
        return "the line does not say what is wrong";
    for (uint32_t i = 0; i < o->file_count; i++)
        if (!file_is_whole(&o->files[i], good) && !(kept && strcmp(o->files[i].name, "r.exr.state") == 0))
            return "a file that is not whole";
    return NULL;
}

/* ---- Many runs --------------------------------------------------------------------------------------- */

struct campaign {
    const char *kind;
    const uint32_t *calls; /* that fail, one after another */
    uint32_t count, next, problems, tolerated, with_files, terminated;
    struct fault_outcome good;
    pthread_mutex_t mutex;
};

struct worker {
    struct campaign *campaign;
    char folder[sizeof folder + 12];
};

static void tell(struct campaign *c, uint32_t k, const char *problem, const struct fault_outcome *o)
{
    if (c->problems++ >= MOST_PROBLEMS_SHOWN)
        return;
    const char *leak = new_leak(o, &c->good);
    print_message("# %s %u (%s): %s; exit code %d, %s%s%u files: %s\n", c->kind, k, o->failed, problem,
                  o->exit_code, o->misuse, leak ? leak : "", o->file_count, o->errors);
}

static void *work(void *user)
{
    const struct worker *worker = user;
    struct campaign *c = worker->campaign;
    struct fault_outcome outcome;
    for (;;) {
        const uint32_t index = __atomic_fetch_add(&c->next, 1, __ATOMIC_RELAXED);
        if (index >= c->count)
            return NULL;
        const bool ran = fault_run(&command, c->kind, c->calls[index], worker->folder, &outcome, NULL);
        const char *problem = problem_of(c->kind, &outcome, &c->good);
        pthread_mutex_lock(&c->mutex);
        if (!ran || problem)
            tell(c, c->calls[index], problem ? problem : "it did not run", &outcome);
        c->terminated += is_fault_of_tinygltf(&outcome);
        c->tolerated += outcome.exit_code == 0;
        c->with_files += outcome.exit_code != 0 && outcome.file_count > 0;
        pthread_mutex_unlock(&c->mutex);
    }
}

static void run_all(struct campaign *c)
{
    struct worker workers[WORKERS];
    pthread_t threads[WORKERS];
    pthread_mutex_init(&c->mutex, NULL);
    for (int i = 0; i < WORKERS; i++) {
        workers[i].campaign = c;
        snprintf(workers[i].folder, sizeof workers[i].folder, "%s/%d", folder, i);
        REQUIRE_CMP(pthread_create(&threads[i], NULL, work, &workers[i]), ==, 0);
    }
    for (int i = 0; i < WORKERS; i++)
        pthread_join(threads[i], NULL);
    pthread_mutex_destroy(&c->mutex);
}

/* Places that allocate, of all commands so far. */
static struct {
    char names[MOST_PLACES][32];
    uint32_t count;
} places;

/* True once for each place. */
static bool is_new_place(const char *name)
{
    for (uint32_t i = 0; i < places.count; i++)
        if (strcmp(places.names[i], name) == 0)
            return false;
    REQUIRE_CMP(places.count, <, (uint32_t)MOST_PLACES);
    strcpy(places.names[places.count++], name);
    return true;
}

/* Leaves the places that no command before has come by. */
static uint32_t keep_new_places(char (*names)[32], uint32_t count, uint32_t *calls)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++)
        if (is_new_place(names[calls[i] - 1]))
            calls[kept++] = calls[i];
    return kept;
}

/* Every call, or the first and the last of each name. */
static uint32_t choose(char (*names)[32], uint32_t count, bool both_ends, uint32_t *calls)
{
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < count; i++) {
        bool before = false, after = false;
        for (uint32_t k = 0; k < i && !before && (!full || command.real); k++)
            before = strcmp(names[k], names[i]) == 0;
        for (uint32_t k = i + 1; k < count && before && !after; k++)
            after = strcmp(names[k], names[i]) == 0;
        if (!before || (both_ends && !after))
            calls[chosen++] = i + 1;
    }
    return chosen;
}

static void run_without_fault(const char *kind, struct fault_outcome *outcome, char (**names)[32])
{
    char path[sizeof folder + 2];
    snprintf(path, sizeof path, "%s/0", folder);
    REQUIRE_TRUE(fault_run(&command, kind, 0, path, outcome, names));
    if (outcome->exit_code != 0 || outcome->errors[0] || outcome->misuse[0])
        print_message("# without a fault: %s%s\n", outcome->misuse, outcome->errors);
    REQUIRE_CMP(outcome->exit_code, ==, 0);
    REQUIRE_TRUE(!outcome->errors[0] && !outcome->misuse[0]);
}

/* The program's calls of a kind fail in turn; afterwards it works. */
static void fail_calls(const char *kind, bool both_ends)
{
    static uint32_t calls[FAULT_RUN_CALLS];
    struct campaign c = { .kind = kind, .calls = calls };
    char(*names)[32] = NULL;
    run_without_fault(kind, &c.good, NULL); /* makes the cache */
    run_without_fault(kind, &c.good, &names);
    REQUIRE_TRUE(names && c.good.calls > 0 && c.good.calls <= FAULT_RUN_CALLS);
    c.count = choose(names, c.good.calls, both_ends, calls);
    if (!full && strcmp(kind, "allocation") == 0)
        c.count = keep_new_places(names, c.count, calls);
    REQUIRE_CMP(c.count, >, 0u);
    free(names);
    run_all(&c);
    print_message(
        "# %s: %u of %u calls failed, %u did no harm, %u left whole files, %u terminated tinygltf\n", kind,
        c.count, c.good.calls, c.tolerated, c.with_files, c.terminated);
    REQUIRE_CMP(c.problems, ==, 0u);
    struct fault_outcome again;
    run_without_fault(kind, &again, NULL);
    REQUIRE_CMP(again.file_count, ==, c.good.file_count);
}

/* ---- Commands ---------------------------------------------------------------------------------------- */

static void set_arguments(const char *const *arguments, size_t count)
{
    memset(command.arguments, 0, sizeof command.arguments);
    memcpy(command.arguments, arguments, count * sizeof *arguments);
}

#define SET_ARGUMENTS(...)                                                                                   \
    set_arguments((const char *const[]){ __VA_ARGS__ },                                                      \
                  sizeof((const char *const[]){ __VA_ARGS__ }) / sizeof(const char *))

#define SMALL "--set", "resolution=32", "--set", "cascades=1"

static int render(void **state)
{
    (void)state;
    SET_ARGUMENTS("render", command.scene, "--size", "9x9", "--frames", "3", SMALL, "--set",
                  "voxelizer=raster", "--out", "a.png", "--aov", "normal=n.exr", "--aov", "albedo=a.hdr",
                  "--report", "r.json");
    return 0;
}

static int walk(void **state)
{
    (void)state;
    SET_ARGUMENTS("walk", command.scene, "--path", command.path, "--size", "9x9", "--frames", "2", "--hold",
                  "0", SMALL, "--sample", "0,1,0,0,1,0", "--every", "1", "--debug", "albedo", "--out", "w");
    return 0;
}

static int reference(void **state)
{
    (void)state;
    SET_ARGUMENTS("reference", command.scene, "--size", "4x4", "--spp", "1", "--threads", "1", "--out",
                  "r.exr");
    return 0;
}

static void a_vulkan_call_without_host_memory_is_an_error(void **state)
{
    (void)state;
    fail_calls("host", !command.real);
}

static void a_vulkan_call_without_device_memory_is_an_error(void **state)
{
    (void)state;
    fail_calls("device", full);
}

static void a_lost_device_is_an_error(void **state)
{
    (void)state;
    fail_calls("lost", true);
}

static void an_allocation_that_fails_is_an_error(void **state)
{
    (void)state;
    fail_calls("allocation", false);
}

/* ---- The whole --------------------------------------------------------------------------------------- */

static const char *gnuplot;

static int open_folder(void **state)
{
    char path[2 * sizeof folder];
    if (files_setup(state) != 0)
        return -1;
    snprintf(folder, sizeof folder, "%s", files_path(""));
    snprintf(path, sizeof path, "%s/bin", folder);
    if (mkdir(path, 0777) != 0)
        return -1;
    strcat(path, "/gnuplot");
    return symlink(gnuplot, path);
}

static int remove_folder(void **state)
{
    fault_clear_folder(folder);
    return files_teardown(state);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        { "render: a_vulkan_call_without_host_memory_is_an_error",
          a_vulkan_call_without_host_memory_is_an_error, render, NULL, NULL },
        { "render: a_vulkan_call_without_device_memory_is_an_error",
          a_vulkan_call_without_device_memory_is_an_error, render, NULL, NULL },
        { "render: a_lost_device_is_an_error", a_lost_device_is_an_error, render, NULL, NULL },
        { "render: an_allocation_that_fails_is_an_error", an_allocation_that_fails_is_an_error, render, NULL,
          NULL },
        { "walk: a_vulkan_call_without_host_memory_is_an_error",
          a_vulkan_call_without_host_memory_is_an_error, walk, NULL, NULL },
        { "walk: a_vulkan_call_without_device_memory_is_an_error",
          a_vulkan_call_without_device_memory_is_an_error, walk, NULL, NULL },
        { "walk: a_lost_device_is_an_error", a_lost_device_is_an_error, walk, NULL, NULL },
        { "walk: an_allocation_that_fails_is_an_error", an_allocation_that_fails_is_an_error, walk, NULL,
          NULL },
        { "reference: an_allocation_that_fails_is_an_error", an_allocation_that_fails_is_an_error, reference,
          NULL, NULL },
    };
    const struct CMUnitTest real_tests[] = {
        { "with a driver: a_vulkan_call_without_host_memory_is_an_error",
          a_vulkan_call_without_host_memory_is_an_error, render, NULL, NULL },
    };
    const char *value = getenv("SDFGI_TEST_FULL");
    REQUIRE_CMP(argc, >=, 6);
    full = value && strcmp(value, "1") == 0;
    command = (struct fault_command){
        .program = argv[1], .preload = argv[2], .scene = argv[3], .path = argv[4], .real = argc > 6
    };
    gnuplot = argv[5];
    cmocka_set_test_filter(getenv("SDFGI_TEST_FILTER"));
    if (command.real)
        return cmocka_run_group_tests(real_tests, open_folder, remove_folder);
    return cmocka_run_group_tests(tests, open_folder, remove_folder);
}

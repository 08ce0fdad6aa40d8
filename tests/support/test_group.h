/* SPDX-License-Identifier: MIT
 * Programs that hold several groups of tests. Groups of one program share devices and pipelines, which take a
 * software driver a second to make.
 *
 *   TEST_GROUP(gather)
 *   {
 *       ...
 *       return cmocka_run_group_tests(tests, NULL, NULL);
 *   }
 *
 * stands where `main` would, and returns what it would. The program runs the groups that its arguments name,
 * in their order, and all of them if there are none.
 */
#ifndef TEST_GROUP_H
#define TEST_GROUP_H

struct test_group {
    const char *name;
    int (*run)(void);
    struct test_group *next;
};

/* Before `main`; the group stays the caller's. */
void test_group_add(struct test_group *group);

#define TEST_GROUP(group_name)                                                                               \
    static int group_name##_group(void);                                                                     \
    __attribute__((constructor)) static void group_name##_group_add(void)                                    \
    {                                                                                                        \
        static struct test_group group = { #group_name, group_name##_group, NULL };                          \
        test_group_add(&group);                                                                              \
    }                                                                                                        \
    static int group_name##_group(void)

#endif

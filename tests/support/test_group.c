/* SPDX-License-Identifier: MIT */
#include "test_group.h"

#include <stdio.h>
#include <string.h>

/* By this code meson knows a test that was skipped. */
enum { SKIPPED = 77 };

static struct test_group *groups;

void test_group_add(struct test_group *group)
{
    group->next = groups;
    groups = group;
}

static const struct test_group *group_named(const char *name)
{
    const struct test_group *group = groups;
    while (group && strcmp(group->name, name) != 0)
        group = group->next;
    return group;
}

/* 0, or what the program is to return. A group that is skipped lets others pass. */
static int run(const struct test_group *group)
{
    printf("# group %s\n", group->name);
    fflush(stdout);
    return group->run();
}

static int worse(int a, int b)
{
    if (a == 0 || a == SKIPPED)
        return b == 0 ? a : b;
    return a;
}

static int run_all(void)
{
    int result = 0;
    for (const struct test_group *group = groups; group; group = group->next)
        result = worse(result, run(group));
    return result;
}

int main(int count, char **names)
{
    int result = count < 2 ? run_all() : 0;
    for (int i = 1; i < count; i++) {
        const struct test_group *group = group_named(names[i]);
        if (!group)
            fprintf(stderr, "%s has no group of tests '%s'\n", names[0], names[i]);
        result = worse(result, group ? run(group) : 1);
    }
    return result;
}

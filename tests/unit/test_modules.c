/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include <modules/register_modules.h>
#include <stdio.h>
#include <string.h>

/* Two modules that write down how they are called. */
static char calls[200];

static void log_call(const char *what, char module, enum module_level level)
{
    const size_t used = strlen(calls);
    snprintf(calls + used, sizeof calls - used, "%s%c%d ", what, module, (int)level);
}

static bool a_initialize(struct module_registry *registry, enum module_level level)
{
    (void)registry;
    log_call("+", 'a', level);
    return true;
}

static void a_uninitialize(struct module_registry *registry, enum module_level level)
{
    (void)registry;
    log_call("-", 'a', level);
}

static bool b_initialize(struct module_registry *registry, enum module_level level)
{
    (void)registry;
    log_call("+", 'b', level);
    return level != MODULE_LEVEL_EDITOR;
}

static void b_uninitialize(struct module_registry *registry, enum module_level level)
{
    (void)registry;
    log_call("-", 'b', level);
}

static const struct module two[] = { { "a", a_initialize, a_uninitialize },
                                     { "b", b_initialize, b_uninitialize } };

static void modules_go_up_in_order_and_down_in_reverse(void **state)
{
    (void)state;
    struct module_registry registry = { .class_count = 0 };
    calls[0] = '\0';
    assert_true(module_table_initialize(two, 2, &registry, MODULE_LEVEL_CORE));
    assert_true(module_table_initialize(two, 2, &registry, MODULE_LEVEL_SCENE));
    module_table_uninitialize(two, 2, &registry, MODULE_LEVEL_SCENE);
    module_table_uninitialize(two, 2, &registry, MODULE_LEVEL_CORE);
    assert_string_equal(calls, "+a0 +b0 +a2 +b2 -b2 -a2 -b0 -a0 ");
}

static void a_module_that_fails_takes_the_others_back(void **state)
{
    (void)state;
    struct module_registry registry = { .class_count = 0 };
    calls[0] = '\0';
    assert_false(module_table_initialize(two, 2, &registry, MODULE_LEVEL_EDITOR));
    assert_string_equal(calls, "+a3 +b3 -a3 ");
}

static void sdfgi_registers_its_class_with_every_property(void **state)
{
    (void)state;
    struct module_registry registry = { .class_count = 0 };
    assert_true(register_modules(&registry));
    const struct module_class *sdfgi_class = module_class_find(&registry, "Sdfgi");
    assert_non_null(sdfgi_class);
    assert_true(strlen(sdfgi_class->brief) > 0 && strlen(sdfgi_class->description) > 0);
    uint32_t count = 0;
    for (; sdfgi_class->property(count); count++)
        assert_ptr_equal(sdfgi_class->property(count), sdfgi_property_get_info(count));
    assert_true(count > 0);
    unregister_modules(&registry);
    assert_int_equal(registry.class_count, 0);
    assert_null(module_class_find(&registry, "Sdfgi"));
}

static void registering_twice_fails_and_changes_nothing(void **state)
{
    (void)state;
    struct module_registry registry = { .class_count = 0 };
    assert_true(register_modules(&registry));
    assert_false(register_modules(&registry));
    assert_int_equal(registry.class_count, 1);
    assert_non_null(module_class_find(&registry, "Sdfgi"));
}

static void classes_end_at_the_limit_and_leave_in_any_order(void **state)
{
    (void)state;
    static char names[MODULE_MAX_CLASSES + 1][16];
    struct module_registry registry = { .class_count = 0 };
    for (int i = 0; i <= MODULE_MAX_CLASSES; i++) {
        snprintf(names[i], sizeof names[i], "C%d", i);
        const struct module_class entry = { .name = names[i] };
        assert_int_equal(module_class_register(&registry, &entry), i < MODULE_MAX_CLASSES);
    }
    module_class_unregister(&registry, "C3");
    module_class_unregister(&registry, "nobody");
    assert_int_equal(registry.class_count, MODULE_MAX_CLASSES - 1);
    assert_null(module_class_find(&registry, "C3"));
    assert_string_equal(module_class_find(&registry, "C4")->name, "C4");
    assert_string_equal(registry.classes[3].name, "C4");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modules_go_up_in_order_and_down_in_reverse),
        cmocka_unit_test(a_module_that_fails_takes_the_others_back),
        cmocka_unit_test(sdfgi_registers_its_class_with_every_property),
        cmocka_unit_test(registering_twice_fails_and_changes_nothing),
        cmocka_unit_test(classes_end_at_the_limit_and_leave_in_any_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

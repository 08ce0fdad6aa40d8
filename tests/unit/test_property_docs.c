/* SPDX-License-Identifier: MIT */
#include "unit.h"

#include "cli/property_docs.h"

#include <cJSON.h>
#include <sdfgi/settings.h>
#include <stdlib.h>
#include <string.h>

/* What a writer prints of the registered class. */
static char *print(void (*write)(const struct module_class *docs, FILE *out))
{
    struct module_registry registry = { .class_count = 0 };
    assert_true(register_modules(&registry));
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    write(module_class_find(&registry, "Sdfgi"), out);
    fclose(out);
    return text;
}

static void checked_in_class_reference_is_current(void **state)
{
    (void)state;
    FILE *file = fopen(SOURCE_ROOT "/modules/sdfgi/doc_classes/Sdfgi.xml", "rb");
    assert_non_null(file);
    char *wanted = print(property_docs_write_xml);
    for (const char *c = wanted; *c; c++)
        if (fgetc(file) != (unsigned char)*c)
            fail_msg("Sdfgi.xml is stale: sdfgi properties --xml > modules/sdfgi/doc_classes/Sdfgi.xml");
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
    free(wanted);
}

static void every_property_is_in_every_form(void **state)
{
    (void)state;
    void (*const writers[])(const struct module_class *, FILE *) = { property_docs_write_xml,
                                                                     property_docs_write_markdown,
                                                                     property_docs_write_text };
    for (int i = 0; i < 3; i++) {
        char *text = print(writers[i]);
        const struct sdfgi_property_info *info;
        for (uint32_t k = 0; (info = sdfgi_property_get_info(k)); k++)
            assert_non_null(strstr(text, info->name));
        free(text);
    }
}

static void write_json(const struct module_class *docs, FILE *out)
{
    assert_true(property_docs_write_json(docs, out));
}

static void json_parses_and_has_one_object_per_row(void **state)
{
    (void)state;
    char *text = print(write_json);
    cJSON *list = cJSON_Parse(text);
    assert_non_null(list);
    const struct sdfgi_property_info *info;
    uint32_t count = 0;
    for (; (info = sdfgi_property_get_info(count)); count++) {
        const cJSON *item = cJSON_GetArrayItem(list, (int)count);
        assert_string_equal(cJSON_GetObjectItem(item, "name")->valuestring, info->name);
        assert_true(cJSON_GetObjectItem(item, "maximum")->valuedouble == info->maximum);
    }
    assert_int_equal(cJSON_GetArraySize(list), count);
    cJSON_Delete(list);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(checked_in_class_reference_is_current),
        cmocka_unit_test(every_property_is_in_every_form),
        cmocka_unit_test(json_parses_and_has_one_object_per_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: MIT */
#include "register_modules.h"

#include "sdfgi/register_types.h"

#include <string.h>

/* Modules that offer classes. gltf and raycast are libraries without any. */
static const struct module enabled[] = {
    { "sdfgi", sdfgi_module_initialize, sdfgi_module_uninitialize },
};

enum { ENABLED_COUNT = sizeof enabled / sizeof enabled[0] };

/* ---- Classes */

bool module_class_register(struct module_registry *registry, const struct module_class *module_class)
{
    if (registry->class_count == MODULE_MAX_CLASSES || module_class_find(registry, module_class->name))
        return false;
    registry->classes[registry->class_count++] = *module_class;
    return true;
}

void module_class_unregister(struct module_registry *registry, const char *name)
{
    const struct module_class *found = module_class_find(registry, name);
    if (!found)
        return;
    const uint32_t at = (uint32_t)(found - registry->classes);
    registry->class_count--;
    memmove(&registry->classes[at], &registry->classes[at + 1],
            (registry->class_count - at) * sizeof registry->classes[0]);
}

const struct module_class *module_class_find(const struct module_registry *registry, const char *name)
{
    for (uint32_t i = 0; i < registry->class_count; i++)
        if (strcmp(registry->classes[i].name, name) == 0)
            return &registry->classes[i];
    return NULL;
}

/* ---- Modules */

bool module_table_initialize(const struct module *modules, uint32_t count, struct module_registry *registry,
                             enum module_level level)
{
    for (uint32_t i = 0; i < count; i++)
        if (!modules[i].initialize(registry, level)) {
            module_table_uninitialize(modules, i, registry, level);
            return false;
        }
    return true;
}

void module_table_uninitialize(const struct module *modules, uint32_t count, struct module_registry *registry,
                               enum module_level level)
{
    while (count-- > 0)
        modules[count].uninitialize(registry, level);
}

static void unregister_below(struct module_registry *registry, int level)
{
    while (level-- > 0)
        module_table_uninitialize(enabled, ENABLED_COUNT, registry, (enum module_level)level);
}

bool register_modules(struct module_registry *registry)
{
    for (int level = 0; level < MODULE_LEVEL_COUNT; level++)
        if (!module_table_initialize(enabled, ENABLED_COUNT, registry, (enum module_level)level)) {
            unregister_below(registry, level);
            return false;
        }
    return true;
}

void unregister_modules(struct module_registry *registry)
{
    unregister_below(registry, MODULE_LEVEL_COUNT);
}

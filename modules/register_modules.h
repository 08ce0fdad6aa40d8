/* SPDX-License-Identifier: MIT
 * Modules as Godot has them: what is built in is a row of a table, and every module is initialised once per
 * level, in the order of the table, and uninitialised in the reverse order. What modules register belongs to
 * the caller's registry: nothing here is global and mutable. */
#ifndef REGISTER_MODULES_H
#define REGISTER_MODULES_H

#include <sdfgi/settings.h>
#include <stdbool.h>
#include <stdint.h>

enum module_level {
    MODULE_LEVEL_CORE,
    MODULE_LEVEL_SERVERS,
    MODULE_LEVEL_SCENE,
    MODULE_LEVEL_EDITOR,
    MODULE_LEVEL_COUNT,
};

/* What documentation, inspectors and command lines need to know of a class. All pointers are static. */
struct module_class {
    const char *name;
    const char *brief, *description;
    /* Rows in a fixed order; NULL past the end. */
    const struct sdfgi_property_info *(*property)(uint32_t index);
};

enum { MODULE_MAX_CLASSES = 16 };

/* Zero-initialised: empty. */
struct module_registry {
    struct module_class classes[MODULE_MAX_CLASSES];
    uint32_t class_count;
};

/* False if the registry is full or has a class of that name. */
bool module_class_register(struct module_registry *registry, const struct module_class *module_class);
/* Does nothing if there is no class of that name. */
void module_class_unregister(struct module_registry *registry, const char *name);
/* NULL if there is none. */
const struct module_class *module_class_find(const struct module_registry *registry, const char *name);

/* A module ignores the levels at which it has nothing to do. */
struct module {
    const char *name;
    bool (*initialize)(struct module_registry *registry, enum module_level level);
    void (*uninitialize)(struct module_registry *registry, enum module_level level);
};

/* On failure, what was initialised at this level is uninitialised again. */
bool module_table_initialize(const struct module *modules, uint32_t count, struct module_registry *registry,
                             enum module_level level);
void module_table_uninitialize(const struct module *modules, uint32_t count, struct module_registry *registry,
                               enum module_level level);

/* The same for the modules of this build, from the core level upwards; all levels or none. */
bool register_modules(struct module_registry *registry);
/* From the editor level downwards. */
void unregister_modules(struct module_registry *registry);

#endif

/* SPDX-License-Identifier: MIT */
#include "register_types.h"

static const struct module_class sdfgi_class = {
    .name = "Sdfgi",
    .brief = "Real-time global illumination on signed distance fields.",
    .description = "Settings of libsdfgi, with the names and ranges of Godot's Environment.",
    .property = sdfgi_property_get_info,
};

bool sdfgi_module_initialize(struct module_registry *registry, enum module_level level)
{
    return level != MODULE_LEVEL_SCENE || module_class_register(registry, &sdfgi_class);
}

void sdfgi_module_uninitialize(struct module_registry *registry, enum module_level level)
{
    if (level == MODULE_LEVEL_SCENE)
        module_class_unregister(registry, sdfgi_class.name);
}

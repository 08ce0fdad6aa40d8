/* SPDX-License-Identifier: MIT
 * What this module offers an engine: the class "Sdfgi", registered at the scene level. */
#ifndef SDFGI_REGISTER_TYPES_H
#define SDFGI_REGISTER_TYPES_H

#include "../register_modules.h"

bool sdfgi_module_initialize(struct module_registry *registry, enum module_level level);
void sdfgi_module_uninitialize(struct module_registry *registry, enum module_level level);

#endif

/* SPDX-License-Identifier: MIT
 * The properties of a registered class as documents. */
#ifndef RUNTIME_PROPERTY_DOCS_H
#define RUNTIME_PROPERTY_DOCS_H

#include <modules/register_modules.h>
#include <stdbool.h>
#include <stdio.h>

/* As Godot's class reference has it; modules/sdfgi/doc_classes/Sdfgi.xml is this text. */
void property_docs_write_xml(const struct module_class *docs, FILE *out);
void property_docs_write_markdown(const struct module_class *docs, FILE *out);
/* False when memory runs out. */
bool property_docs_write_json(const struct module_class *docs, FILE *out);
/* A short table for a terminal. */
void property_docs_write_text(const struct module_class *docs, FILE *out);

#endif

/* SPDX-License-Identifier: MIT */
#include "property_docs.h"

#include <cJSON.h>
#include <sdfgi/settings.h>
#include <stdlib.h>
#include <string.h>

enum { VALUE_BYTES = 32 };

static const char *type_name(enum sdfgi_property_type type)
{
    static const char *const names[] = { [SDFGI_PROPERTY_BOOL] = "bool",
                                         [SDFGI_PROPERTY_INT] = "int",
                                         [SDFGI_PROPERTY_FLOAT] = "float",
                                         [SDFGI_PROPERTY_ENUM] = "enum" };
    return names[type];
}

/* In Godot's class reference an enum is an int with named constants. */
static const char *godot_type_name(enum sdfgi_property_type type)
{
    return type == SDFGI_PROPERTY_ENUM ? "int" : type_name(type);
}

static void default_text(const struct sdfgi_property_info *info, char text[VALUE_BYTES])
{
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    sdfgi_settings_format(&settings, info->name, text, VALUE_BYTES);
}

static void write_range(const struct sdfgi_property_info *info, FILE *out)
{
    if (info->choices[0])
        fputs(info->choices, out);
    else if (info->type == SDFGI_PROPERTY_BOOL)
        fputs("true, false", out);
    else
        fprintf(out, "%g to %.9g", info->minimum, info->maximum);
    if (info->unit[0])
        fprintf(out, " %s", info->unit);
}

static const char *when_text(const struct sdfgi_property_info *info)
{
    return info->derived ? "derived" : info->recreates ? "re-creates" : "live";
}

/* ---- XML -------------------------------------------------------------------------------------------- */

static void write_escaped(const char *text, FILE *out)
{
    for (; *text; text++) {
        if (*text == '&')
            fputs("&amp;", out);
        else if (*text == '<')
            fputs("&lt;", out);
        else if (*text == '>')
            fputs("&gt;", out);
        else if (*text == '"')
            fputs("&quot;", out);
        else
            fputc(*text, out);
    }
}

static void write_xml_member(const struct sdfgi_property_info *info, FILE *out)
{
    char value[VALUE_BYTES];
    default_text(info, value);
    if (info->type == SDFGI_PROPERTY_ENUM)
        snprintf(value, sizeof value, "%g", info->default_value);
    fprintf(out,
            "\t\t<member name=\"%s\" type=\"%s\" setter=\"set_%s\" getter=\"%s%s\" default=\"%s\">\n\t\t\t",
            info->name, godot_type_name(info->type), info->name,
            info->type == SDFGI_PROPERTY_BOOL ? "is_" : "get_", info->name, value);
    write_escaped(info->description, out);
    fputs("\n\t\t\t[b]Range:[/b] ", out);
    write_range(info, out);
    fputs(". [b]More of it buys[/b] ", out);
    write_escaped(info->buys, out);
    fputs(". [b]It costs[/b] ", out);
    write_escaped(info->costs, out);
    fprintf(out, ". %s\n\t\t</member>\n",
            info->recreates ? "A change rebuilds everything." : "A change takes effect at once.");
}

/* "sdfgi_y_scale" and "50%" become SDFGI_Y_SCALE_50, the name that the C header has. */
static void write_constant_name(const char *property, const char *choice, size_t length, FILE *out)
{
    const char *const parts[] = { property, "_", choice };
    const size_t lengths[] = { strlen(property), 1, length };
    for (int part = 0; part < 3; part++)
        for (size_t i = 0; i < lengths[part]; i++) {
            const char c = parts[part][i];
            if (c != '%')
                fputc(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c, out);
        }
}

static void write_xml_constants(const struct sdfgi_property_info *info, FILE *out)
{
    const char *choice = info->choices;
    for (int value = 0; *choice; value++) {
        const size_t length = strcspn(choice, ",");
        fputs("\t\t<constant name=\"", out);
        write_constant_name(info->name, choice, length, out);
        fprintf(out, "\" value=\"%d\" enum=\"%s\">\n\t\t\t%.*s\n\t\t</constant>\n", value, info->name,
                (int)length, choice);
        choice += length + (choice[length] == ',');
    }
}

void property_docs_write_xml(const struct module_class *docs, FILE *out)
{
    const struct sdfgi_property_info *info;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n", out);
    fprintf(out, "<class name=\"%s\" version=\"4.0\">\n\t<brief_description>\n\t\t", docs->name);
    write_escaped(docs->brief, out);
    fputs("\n\t</brief_description>\n\t<description>\n\t\t", out);
    write_escaped(docs->description, out);
    fputs("\n\t</description>\n\t<tutorials>\n\t</tutorials>\n\t<members>\n", out);
    for (uint32_t i = 0; (info = docs->property(i)); i++)
        write_xml_member(info, out);
    fputs("\t</members>\n\t<constants>\n", out);
    for (uint32_t i = 0; (info = docs->property(i)); i++)
        if (info->type == SDFGI_PROPERTY_ENUM)
            write_xml_constants(info, out);
    fputs("\t</constants>\n</class>\n", out);
}

/* ---- The other forms -------------------------------------------------------------------------------- */

void property_docs_write_markdown(const struct module_class *docs, FILE *out)
{
    const struct sdfgi_property_info *info;
    fputs("| property | type | default | range | change | more of it buys | and costs | meaning |\n"
          "|---|---|---|---|---|---|---|---|\n",
          out);
    for (uint32_t i = 0; (info = docs->property(i)); i++) {
        char value[VALUE_BYTES];
        default_text(info, value);
        fprintf(out, "| `%s` | %s | %s | ", info->name, type_name(info->type), value);
        write_range(info, out);
        fprintf(out, " | %s | %s | %s | %s |\n", when_text(info), info->buys, info->costs, info->description);
    }
}

void property_docs_write_text(const struct module_class *docs, FILE *out)
{
    const struct sdfgi_property_info *info;
    fprintf(out, "%-30s %-6s %-10s %-11s %s\n", "property", "type", "default", "change", "range");
    for (uint32_t i = 0; (info = docs->property(i)); i++) {
        char value[VALUE_BYTES];
        default_text(info, value);
        fprintf(out, "%-30s %-6s %-10s %-11s ", info->name, type_name(info->type), value, when_text(info));
        write_range(info, out);
        fprintf(out, "\n    %s\n    buys: %s; costs: %s\n", info->description, info->buys, info->costs);
    }
}

static bool add_json_property(cJSON *list, const struct sdfgi_property_info *info)
{
    char value[VALUE_BYTES];
    default_text(info, value);
    cJSON *item = cJSON_CreateObject();
    if (!item || !cJSON_AddItemToArray(list, item))
        return false;
    return cJSON_AddStringToObject(item, "name", info->name) &&
           cJSON_AddStringToObject(item, "type", type_name(info->type)) &&
           cJSON_AddStringToObject(item, "default", value) &&
           cJSON_AddNumberToObject(item, "default_value", info->default_value) &&
           cJSON_AddNumberToObject(item, "minimum", info->minimum) &&
           cJSON_AddNumberToObject(item, "maximum", info->maximum) &&
           cJSON_AddStringToObject(item, "unit", info->unit) &&
           cJSON_AddStringToObject(item, "choices", info->choices) &&
           cJSON_AddStringToObject(item, "buys", info->buys) &&
           cJSON_AddStringToObject(item, "costs", info->costs) &&
           cJSON_AddBoolToObject(item, "recreates", info->recreates) &&
           cJSON_AddBoolToObject(item, "derived", info->derived) &&
           cJSON_AddStringToObject(item, "description", info->description);
}

bool property_docs_write_json(const struct module_class *docs, FILE *out)
{
    const struct sdfgi_property_info *info;
    cJSON *list = cJSON_CreateArray();
    bool complete = list != NULL;
    for (uint32_t i = 0; complete && (info = docs->property(i)); i++)
        complete = add_json_property(list, info);
    char *text = complete ? cJSON_Print(list) : NULL;
    if (text)
        fprintf(out, "%s\n", text);
    cJSON_free(text);
    cJSON_Delete(list);
    return text != NULL;
}

/* SPDX-License-Identifier: MIT
 * sdfgi properties: every setting of the class that the module sdfgi registers. */
#include "cli.h"
#include "commands.h"
#include "property_docs.h"

static bool write_docs(const struct module_class *docs, bool json, bool xml, bool markdown)
{
    if (json)
        return property_docs_write_json(docs, stdout);
    if (xml)
        property_docs_write_xml(docs, stdout);
    else if (markdown)
        property_docs_write_markdown(docs, stdout);
    else
        property_docs_write_text(docs, stdout);
    return true;
}

int cmd_properties(int argc, char **argv)
{
    bool xml = false, markdown = false, json = false;
    const struct cli_option options[] = {
        { "xml", CLI_FLAG, &xml, .help = "Godot's class reference format" },
        { "markdown", CLI_FLAG, &markdown, .help = "a Markdown table" },
        { "json", CLI_FLAG, &json, .help = "JSON" },
    };
    const struct cli_spec spec = { .name = "properties",
                                   .summary = "Prints every setting: default, range, what it buys and costs.",
                                   .options = options,
                                   .option_count = 3 };
    const enum cli_outcome outcome = cli_parse(&spec, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    if (xml + markdown + json > 1) {
        cli_error("properties: give one of --xml, --markdown and --json");
        return CLI_EXIT_USAGE;
    }
    struct module_registry registry = { .class_count = 0 };
    if (!register_modules(&registry))
        return cli_error("properties: the modules cannot be registered");
    const bool written = write_docs(module_class_find(&registry, "Sdfgi"), json, xml, markdown);
    unregister_modules(&registry);
    return written ? CLI_EXIT_OK : cli_error("properties: out of memory");
}

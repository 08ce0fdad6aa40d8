/* SPDX-License-Identifier: MIT
 * sdfgi properties: every setting of the class that the module sdfgi registers. */
#include "cli.h"
#include "commands.h"
#include "property_docs.h"
#include "run_options.h"
#include "file/json_write.h"
#include "report/report.h"

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

static bool write_defaults(const char *path)
{
    char error[CLI_ERROR_BYTES];
    struct sdfgi_settings settings;
    sdfgi_settings_default(&settings);
    if (json_write_file(report_settings_to_json(&settings), path, error, sizeof error))
        return true;
    cli_error("%s", error);
    return false;
}

int cmd_properties(int argc, char **argv)
{
    bool xml = false, markdown = false, json = false;
    struct run_common common = { .quiet = false };
    const struct cli_option options[] = {
        { "xml", CLI_FLAG, &xml, .help = "Godot's class reference format" },
        { "markdown", CLI_FLAG, &markdown, .help = "a Markdown table" },
        { "json", CLI_FLAG, &json, .help = "JSON" },
        RUN_COMMON_OPTIONS(&common, RUN_NO_DEVICE, "every default by its name, as JSON"),
    };
    const struct cli_spec spec = { .name = "properties",
                                   .summary = "Prints every setting: default, range, what it buys and costs.",
                                   .options = options,
                                   .option_count = sizeof options / sizeof options[0] };
    const enum cli_outcome outcome = cli_parse(&spec, argc, argv);
    if (outcome != CLI_RUN)
        return cli_exit_code(outcome);
    if (xml + markdown + json > 1) {
        cli_error("properties: give one of --xml, --markdown and --json");
        return CLI_EXIT_USAGE;
    }
    if (common.report && !write_defaults(common.report))
        return CLI_EXIT_FAILURE;
    if (common.quiet)
        return CLI_EXIT_OK;
    struct module_registry registry = { .class_count = 0 };
    if (!register_modules(&registry))
        return cli_error("properties: the modules cannot be registered");
    const bool written = write_docs(module_class_find(&registry, "Sdfgi"), json, xml, markdown);
    unregister_modules(&registry);
    return written ? CLI_EXIT_OK : cli_error("properties: out of memory");
}

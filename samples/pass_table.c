/* SPDX-License-Identifier: MIT
 *
 * Teaches: how to read what `sdfgi render --report` writes.
 *
 * Prints a table of GPU times per pass: rows are passes, columns are reports. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cJSON.h>

enum { REPORTS_MAX = 16, FILE_MAX = 16 << 20 };

static cJSON *report_read(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = malloc(FILE_MAX);
    size_t size = 0;
    if (file && text)
        size = fread(text, 1, FILE_MAX, file);
    cJSON *report = size && size < FILE_MAX ? cJSON_ParseWithLength(text, size) : NULL;
    free(text);
    if (file)
        fclose(file);
    if (!report)
        fprintf(stderr, "pass_table: %s: cannot be read as a JSON report\n", path);
    return report;
}

static const cJSON *pass_find(const cJSON *report, const char *name)
{
    const cJSON *pass;
    cJSON_ArrayForEach(pass, cJSON_GetObjectItem(report, "passes"))
    {
        const char *other = cJSON_GetStringValue(cJSON_GetObjectItem(pass, "name"));
        if (other && strcmp(other, name) == 0)
            return pass;
    }
    return NULL;
}

static double median_ms(const cJSON *holder, const char *key)
{
    const cJSON *value = cJSON_GetObjectItem(cJSON_GetObjectItem(holder, key), "median");
    return cJSON_IsNumber(value) ? value->valuedouble * 1e-6 : 0;
}

static void cell_print(double ms)
{
    if (ms > 0)
        printf(" %12.2f", ms);
    else
        printf(" %12s", "-");
}

static void heading_print(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    printf(" %12.*s", (int)(strcspn(name, ".") < 12 ? strcspn(name, ".") : 12), name);
}

static void table_print(cJSON *const *reports, int count, char **paths)
{
    printf("%-24s", "pass, median ms");
    for (int i = 0; i < count; i++)
        heading_print(paths[i]);
    printf("\n");
    const cJSON *row;
    cJSON_ArrayForEach(row, cJSON_GetObjectItem(reports[0], "passes"))
    {
        const char *name = cJSON_GetStringValue(cJSON_GetObjectItem(row, "name"));
        printf("%-24s", name ? name : "?");
        for (int i = 0; i < count; i++)
            cell_print(median_ms(name ? pass_find(reports[i], name) : NULL, "gpu_ns"));
        printf("\n");
    }
    printf("%-24s", "whole frame");
    for (int i = 0; i < count; i++)
        cell_print(median_ms(reports[i], "frame_gpu_ns"));
    printf("\n");
}

int main(int argc, char **argv)
{
    cJSON *reports[REPORTS_MAX] = { NULL };
    const int count = argc - 1;
    if (count < 1 || count > REPORTS_MAX || strcmp(argv[1], "--help") == 0) {
        fprintf(stderr, "usage: pass_table REPORT.json... (1 to %d)\n", REPORTS_MAX);
        return EXIT_FAILURE;
    }
    bool ok = true;
    for (int i = 0; ok && i < count; i++)
        ok = (reports[i] = report_read(argv[i + 1])) != NULL;
    if (ok)
        table_print(reports, count, argv + 1);
    for (int i = 0; i < count; i++)
        cJSON_Delete(reports[i]);
    return ok ? EXIT_SUCCESS : EXIT_FAILURE;
}

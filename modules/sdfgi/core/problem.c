/* SPDX-License-Identifier: MIT */
#include "problem.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

void sdfgi_problem_add(struct problem *problem, const char *format, ...)
{
    if (problem->text[0])
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(problem->text, sizeof problem->text, format, arguments);
    va_end(arguments);
}

/* `index` < 0: the field is no array. */
static void add_number(struct problem *problem, const char *field, int index, double value, double least,
                       double most)
{
    char name[64], limits[64] = "finite";
    if (index < 0)
        snprintf(name, sizeof name, "%s", field);
    else
        snprintf(name, sizeof name, "%s[%d]", field, index);
    if (isfinite(least) && isfinite(most))
        snprintf(limits, sizeof limits, "from %g to %g", least, most);
    else if (isfinite(least))
        snprintf(limits, sizeof limits, "finite and at least %g", least);
    sdfgi_problem_add(problem, "%s is %g, must be %s", name, value, limits);
}

void sdfgi_problem_floats(struct problem *problem, const char *field, const float *v, int count, float least,
                          float most)
{
    for (int i = 0; i < count; i++)
        if (!(isfinite(v[i]) && v[i] >= least && v[i] <= most))
            add_number(problem, field, count > 1 ? i : -1, (double)v[i], (double)least, (double)most);
}

void sdfgi_problem_finite(struct problem *problem, const char *field, const double *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(v[i]))
            add_number(problem, field, count > 1 ? i : -1, v[i], -INFINITY, INFINITY);
}

enum sdfgi_result sdfgi_problem_report(const struct problem *problem, const struct hooks *hooks,
                                       const char *function)
{
    return problem->text[0] ? sdfgi_message_invalid(hooks, "%s: %s", function, problem->text) : SDFGI_OK;
}

enum sdfgi_result sdfgi_problem_report_of(const struct problem *problem, const struct hooks *hooks,
                                          const char *function, const char *kind, uint32_t id)
{
    return problem->text[0]
               ? sdfgi_message_invalid(hooks, "%s: %s %u: %s", function, kind, (unsigned)id, problem->text)
               : SDFGI_OK;
}

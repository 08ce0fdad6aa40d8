/* SPDX-License-Identifier: MIT
 * What is wrong with what a host passes, as text that names field, value and limit. */
#ifndef SDFGI_PROBLEM_H
#define SDFGI_PROBLEM_H

#include "hooks.h"

/* The first thing that was found; an empty text: nothing. */
struct problem {
    char text[160];
};

/* Keeps the text unless one was found before. */
void sdfgi_problem_add(struct problem *problem, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Numbers must be finite and lie in [least, most]. An infinite limit is none. */
void sdfgi_problem_floats(struct problem *problem, const char *field, const float *v, int count, float least,
                          float most);
void sdfgi_problem_finite(struct problem *problem, const char *field, const double *v, int count);

/* Logs "`function`: text" and returns SDFGI_ERROR_INVALID_ARGUMENT if there is a problem. */
enum sdfgi_result sdfgi_problem_report(const struct problem *problem, const struct hooks *hooks,
                                       const char *function);
/* The same of an object that exists: "`function`: `kind` `id`: text". */
enum sdfgi_result sdfgi_problem_report_of(const struct problem *problem, const struct hooks *hooks,
                                          const char *function, const char *kind, uint32_t id);

#endif

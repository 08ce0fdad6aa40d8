/* SPDX-License-Identifier: MIT
 * What the catalogue of hard cases promises. A check compares a figure with its limit, like those of
 * require.h, and leaves a record of both: docs/hard_cases.md is made of such records (scripts/hard_cases.py).
 */
#ifndef TEST_HARD_CASE_H
#define TEST_HARD_CASE_H

/* `row` of tests/hard_cases.txt as a number, `what` as one literal: a short name of the figure with its unit,
 * the same words at every call for one figure. The document shows the worst of all calls. NaN fails. */
#define HARD_CASE_AT_MOST(row, what, measured, limit)                                                        \
    hard_case_check(__FILE__, __LINE__, __func__, row, what, (double)(measured), -1, (double)(limit))
#define HARD_CASE_AT_LEAST(row, what, measured, limit)                                                       \
    hard_case_check(__FILE__, __LINE__, __func__, row, what, (double)(measured), 1, (double)(limit))

/* `sense` is -1 if the limit is the most that is allowed, 1 if it is the least. Records go to the file that
 * SDFGI_TEST_HARD_CASES names, if it is set, one line a call. */
void hard_case_check(const char *file, int line, const char *test, int row, const char *what, double measured,
                     int sense, double limit);

#endif

/* SPDX-License-Identifier: MIT
 * The file of recorded plans: a heading for each situation, and the frames that it shows. */
#ifndef PLAN_BOOK_H
#define PLAN_BOOK_H

#include <stdbool.h>

/* Reads the file, or with SDFGI_TEST_RECORD=1 begins a new one. Returns false if there is none. */
bool plan_book_open(const char *path);
/* Compares what a situation shows with the file, or records it. A difference fails the test. */
void plan_book_take(const char *name, const char *text);
/* How many headings the file has. */
unsigned plan_book_count(void);
/* Writes the file if it was recorded and all of it is there; returns false if that failed. */
bool plan_book_close(bool complete);

#endif

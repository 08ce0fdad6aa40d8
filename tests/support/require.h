/* SPDX-License-Identifier: MIT
 * cmocka with checks that say what they compared. A failing check prints the expression, both operands and,
 * for REQUIRE_NEAR, the tolerance. Operands are evaluated again for the message: give them no side effects.
 */
#ifndef TEST_REQUIRE_H
#define TEST_REQUIRE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { REQUIRE_TEXT_SIZE = 64 };

/* Write `value` into `text` and return `text`. */
const char *require_text_signed(char text[static REQUIRE_TEXT_SIZE], long long value);
const char *require_text_unsigned(char text[static REQUIRE_TEXT_SIZE], unsigned long long value);
const char *require_text_real(char text[static REQUIRE_TEXT_SIZE], double value);

/* Prints one line in the style of printf and fails the running test. */
void require_fail(const char *file, int line, const char *format, ...) __attribute__((format(printf, 3, 4)));

#define REQUIRE_TEXT(text, value)                                                                            \
    _Generic((value), float                                                                                  \
             : require_text_real, double                                                                     \
             : require_text_real, unsigned char                                                              \
             : require_text_unsigned, unsigned short                                                         \
             : require_text_unsigned, unsigned int                                                           \
             : require_text_unsigned, unsigned long                                                          \
             : require_text_unsigned, unsigned long long                                                     \
             : require_text_unsigned, default                                                                \
             : require_text_signed)((text), (value))

/* REQUIRE_CMP(count, <=, 3): compares in the operands' own types. */
#define REQUIRE_CMP(a, op, b)                                                                                \
    do {                                                                                                     \
        if (!((a)op(b))) {                                                                                   \
            char require_a[REQUIRE_TEXT_SIZE], require_b[REQUIRE_TEXT_SIZE];                                 \
            require_fail(__FILE__, __LINE__, "%s %s %s: %s %s %s", #a, #op, #b, REQUIRE_TEXT(require_a, a),  \
                         #op, REQUIRE_TEXT(require_b, b));                                                   \
        }                                                                                                    \
    } while (0)

#define REQUIRE_TRUE(condition)                                                                              \
    do {                                                                                                     \
        if (!(condition))                                                                                    \
            require_fail(__FILE__, __LINE__, "%s: is false", #condition);                                    \
    } while (0)

/* |a - b| <= tolerance, in absolute terms; false for NaN. */
#define REQUIRE_NEAR(a, b, tolerance)                                                                        \
    do {                                                                                                     \
        const double require_a = (double)(a), require_b = (double)(b), require_t = (double)(tolerance);      \
        if (!(fabs(require_a - require_b) <= require_t))                                                     \
            require_fail(__FILE__, __LINE__, "%s near %s: %.9g and %.9g differ by %.3g, allowed %.3g", #a,   \
                         #b, require_a, require_b, fabs(require_a - require_b), require_t);                  \
    } while (0)

/* |a - b| <= tolerance * max(1, |b|). */
#define REQUIRE_NEAR_REL(a, b, tolerance) REQUIRE_NEAR(a, b, (double)(tolerance)*fmax(1.0, fabs((double)(b))))

/* a[0..count) and b[0..count) hold the same bytes; names the first one that differs. */
#define REQUIRE_BYTES(a, b, size) require_bytes(__FILE__, __LINE__, #a, (a), #b, (b), (size))
void require_bytes(const char *file, int line, const char *name_a, const void *a, const char *name_b,
                   const void *b, size_t size);

#endif

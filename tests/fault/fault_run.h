/* SPDX-License-Identifier: MIT
 * Runs the program with a library preloaded that makes its calls fail, and sees what becomes of it. */
#ifndef FAULT_RUN_H
#define FAULT_RUN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FAULT_RUN_ARGUMENTS = 32, FAULT_RUN_CALLS = 8192, FAULT_RUN_LEAKS = 64, FAULT_RUN_FILES = 16 };

struct fault_command {
    const char *program, *preload, *scene, *path; /* files */
    bool real;                                    /* with a Vulkan driver and the validation layer */
    const char *arguments[FAULT_RUN_ARGUMENTS];   /* after the program; file names are in the run's folder */
};

struct fault_file {
    char name[256];
    long size;
    char tail[8];
};

/* One run of the program. */
struct fault_outcome {
    int exit_code;       /* -1: a signal ended it */
    char errors[2048];   /* what it wrote to the standard error */
    uint32_t calls;      /* of the kind */
    char failed[64];     /* the call that failed, "" for none */
    char misuse[128];    /* a rule of Vulkan that was broken, "" for none */
    uint32_t leak_count; /* what lived at the end */
    char leaks[FAULT_RUN_LEAKS][40];
    uint32_t file_count; /* that were left, temporary ones included */
    struct fault_file files[FAULT_RUN_FILES];
};

/* Call `k` of a kind ("host", "device", "lost" or "allocation") fails, none if it is 0; then `names`, if not
 * NULL, gets the calls' names and has to be freed. The run's files lie in a folder that is emptied before. */
bool fault_run(const struct fault_command *command, const char *kind, uint32_t k, const char *folder,
               struct fault_outcome *outcome, char (**names)[32]);

/* Removes what is in it. */
void fault_clear_folder(const char *folder);

#endif

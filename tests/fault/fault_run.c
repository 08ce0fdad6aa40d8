/* SPDX-License-Identifier: MIT */
#define _GNU_SOURCE
#include "fault_run.h"

#include <dirent.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_BYTES = 1024, REAL_VARIABLES = 4, VARIABLES = 8 };

/* ---- Folders ----------------------------------------------------------------------------------------- */

static bool is_dot(const char *name)
{
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0;
}

void fault_clear_folder(const char *folder)
{
    DIR *const entries = opendir(folder);
    char path[2 * PATH_BYTES];
    for (const struct dirent *entry; entries && (entry = readdir(entries));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (!is_dot(entry->d_name) && unlink(path) != 0) {
            fault_clear_folder(path);
            rmdir(path);
        }
    }
    if (entries)
        closedir(entries);
}

static void see_file(const char *path, const char *name, struct fault_outcome *outcome)
{
    if (outcome->file_count == FAULT_RUN_FILES)
        return;
    struct fault_file *file = &outcome->files[outcome->file_count++];
    FILE *const stream = fopen(path, "rb");
    *file = (struct fault_file){ .size = -1 };
    snprintf(file->name, sizeof file->name, "%s", name);
    if (stream && fseek(stream, 0, SEEK_END) == 0)
        file->size = ftell(stream);
    if (stream && fseek(stream, -(long)sizeof file->tail, SEEK_END) == 0)
        (void)!fread(file->tail, 1, sizeof file->tail, stream);
    if (stream)
        fclose(stream);
}

/* Folders come as files without bytes. */
static void see_folder(const char *folder, struct fault_outcome *outcome)
{
    DIR *const entries = opendir(folder);
    char path[2 * PATH_BYTES];
    struct stat status;
    for (const struct dirent *entry; entries && (entry = readdir(entries));) {
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (is_dot(entry->d_name) || stat(path, &status) != 0)
            continue;
        see_file(path, entry->d_name, outcome);
        if (S_ISDIR(status.st_mode))
            see_folder(path, outcome);
    }
    if (entries)
        closedir(entries);
}

/* ---- The report -------------------------------------------------------------------------------------- */

static bool read_report(const char *path, struct fault_outcome *outcome, char (*names)[32])
{
    char line[256];
    uint32_t count = 0;
    FILE *const stream = fopen(path, "r");
    if (!stream)
        return false;
    while (fgets(line, sizeof line, stream)) {
        line[strcspn(line, "\n")] = '\0';
        if (sscanf(line, "calls %u", &outcome->calls) == 1)
            continue;
        if (strncmp(line, "failed ", 7) == 0)
            snprintf(outcome->failed, sizeof outcome->failed, "%.60s", line + 7);
        else if (strncmp(line, "misuse ", 7) == 0)
            snprintf(outcome->misuse, sizeof outcome->misuse, "%.120s", line + 7);
        else if (strncmp(line, "leak ", 5) == 0 && outcome->leak_count < FAULT_RUN_LEAKS)
            snprintf(outcome->leaks[outcome->leak_count++], sizeof *outcome->leaks, "%.38s", line + 5);
        else if (names && count < FAULT_RUN_CALLS && sscanf(line, "call %*u %31s", names[count]) == 1)
            count++;
    }
    fclose(stream);
    return true;
}

/* ---- The run ----------------------------------------------------------------------------------------- */

static void read_errors(int file, struct fault_outcome *outcome)
{
    const ssize_t size = pread(file, outcome->errors, sizeof outcome->errors - 1, 0);
    outcome->errors[size > 0 ? size : 0] = '\0';
}

/* Where the loader finds drivers and layers, and that the validation layer is on. */
static char *set_real_variable(char *text, size_t size, int index)
{
    static const char *const names[REAL_VARIABLES] = { "VK_DRIVER_FILES", "VK_ICD_FILENAMES",
                                                       "VK_LAYER_PATH" };
    const char *const value = names[index] ? getenv(names[index]) : NULL;
    if (value)
        snprintf(text, size, "%s=%s", names[index], value);
    else
        snprintf(text, size, "SDFGI_VALIDATION=1");
    return text;
}

/* The program finds gnuplot in the tests' folder of programs, and its cache beside the output. */
static bool start(const struct fault_command *command, const char *plan, const char *folder, int errors,
                  pid_t *child)
{
    char variables[VARIABLES][3 * PATH_BYTES], *environment[VARIABLES + 1] = { NULL };
    snprintf(variables[0], sizeof *variables, "SDFGI_FAULT=%s", plan);
    snprintf(variables[1], sizeof *variables, "LD_PRELOAD=%s", command->preload);
    snprintf(variables[2], sizeof *variables, "XDG_CACHE_HOME=%s%s/cache", folder,
             command->real ? "/.." : ""); /* what a driver has compiled once is there for all */
    snprintf(variables[3], sizeof *variables, "PATH=%s/../bin:/usr/bin:/bin", folder);
    for (int i = 0; i < 4; i++)
        environment[i] = variables[i];
    for (int i = 0; command->real && i < REAL_VARIABLES; i++)
        environment[4 + i] = set_real_variable(variables[4 + i], sizeof *variables, i);
    char *arguments[FAULT_RUN_ARGUMENTS + 1] = { (char *)command->program };
    for (int i = 0; i + 1 < FAULT_RUN_ARGUMENTS && command->arguments[i]; i++)
        arguments[i + 1] = (char *)command->arguments[i];
    char out[PATH_BYTES];
    snprintf(out, sizeof out, "%s/out", folder);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, out);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
    const int failure = posix_spawn(child, command->program, &actions, NULL, arguments, environment);
    posix_spawn_file_actions_destroy(&actions);
    return failure == 0;
}

bool fault_run(const struct fault_command *command, const char *kind, uint32_t k, const char *folder,
               struct fault_outcome *outcome, char (**names)[32])
{
    char out[PATH_BYTES], report[PATH_BYTES], plan[2 * PATH_BYTES];
    pid_t child;
    int status = 0;
    *outcome = (struct fault_outcome){ .exit_code = -1 };
    snprintf(out, sizeof out, "%s/out", folder);
    snprintf(report, sizeof report, "%s/report", folder);
    snprintf(plan, sizeof plan, "%s %u %s", kind, k, report);
    mkdir(folder, 0777);
    mkdir(out, 0777);
    fault_clear_folder(out);
    unlink(report);
    const int errors = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (errors < 0)
        return false;
    const bool ran = start(command, plan, folder, errors, &child) && waitpid(child, &status, 0) == child;
    read_errors(errors, outcome);
    close(errors);
    if (ran && WIFEXITED(status))
        outcome->exit_code = WEXITSTATUS(status);
    see_folder(out, outcome);
    if (names)
        *names = calloc(FAULT_RUN_CALLS, sizeof **names);
    return ran && read_report(report, outcome, names ? *names : NULL);
}

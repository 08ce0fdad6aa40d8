/* SPDX-License-Identifier: MIT
 * The plot of a walk. gnuplot reads its script, data included, from a file without a name and writes into
 * another: no name of a file has to survive its quoting. It leaves with 0 where a full disk cut its plot
 * short, so the plot is looked at before it is copied to its place. */
#include "walk_report.h"
#include "file/output_file.h"

#include <base/text.h>
#include <errno.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* ---- Data ------------------------------------------------------------------------------------------- */

/* Columns from here on, after frame, GI and frame time. */
enum { FIRST_PASS_COLUMN = 4 };

/* gnuplot has so many before it begins again. */
enum { COLORS = 8 };

enum { COPY_BYTES = 1 << 14 };

static bool pass_ever_ran(const struct walk_record *record, uint32_t pass)
{
    for (uint32_t i = 0; i < record->frame_count; i++)
        if (record->frames[i].passes[pass].ran)
            return true;
    return false;
}

static void print_value(FILE *out, bool known, double value)
{
    if (known)
        fprintf(out, " %.6g", value);
    else
        fputs(" NaN", out);
}

static void print_ms(FILE *out, const struct walk_frame *frame, walk_series_fn series_ns)
{
    double ns;
    const bool known = series_ns(frame, 0, &ns);
    print_value(out, known, 1e-6 * ns);
}

static void print_frame(FILE *out, const struct walk_record *record, uint32_t index, uint32_t sample_count)
{
    const struct walk_frame *frame = &record->frames[index];
    fprintf(out, "%u", index);
    print_ms(out, frame, walk_series_gi_gpu_ns);
    print_ms(out, frame, walk_series_gpu_ns);
    /* The axis of work is logarithmic: no work has no place on it. */
    for (uint32_t i = 0; i < record->pass_count; i++)
        print_value(out, frame->passes[i].work > 0, (double)frame->passes[i].work);
    for (uint32_t i = 0; i < sample_count; i++)
        print_value(out, true, walk_frame_luminance(frame, i));
    fputc('\n', out);
}

static void print_data(FILE *out, const struct walk_record *record, uint32_t sample_count)
{
    fputs("$walk << END\n", out);
    for (uint32_t i = 0; i < record->frame_count; i++)
        print_frame(out, record, i, sample_count);
    fputs("END\n", out);
}

/* ---- Panels ----------------------------------------------------------------------------------------- */

static void print_times(FILE *out)
{
    fputs("set ylabel 'GPU time, ms'\nplot $walk using 1:3 with lines lc '#999999' title 'whole frame', "
          "$walk using 1:2 with lines lw 2 lc '#c0392b' title 'GI'\n",
          out);
}

static void print_work(FILE *out, const struct walk_record *record)
{
    const char *separator = "set ylabel 'work'\nset logscale y\nplot ";
    uint32_t lines = 0;
    for (uint32_t i = 0; i < record->pass_count; i++) {
        if (!pass_ever_ran(record, i))
            continue;
        fprintf(out, "%s$walk using 1:%u with linespoints pt 7 ps 0.25 dt %u title '%s, %s'", separator,
                i + FIRST_PASS_COLUMN, 1 + lines++ / COLORS, record->pass_names[i], record->pass_units[i]);
        separator = ", ";
    }
    fputs("\nunset logscale y\n", out);
}

static void print_light(FILE *out, const struct walk_record *record, const struct walk_summary *summary)
{
    const char *separator = "set ylabel 'irradiance, W/m^2'\nset yrange [0:1e-9<*]\nplot ";
    for (uint32_t i = 0; i < summary->sample_count; i++) {
        const double *p = summary->sample_positions[i];
        fprintf(out, "%s$walk using 1:%u with lines lw 2 title 'at (%.6g, %.6g, %.6g)'", separator,
                FIRST_PASS_COLUMN + record->pass_count + i, p[0], p[1], p[2]);
        separator = ", ";
    }
    fputc('\n', out);
}

static bool any_pass_ran(const struct walk_record *record)
{
    for (uint32_t i = 0; i < record->pass_count; i++)
        if (pass_ever_ran(record, i))
            return true;
    return false;
}

static void print_script(FILE *out, const struct walk_record *record, const struct walk_summary *summary)
{
    const bool work = any_pass_ran(record), light = summary->sample_count > 0;
    const int panels = 1 + work + light;
    fprintf(out,
            "set terminal svg size 1100,%d font 'sans,12' background '#ffffff' noenhanced\n"
            "set multiplot layout %d,1\nset lmargin 10\nset rmargin 34\nset key outside right noenhanced\n"
            "set grid\nset xrange [0:%u]\nset yrange [*:*]\nset xlabel 'frame (%.6g m/s at %.6g frames/s)'\n",
            320 * panels, panels, record->frame_count > 1 ? record->frame_count - 1 : 1, summary->speed_m_s,
            summary->fps);
    print_data(out, record, summary->sample_count);
    print_times(out);
    if (work)
        print_work(out, record);
    if (light)
        print_light(out, record, summary);
    fputs("unset multiplot\n", out);
}

/* ---- gnuplot ---------------------------------------------------------------------------------------- */

/* Runs gnuplot from `script` to `picture`; 0, or why not as an errno, or -1 if it ran and failed. */
static int run_gnuplot(FILE *script, FILE *picture)
{
    char name[] = "gnuplot";
    char *arguments[] = { name, NULL };
    posix_spawn_file_actions_t actions;
    pid_t child;
    int status, failure = posix_spawn_file_actions_init(&actions);
    if (failure)
        return failure;
    failure = posix_spawn_file_actions_adddup2(&actions, fileno(script), STDIN_FILENO);
    if (!failure)
        failure = posix_spawn_file_actions_adddup2(&actions, fileno(picture), STDOUT_FILENO);
    if (!failure)
        failure = posix_spawnp(&child, name, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure)
        return failure;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return errno;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? 0 : -1;
}

static enum walk_plot_result draw(FILE *script, FILE *plot, const char *path, char *error, size_t error_size)
{
    const int failure = run_gnuplot(script, plot);
    if (!failure)
        return WALK_PLOT_WRITTEN;
    base_text_error(error, error_size, "%s: no plot: gnuplot %s%s", path,
                    failure == ENOENT ? "is not installed"
                    : failure > 0     ? "cannot be started: "
                                      : "failed",
                    failure > 0 && failure != ENOENT ? strerror(failure) : "");
    return failure > 0 && failure != ENOENT ? WALK_PLOT_NOT_WRITTEN : WALK_PLOT_NO_GNUPLOT;
}

/* ---- Its place -------------------------------------------------------------------------------------- */

static bool is_whole(FILE *plot)
{
    static const char end[] = "</svg>";
    char tail[32];
    if (fseek(plot, 0, SEEK_END) != 0 || ftell(plot) < (long)sizeof tail ||
        fseek(plot, -(long)sizeof tail + 1, SEEK_END) != 0)
        return false;
    tail[fread(tail, 1, sizeof tail - 1, plot)] = '\0';
    const char *const found = strstr(tail, end);
    return found && strspn(found + strlen(end), "\r\n") == strlen(found + strlen(end));
}

static bool copy(FILE *from, FILE *to)
{
    char bytes[COPY_BYTES];
    size_t size;
    rewind(from);
    while ((size = fread(bytes, 1, sizeof bytes, from)) > 0)
        if (fwrite(bytes, 1, size, to) != size)
            return false;
    return !ferror(from);
}

static bool put_in_place(FILE *plot, const char *path, char *error, size_t error_size)
{
    struct output_file file;
    if (!is_whole(plot))
        return base_text_error(error, error_size,
                               "%s: gnuplot's plot is cut short: is there disk space for "
                               "temporary files?",
                               path);
    if (!output_file_begin(&file, path, error, error_size))
        return false;
    if (copy(plot, file.stream) || ferror(file.stream))
        return output_file_commit(&file, error, error_size);
    output_file_cancel(&file);
    return base_text_error(error, error_size, "%s: gnuplot's plot cannot be read", path);
}

static enum walk_plot_result write_plot(FILE *script, FILE *plot, const char *path, char *error,
                                        size_t error_size)
{
    enum walk_plot_result result = WALK_PLOT_NOT_WRITTEN;
    if (fflush(script) == 0 && !ferror(script) && fseek(script, 0, SEEK_SET) == 0)
        result = draw(script, plot, path, error, error_size);
    else
        base_text_error(error, error_size, "%s: no temporary file: %s", path, strerror(errno));
    if (result == WALK_PLOT_WRITTEN && !put_in_place(plot, path, error, error_size))
        result = WALK_PLOT_NOT_WRITTEN;
    return result;
}

enum walk_plot_result walk_plot_write(const struct walk_record *record, const struct walk_summary *summary,
                                      const char *path, char *error, size_t error_size)
{
    enum walk_plot_result result = WALK_PLOT_NOT_WRITTEN;
    FILE *const script = tmpfile(), *const plot = tmpfile();
    if (script && plot) {
        print_script(script, record, summary);
        result = write_plot(script, plot, path, error, error_size);
    } else {
        base_text_error(error, error_size, "%s: no temporary file: %s", path, strerror(errno));
    }
    if (script)
        fclose(script);
    if (plot)
        fclose(plot);
    return result;
}

/* SPDX-License-Identifier: MIT
 * The sub-commands, one file each. argv[0] is the sub-command's name; the result is the exit code. */
#ifndef RUNTIME_COMMANDS_H
#define RUNTIME_COMMANDS_H

int cmd_compare(int argc, char **argv);
int cmd_info(int argc, char **argv);
int cmd_properties(int argc, char **argv);
int cmd_render(int argc, char **argv);
int cmd_reference(int argc, char **argv); /* with the raycast feature */
int cmd_walk(int argc, char **argv);
int cmd_view(int argc, char **argv); /* with the window feature */

#endif

/* SPDX-License-Identifier: MIT */
#ifndef SDFGI_FRAME_WORK_H
#define SDFGI_FRAME_WORK_H

#include "frame.h"

/* Adds all passes that the needs call for, in the order in which they run. */
void sdfgi_frame_add_work(struct frame *frame, const struct frame_input *input,
                          const struct situation_needs *needs);

#endif

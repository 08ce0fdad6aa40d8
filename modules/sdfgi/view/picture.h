/* SPDX-License-Identifier: MIT
 * What gathers and resolves have in common: the description of a picture, checked, and its work. */
#ifndef SDFGI_PICTURE_H
#define SDFGI_PICTURE_H

#include "core/problem.h"
#include "pass/work.h"

#include <sdfgi/sdfgi.h>

/* What is wrong with the description, whatever the device. */
struct problem sdfgi_picture_problem(const struct sdfgi_gather_desc *desc);
/* Adds a problem if a picture is larger than the device takes. */
void sdfgi_picture_check_size(struct problem *problem, const VkPhysicalDeviceLimits *limits, uint32_t width,
                              uint32_t height);
/* Pixels from one sample to the next. */
uint32_t sdfgi_picture_step(enum sdfgi_gather_resolution resolution);
/* The gather of a picture as an item of work. */
struct work sdfgi_picture_work(const struct sdfgi_gather_desc *desc);

#endif

/* SPDX-License-Identifier: MIT
 * What linkers see of this module. It lies in the static library, beside functions of hosts, which may well
 * have a gpu_fill of their own. Every global name of the library begins with sdfgi_. */
#ifndef GPU_NAMES_H
#define GPU_NAMES_H

#define gpu_bind_pipeline           sdfgi_gpu_bind_pipeline
#define gpu_bind_set                sdfgi_gpu_bind_set
#define gpu_buffer_finish           sdfgi_gpu_buffer_finish
#define gpu_buffer_init             sdfgi_gpu_buffer_init
#define gpu_buffer_invalidate       sdfgi_gpu_buffer_invalidate
#define gpu_buffer_view             sdfgi_gpu_buffer_view
#define gpu_buffer_zero             sdfgi_gpu_buffer_zero
#define gpu_compute_pipeline_create sdfgi_gpu_compute_pipeline_create
#define gpu_copy                    sdfgi_gpu_copy
#define gpu_device_init             sdfgi_gpu_device_init
#define gpu_dispatch                sdfgi_gpu_dispatch
#define gpu_dispatch_indirect       sdfgi_gpu_dispatch_indirect
#define gpu_draw                    sdfgi_gpu_draw
#define gpu_fill                    sdfgi_gpu_fill
#define gpu_functions_load_instance sdfgi_gpu_functions_load_instance
#define gpu_image_finish            sdfgi_gpu_image_finish
#define gpu_image_init              sdfgi_gpu_image_init
#define gpu_images_to_general       sdfgi_gpu_images_to_general
#define gpu_label_begin             sdfgi_gpu_label_begin
#define gpu_label_end               sdfgi_gpu_label_end
#define gpu_named                   sdfgi_gpu_named
#define gpu_order                   sdfgi_gpu_order
#define gpu_push                    sdfgi_gpu_push
#define gpu_raster_pipeline_create  sdfgi_gpu_raster_pipeline_create
#define gpu_recorder_begin          sdfgi_gpu_recorder_begin
#define gpu_recorder_end            sdfgi_gpu_recorder_end
#define gpu_render_pass_begin       sdfgi_gpu_render_pass_begin
#define gpu_render_pass_end         sdfgi_gpu_render_pass_end
#define gpu_retire                  sdfgi_gpu_retire
#define gpu_retire_all              sdfgi_gpu_retire_all
#define gpu_retire_collect          sdfgi_gpu_retire_collect
#define gpu_timer_begin_frame       sdfgi_gpu_timer_begin_frame
#define gpu_timer_finish            sdfgi_gpu_timer_finish
#define gpu_timer_init              sdfgi_gpu_timer_init
#define gpu_timer_read              sdfgi_gpu_timer_read
#define gpu_timer_reset             sdfgi_gpu_timer_reset
#define gpu_timer_stamp             sdfgi_gpu_timer_stamp
#define gpu_touch                   sdfgi_gpu_touch
#define gpu_update                  sdfgi_gpu_update
#define gpu_use                     sdfgi_gpu_use

#endif

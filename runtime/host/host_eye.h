/* SPDX-License-Identifier: MIT
 * Pictures of one eye or two, side by side. An update and its shadow maps serve both; all else is drawn for
 * one after the other, into the same depths and normals. */
#ifndef HOST_EYE_H
#define HOST_EYE_H

enum { HOST_EYES = 2 };

/* What both keep until the picture is shown. */
struct host_eye {
    struct host_image hdr;
    VkFramebuffer forward;
    sdfgi_view *view;        /* NULL if lookups are made where surfaces are shaded */
    struct host_image debug; /* none until a debug view is shown */
};

struct host_targets {
    struct host_eye eyes[HOST_EYES];
    struct host_image depth, normal, picture;
    VkImageView roughness; /* the alpha of `normal`, as red */
    VkFramebuffer prepass, picture_framebuffer;
};

/* What shaders of a frame read. */
struct host_slot_eye {
    struct host_buffer frame;
    VkDescriptorSet set;
    VkDescriptorSet light_set; /* pictures of the view; none if there is no view */
};

struct host_renderer;
struct host_slot;

/* Turns to an eye: what is recorded from now on is its. */
void host_eye_begin(struct host_renderer *renderer, uint32_t eye);
struct host_eye *host_eye_here(struct host_renderer *renderer);
const struct host_slot_eye *host_slot_here(const struct host_renderer *renderer,
                                           const struct host_slot *slot);
/* Draws depths, normals and roughness of what the eye sees. */
void host_prepass_record(struct host_renderer *renderer, VkCommandBuffer cmd);
/* Column of the picture in which an eye's half begins. */
uint32_t host_eye_column(const struct host_renderer *renderer, uint32_t eye);
/* The camera of the frames that follow: both eyes' middle. */
void host_eye_look(struct host_renderer *renderer, const struct host_camera *camera);

#endif

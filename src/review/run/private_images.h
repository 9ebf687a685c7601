/* SPDX-License-Identifier: Apache-2.0 */
/* private_images.h -- a symbol that must not be read, as the panes of a scene show it to an eye
 * (review/private_image.h): where its image stands, and how bright.
 *
 * The box about its foreground is looked for in each pane as displays are (eye/pane_images.h);
 * the share that the pane mirrors is what paths find of the image's mean luminance
 * (eye/pane_image_reading.h) over the mean of what the shown part of the box sends along the
 * same ways. What its foreground and background send is read from the panel towards the image's
 * middle, as of a symbol that is seen straight.
 *
 * Of an eye of several places each pane counts from where the image has most contrast, by few
 * paths; it is read from there by others.
 *
 * Approximate  the ghost by a pane's far face counts as if it lay on the image, which can be
 *              read worse for it; an image by two panes one after the other is not looked for.
 * Memory       from the arena. Threads: starts its own; the same figures for any count.
 */
#pragma once
#include "review/private_image.h"
#include "review/run/symbols.h"

typedef struct PrivateLook {
    const Setup *setup; /* lit */
    const SetupSymbol *symbol;
    const Vec3 *points; /* the eye's places, m, scene */
    int point_count;
} PrivateLook;

/* Sets images and image_count of a case whose level and panel are known: of the panes that show
 * any of it. */
void private_images_find(const PrivateLook *look, ReviewCase *c, Arena *arena);

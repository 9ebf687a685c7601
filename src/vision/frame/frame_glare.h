/* SPDX-License-Identifier: Apache-2.0 */
/* frame_glare.h -- discomfort glare of an eye that sees a frame: its sources, and figures.
 *
 * As evalglare (J. Wienold, NREL's Radiance) does it: pixels brighter than a threshold that
 * touch each other, by an edge or a corner, are one source; those above the peaks' luminance
 * are sources apart. A source's position index goes pixel by pixel (vision/discomfort.h); the
 * background is what all other pixels send to the eye. The line of sight is the frame's
 * middle, up is the frame's.
 * Unlike evalglare sources that do not touch are not joined (evalglare joins within 0.2 rad,
 * which changes UGR and DGP only where they differ in luminance), and:
 *
 * Edges    pixels of a source's edge are partly its surroundings. So its luminance is the mean
 *          over its core, the pixels that all have eight neighbours of it; pixels of its edge,
 *          and those below the threshold that touch it, are in part source and in part
 *          background as bright as that nearby; and its solid angle is what gives all its light
 *          with that luminance. evalglare's mean over all pixels above the threshold
 *          dims and widens a disc of n pixels across, and UGR is some 9/n too low. A source
 *          without a core has the mean weighed by luminance: its UGR and DGP are too low, and
 *          only a larger frame shows by how much.
 *
 * Noise    a pixel above the threshold may be a few bright samples. An area counts when one
 *          half of the samples has it above the threshold where the other half found it so
 *          (layer halves: that mean is without bias), by three times its noise (layers
 *          variance, halves). Without these layers all counts. Intervals are 95 % of the
 *          render's noise, to first order, of the sources as they were found: what a source
 *          without a core lacks is not in them. By halves, else by variance (measure.h).
 *
 * Threads  pure functions. Memory: the arena's.
 * Fails    when the frame does not say its view, or does not see half the space and no
 *          vertical illuminance is given.
 */
#pragma once
#include "image/content_contrast.h"
#include "image/frame_view.h"
#include "vision/discomfort.h"

typedef struct GlareRequest {
    GlareSettings settings;
    bool has_lux;
    double vertical_lx; /* at the eye, instead of the frame's */
} GlareRequest;

typedef struct FrameSource {
    GlareSource source;
    double lx;                /* on the pupil's plane */
    double x, y;              /* pixels: the middle of its light */
    double right_deg, up_deg; /* of that from the line of sight: azimuth and elevation */
    double greatest_cd_m2;    /* of a pixel */
    long pixels;
    bool has_core;
    double light, squares;         /* sums of L w and L^2 w over pixels, of all */
    double core_cd_sr_m2, core_sr; /* and of the core */
} FrameSource;

typedef struct FrameGlare {
    double seen;            /* share of the half space before the eye, by cosine: 1 all */
    double solid_angle_sr;  /* of all pixels with light */
    double threshold_cd_m2; /* that was used */
    double task_cd_m2;      /* mean luminance of the task; NaN without a task factor */
    GlareNone none;
    Measured vertical_lx, background_cd_m2, ugr, dgp, dgi;
    FrameSource *sources; /* the one of the most L^2 w/P^2 first */
    int source_count;
    long doubtful;  /* areas above the threshold that are noise, it seems */
    bool has_noise; /* that was looked into */
    bool has_intervals;
} FrameGlare;

#define GLARE_SEEN_LEAST 0.99 /* of the half space: else the illuminance lacks light */

/* err: without the frame's name. */
bool frame_glare_measure(const FrameImage *frame, const GlareRequest *request, Arena *arena,
                         FrameGlare *out, Error *err);

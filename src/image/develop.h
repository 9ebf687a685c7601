/* SPDX-License-Identifier: Apache-2.0 */
/* develop.h -- makes a picture that people can look at from a frame.
 *
 * Units    frames in cd m^-2 (frame.h); pictures in code values.
 * Memory   pictures come from the arena; scratch arenas are passed by value.
 * Threads  one thread; frames are only read.
 * Fails    when a layer, display, view or configuration does not exist (the text lists those
 *          that do), and when the output cannot be written.
 */
#pragma once
#include "image/frame.h"
#include "image/picture.h"

/* AUTO: with the exposure that is found by itself, the more the further the bright part of the
 * picture lies above middle grey: not at all up to ADAPT_FROM_STOPS, in full from one stop more
 * on (exposure_bright_stops). */
enum { DEVELOP_ADAPT_AUTO, DEVELOP_ADAPT_NONE, DEVELOP_ADAPT_LOCAL };
#define ADAPT_FROM_STOPS 2.5

#define DENOISED_WORDS "denoised preview, not for figures"

/* {0} is the default. */
typedef struct DevelopOptions {
    const char *exposure;       /* NULL "auto"; see exposure.h */
    const char *config;         /* OpenColorIO: a file, else $OCIO, else the project's own */
    bool own_config;            /* the project's own even with $OCIO: the same on any machine */
    const char *display, *view; /* NULL: the configuration's defaults; of the project's own
                                 * with an exposure "white:...", the view untonemapped */
    const char *layer;          /* NULL: R, G, B of the frame itself */
    bool false_colour;          /* luminance on a logarithmic scale */
    double range[2];            /* of false colours; both 0: what fits the frame */
    int adapt;                  /* DEVELOP_ADAPT_AUTO, _NONE or _LOCAL: adapt.h */
    bool is_denoised;           /* the frame is a filtered one: noted with the picture, by: */
    const char *eye;            /* as whose eye sees the frame, in words: noted as well */
    int bits;                   /* 0 or 8, or 16 */
    const char *frame_name;     /* for messages about its layers; may be NULL */
    int threads;                /* 0: one */
} DevelopOptions;

typedef struct DevelopReport {
    int width, height;            /* of the picture */
    bool is_developed;            /* by a view transform; false for data shown as it is */
    double grey_cd_m2;            /* what became middle grey; 0 when not developed */
    double ev;                    /* the same as an exposure value */
    bool is_adapted, is_denoised; /* a look, of which no figure may be taken */
    char eye[128];                /* as requested; else "" */
    char config[1024], display[128], view[128]; /* "" when not developed */
    long nonfinite_pixels;                      /* of light: NaN is shown black, infinity white */
    char scale[160]; /* of false colours: "0.1 to 1000 cd/m^2, logarithmic", else "" */
} DevelopReport;

/* The whole display window; what the data window does not cover is black. */
bool develop_picture(const FrameImage *frame, const DevelopOptions *options, Arena *arena,
                     Picture *out, DevelopReport *report, Error *err);

/* The same, written as PNG, JPEG or TIFF by the ending of `path`; how it was made stands in
 * the file's description. report may be NULL. */
bool develop_frame(const FrameImage *frame, const DevelopOptions *options, const char *path,
                   Arena scratch, DevelopReport *report, Error *err);

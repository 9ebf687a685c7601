/* SPDX-License-Identifier: Apache-2.0 */
/* layers.h -- the layers of a frame, one row each, and the sums that they are made of.
 *
 * A layer that is a mean over the samples is a row of FILM_LAYERS, a row of FILM_SUMS and the
 * member of FilmSample that it sums up; its name for --layers, its channels, its place in a
 * part of a frame and its range follow. One that is computed from sums has a reader besides
 * (film_frame.c). Bits and the order of sums are stored in files: add at the end.
 */
#pragma once

/* LAYER(NAME, bit, of, option, letters, reader, sums):
 *   of       DISPLAY: over the samples that saw a display; FRAME: any other
 *   option   its name for --layers, and that of its channels up to the dot
 *   letters  of its channels; "": its numbers have names of their own (film_frame.c)
 *   reader   of a pixel, without its read_; mean: of these sums */
#define FILM_LAYERS(LAYER) \
    LAYER(XYZ, 0, FRAME, "xyz", "XYZ", xyz, COUNT) \
    LAYER(DEPTH, 1, FRAME, "depth", "Z", mean, DEPTH) \
    LAYER(POSITION, 2, FRAME, "position", "XYZ", mean, POSITION) \
    LAYER(NORMAL, 3, FRAME, "normal", "XYZ", mean, NORMAL) \
    LAYER(ALBEDO, 4, FRAME, "albedo", "RGB", mean, ALBEDO) \
    LAYER(ID, 5, FRAME, "id", "", mean, COUNT) \
    LAYER(UV, 6, FRAME, "uv", "UV", mean, UV) \
    LAYER(VARIANCE, 7, FRAME, "variance", "RGB", variance, COUNT) \
    LAYER(HALVES, 15, FRAME, "halves", "RGB", halves, COUNT) \
    LAYER(SAMPLES, 8, FRAME, "samples", "", mean, COUNT) \
    LAYER(DISPLAY_EMITTED, 9, DISPLAY, "display.emitted", "RGB", mean, EMITTED) \
    LAYER(DISPLAY_REFLECTED, 10, DISPLAY, "display.reflected", "RGB", mean, REFLECTED) \
    LAYER(DISPLAY_WHITE, 11, DISPLAY, "display.white", "RGB", mean, WHITE) \
    LAYER(DISPLAY_BLACK, 12, DISPLAY, "display.black", "RGB", mean, BLACK) \
    LAYER(DISPLAY_ANGLES, 13, DISPLAY, "display.theta", "", mean, COUNT) \
    LAYER(DISPLAY_CONTRAST, 14, DISPLAY, "display.contrast", "", mean, COUNT) \
    LAYER(DISPLAY_FINE, 16, DISPLAY, "display.fine", "RGB", mean, FINE) \
    LAYER(DISPLAY_MIRROR, 17, DISPLAY, "display.mirror", "RGB", mean, MIRROR) \
    LAYER(DISPLAY_SCATTERED, 18, DISPLAY, "display.scattered", "RGB", scattered, COUNT) \
    LAYER(DISPLAY_HAZE, 19, DISPLAY, "display.haze", "RGB", haze, COUNT) \
    LAYER(DISPLAY_LAMBERTIAN, 20, DISPLAY, "display.lambertian", "RGB", mean, LAMBERTIAN) \
    LAYER(DISPLAY_VARIANCE, 24, DISPLAY, "display.variance", "RGB", display_variance, COUNT) \
    LAYER(DISPLAY_SECOND, 25, DISPLAY, "display.second", "RGB", second, COUNT) \
    LAYER(DISPLAY_EXTRAPOLATED, 27, DISPLAY, "display.extrapolated", "", mean, COUNT) \
    LAYER(DISPLAY_HALVES, 22, DISPLAY, "display.halves", "RGB", display_halves, COUNT) \
    LAYER(LIGHT, 21, FRAME, "light", "", mean, COUNT) \
    LAYER(STOKES, 23, FRAME, "stokes", "", mean, COUNT) \
    LAYER(ROUNDED, 26, FRAME, "rounded", "", mean, COUNT) \
    LAYER(EMITTED, 28, FRAME, "emitted", "RGB", emitted, COUNT)

/* SUMS(NAME, name, letters, users, member): sums with one number a letter.
 *   name, letters  in a part of a frame
 *   users          the layers that need them
 *   member         of FilmSample that is added, AT(member); OWN: film.c computes it
 * From EMITTED on they are over the samples that saw a display. */
#define FILM_SUMS(SUMS) \
    SUMS(DEPTH, "depth", "Z", LAYER_DEPTH, AT(depth)) \
    SUMS(POSITION, "position", "XYZ", LAYER_POSITION, AT(position)) \
    SUMS(NORMAL, "normal", "XYZ", LAYER_NORMAL, AT(normal)) \
    SUMS(ALBEDO, "albedo", "RGB", LAYER_ALBEDO, AT(albedo)) \
    SUMS(UV, "uv", "UV", LAYER_UV, AT(uv)) \
    SUMS(EMITTED, "emitted", "XYZ", \
         LAYER_DISPLAY_EMITTED | LAYER_DISPLAY_EXTRAPOLATED | LAYER_LIGHT_OF_DISPLAYS, \
         AT(emitted)) \
    SUMS(REFLECTED, "reflected", "XYZ", \
         LAYER_DISPLAY_REFLECTED | LAYER_DISPLAY_CONTRAST | LAYER_DISPLAY_SCATTERED | \
             LAYER_DISPLAY_HAZE | LAYER_DISPLAY_HALVES | LAYER_DISPLAY_EXTRAPOLATED | \
             LAYER_LIGHT_OF_DISPLAYS, \
         OWN) \
    SUMS(WHITE, "white", "XYZ", LAYER_DISPLAY_WHITE | LAYER_DISPLAY_CONTRAST, AT(white)) \
    SUMS(BLACK, "black", "XYZ", LAYER_DISPLAY_BLACK | LAYER_DISPLAY_CONTRAST, AT(black)) \
    SUMS(DIRECTION, "direction", "XYZ", LAYER_DISPLAY_ANGLES, OWN) \
    SUMS(FINE, "fine", "XYZ", LAYER_DISPLAY_FINE, AT(fine)) \
    SUMS(MIRROR, "mirror", "XYZ", \
         LAYER_DISPLAY_MIRROR | LAYER_DISPLAY_SCATTERED | LAYER_DISPLAY_HAZE, AT(mirror)) \
    SUMS(LAMBERTIAN, "lambertian", "XYZ", LAYER_NEEDS_LAMBERTIAN, AT(lambertian)) \
    SUMS(EXTRAPOLATED, "extrapolated", "ER", LAYER_DISPLAY_EXTRAPOLATED, AT(extrapolated)) \
    /* XYZ reflected in every second block, and how many samples that is of */ \
    SUMS(ODD, "odd_reflected", "XYZN", LAYER_DISPLAY_HALVES, OWN) \
    /* of displays' light, as PixelSums.squares */ \
    SUMS(SQUARES, "display_squares", "RrGgBb", LAYER_LIGHT_OF_DISPLAYS, OWN) \
    /* powers 1, 2 and 3 of the displays' ids, in ones, id times XYZ, and id times the squares, \
       small ones in steps of 2^-SHARED_LOW_BITS: what belongs to each of two displays follows \
       from these and the sums of both */ \
    SUMS(SHARED, "shared", "123XYZRrGgBb", LAYER_DISPLAY_SECOND, OWN) \
    /* of all samples */ \
    SUMS(STOKES, "stokes", "123", LAYER_STOKES, OWN) \
    SUMS(SOURCES, "sources", "XYZ", LAYER_EMITTED, OWN)

#define LAYER_BIT(NAME, bit, of, option, letters, reader, sums) LAYER_##NAME = 1 << (bit),
#define LAYER_OR(NAME, bit, of, option, letters, reader, sums) | LAYER_##NAME
#define LAYER_OR_FRAME(NAME)
#define LAYER_OR_DISPLAY(NAME) | LAYER_##NAME
#define LAYER_OR_OF(NAME, bit, of, option, letters, reader, sums) LAYER_OR_##of(NAME)

/* ROUNDED is no layer: variances and halves have 8 bits, which pack well. */
typedef enum FilmLayer {
    FILM_LAYERS(LAYER_BIT) LAYER_EVERY = 0 FILM_LAYERS(LAYER_OR),
    LAYER_DISPLAYS = 0 FILM_LAYERS(LAYER_OR_OF),
    LAYER_ALL = LAYER_EVERY & ~(LAYER_STOKES | LAYER_ROUNDED), /* which every render can have */
    LAYER_COMPARED = LAYER_VARIANCE | LAYER_DISPLAY_EMITTED | LAYER_DISPLAY_REFLECTED |
                     LAYER_DISPLAY_WHITE | LAYER_DISPLAY_BLACK | LAYER_DISPLAY_VARIANCE |
                     LAYER_DISPLAY_SECOND | LAYER_ROUNDED, /* what src/compare reads */
    LAYER_NEEDS_LAMBERTIAN = LAYER_DISPLAY_HAZE | LAYER_DISPLAY_LAMBERTIAN,
    LAYER_LIGHT_OF_DISPLAYS = LAYER_DISPLAY_VARIANCE | LAYER_DISPLAY_SECOND,
    LAYER_FEATURES = LAYER_ALL & ~(LAYER_XYZ | LAYER_VARIANCE | LAYER_SAMPLES | LAYER_HALVES |
                                   LAYER_LIGHT) /* need FilmSample's members from `hit` on */
} FilmLayer;

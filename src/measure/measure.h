/* SPDX-License-Identifier: Apache-2.0 */
/* measure.h -- figures of a part of a frame, with how sure they are.
 *
 * Units    luminance in cd m^-2; CIE 1931 x, y and CIE 1976 u', v'.
 * Intervals are 95 % confidence intervals of the render's noise; pixels are independent. From
 *          the frame's layer of halves where that suffices: what well-spread samples leave.
 *          Else from its variance layer, as if samples were independent, R, G and B of a pixel
 *          taken to rise and fall together for luminance and contrast: both too wide. They
 *          count as independent for chromaticity. Where a pixel shows a display alone, halves
 *          count for what is reflected (display.halves), and for what is shown the distance
 *          from display.emitted to display.fine, finer rays of their own points, whose noise
 *          makes it too wide: 1.0, 1.3 and 1.45 times for 32, 128 and 512 samples of the car's
 *          cluster at night, where halves would make it 1.4, 2.2 and 3.2 times. What a display
 *          reflects has halves of its own; without them the noise of what it shows counts for
 *          its contrast, too. A contrast falls as the reflected light rises: its interval goes
 *          from the one end of that light's to the other. The upper ends of that light and,
 *          from 16 pixels on, of the luminance have what few bright samples may have left out
 *          (confidence.h), as all estimates do (estimate/estimate.h); halves show no skewness.
 *          No interval of a display's luminance and colour is narrower than what channels in
 *          single precision leave, 1e-6 of the value.
 * Displays are measured by coverage (display_part.h): a pixel at the rim counts by its part,
 *          and with the display's own light, wherever the frame has the layers of it. Of frames
 *          that have not, rims are left out where display.coverage shows them; else pixels
 *          count whole, and have the light of what is around.
 * Pixels   outside a fisheye's circle are none.
 * Threads  pure functions.
 * Fails    when the frame lacks what is requested: the text names what to render again.
 */
#pragma once
#include "image/content_contrast.h"
#include "measure/display_part.h"

typedef struct MeasureRequest {
    const char *frame_name; /* for messages */
    bool has_region;
    ExrWindow region;    /* half-open, pixels of the display window */
    const char *display; /* only what this display sends; NULL: all pixels */
} MeasureRequest;

typedef struct FrameMeasurement {
    long pixels;    /* that were taken */
    long nonfinite; /* that were left out, NaN or infinite */
    RimCount rim;
    double area;            /* of the pixels taken, their parts added up */
    long rim_pixels;        /* of a display: that show something else, too; taken or left out */
    long shared_pixels;     /* of these, that show two displays: without a contrast */
    long unknown_pixels;    /* that show more displays, and were left out */
    double xyz[3];          /* mean, cd m^-2 */
    Measured luminance;     /* xyz[1] */
    double least, greatest; /* luminance of single pixels */
    Measured x, y, u, v;    /* of the mean colour; NaN for black */
    bool has_variance;
    bool has_contrast; /* some of the pixels show a display and the layers are there */
    long display_pixels;
    double white, black, reflected; /* means over the display's parts of pixels, cd m^-2 */
    double mirror;                  /* of the reflected, via the panel's mirror; NaN: not known */
    double lambertian;              /* and what its lambertian part scattered; NaN: not known */
    double extrapolated_shown, extrapolated_reflected; /* shares of what is shown and of what
                              is reflected, by directions that were not measured; NaN: not
                              known */
    double shown;                                      /* of its content, cd m^-2; NaN: not known */
    Measured contrast;       /* of these means: (white + reflected) / (black + reflected) */
    bool has_content;        /* a region or a display was requested */
    ContentContrast content; /* of what is shown there: characters on their ground */
} FrameMeasurement;

bool measure_frame(const FrameImage *frame, const MeasureRequest *request, Arena scratch,
                   FrameMeasurement *out, Error *err);

/* SPDX-License-Identifier: Apache-2.0 */
/* private_image.h -- what must not be read, as a pane of glass shows it to the eye: the
 * passenger's screen in the side window, by night above all.
 *
 *     C = (R H + B) / (R D + B),  V = (R H + B) / (R H - R D) = C / (C - 1),  S = log10 V
 *
 * H and D are the luminances that the symbol's brighter and darker part send to the pane, R the
 * share that the pane mirrors of them (both faces, coatings, the light's polarisation; of what
 * the whole box sends, so that of two colours in a tinted mirror it is the mean) and
 * B all else that the eye gets from there: what lies behind the glass, and what panes mirror
 * besides. V and S are those of vision/privacy.h, with B in the place of what the display
 * reflects. The image is reversed left to right; that makes nothing of it unreadable here.
 *
 * Units    cd m^-2; m, world; arc minutes.
 * Memory   lists and texts live in the review's arena. Threads: plain data, pure functions.
 */
#pragma once
#include "base/arena.h"
#include "review/verdict.h"

typedef struct CaseImage {
    const char *pane;     /* node and material */
    double eye_m[3];      /* of the eye's places the one by which it is read best */
    double shown_share;   /* of the symbol's box, 0..1 */
    double height_arcmin; /* of the image, as of ReviewCase */
    double sent_foreground, sent_background; /* towards the pane; NaN: it turns away */
    double reflectance;                      /* R, mean over what is shown */
    MeanInterval reflectance_range;
    double foreground, background; /* R times what is sent */
    double against;                /* B; at least what the request says */
    MeanInterval against_range;
    double contrast_ratio;              /* C; infinite before black, NaN where `sent` is */
    double contrast_low, contrast_high; /* 95 %: sampling, and the panel's stated error
                                of what it emits */
    Verdict verdict;                    /* by the limits of visual security that apply */
} CaseImage;

/* Sets foreground, background and the contrast with its interval from what is sent, R and B.
 * Each of R, B and the two luminances is moved to an end of its own interval, and what that
 * moves is added as squares (pane_verdict.h). emission_error: the panel's. */
void case_image_set_contrast(CaseImage *image, double emission_error);

/* The images of a case whose display is `factor` times as bright; from the arena. */
const CaseImage *case_images_scaled(const ReviewCase *c, double factor, Arena *arena);

/* The image that a limit of a case is about; NULL: the symbol itself. */
const CaseImage *case_image_of(const ReviewCase *c, const LimitVerdict *limit);

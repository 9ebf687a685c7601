/* SPDX-License-Identifier: Apache-2.0 */
/* review_live.h -- what the page's reader may move: the sun over a sweep, a picture's exposure
 * and its displays' brightness. The numbers for it stand in the page, packed, and are read by
 * review_live.js and review_look.js; without script the page is as it is without them.
 *
 * A sweep's luminances, levels and illuminances are 16 bits of a logarithm, within 0.03 %.
 *
 * A picture is a sum: its light without what displays emit to the eye, and that, which goes
 * with their brightness; both again as the eye spreads them, and as they are shown where the
 * frame is denoised. Each is a layer of 4 bytes a pixel in the manner of LogLuv (Larson 1998,
 * "LogLuv encoding for full-gamut, high-dynamic range images"): the logarithm of the luminance
 * in 4095 steps from 1e-5 to 1e10 cd m^-2, within LIVE_LAYER_ERROR, and CIE 1976 u', v' in
 * steps of 1/410.
 *
 * Units    cd m^-2, lx; degrees, azimuths of the vehicle.
 * Memory   what is packed grows in the arena; scratch by value.
 * Threads  pure.
 * Fails    when memory is out.
 */
#pragma once
#include "base/error.h"
#include "review/verdict.h"
#include "text/text.h"

/* ---- sweeps ------------------------------------------------------------------------------ */

typedef struct LiveSun {
    double azimuth_deg, elevation_deg;
    int    step, heading_id; /* step in time; into headings_deg */
} LiveSun;

/* Shared by the sweeps of a condition. */
typedef struct LiveSky {
    const LiveSun *suns;
    int            count;
    int            year;         /* 0: its suns have no date */
    double         step_minutes; /* a year's, from 1 January 0:00 UTC on */
    const double  *headings_deg;
    int            heading_count;
} LiveSky;

/* Arrays of sky->count. */
typedef struct LiveSweep {
    int                  sweep_id; /* into the review's */
    const LiveSky       *sky;
    int                  worst;    /* sun */
    const float         *reflected, *mirror, *level, *lux;
    const unsigned char *verdict, *ambient;
    double               foreground, background; /* emitted at level 1 */
    const LimitVerdict *const *asked; /* [4] the contrast limit of each ambient; NULL: none */
} LiveSweep;

/* ---- pictures ---------------------------------------------------------------------------- */

#define LIVE_LAYER_ERROR 0.0043 /* relative, above 1e-5 cd m^-2 */

/* R, G, B of Rec.709 in planes. Returns the packed layer, or NULL. */
const char *live_layer_pack(const float *const rgb[3], size_t count, Arena *arena, Error *err);

typedef struct LivePicture {
    const char *frame;  /* as cases name it */
    int         width, height;
    const char *scene, *displays;         /* packed layers */
    const char *eye_scene, *eye_displays; /* as an eye spreads them; NULL: not known */
    const char *clean_scene, *clean_displays; /* without most of the noise: what the picture
                                      shows, but no value; NULL: it shows the frame itself */
    const char *label;  /* of that picture: what it is not for */
    const char *beside; /* a script's name from the page on, which has the layers
                           (live_layers_write); NULL: they stand in the page */
    double      grey_cd_m2;               /* shown as middle grey at first */
    double      low, high;                /* ends of the false colours, cd m^-2 */
    double      age_years, pigment;       /* the eye's */
} LivePicture;

/* The script that picture->beside names. */
bool live_layers_write(const LivePicture *picture, const char *path, Error *err);

/* ---- all of it --------------------------------------------------------------------------- */

typedef struct ReviewLive {
    const LiveSweep   *sweeps;
    int                sweep_count;
    const LivePicture *pictures;
    int                picture_count;
    const char        *colours; /* the false colours: 256 of three bytes, base64 */
    const char        *beside;  /* a script's name from the page on, which has all of it
                                   (review_live_write); NULL: it stands in the page */
} ReviewLive;

/* The script that live->beside names. */
bool review_live_write(const Review *review, const ReviewLive *live, const char *path,
                       Error *err);

/* A block of JSON that is not shown, or what loads it: before the page ends. */
bool review_live_add(Text *html, const Review *review, const ReviewLive *live, Error *err);

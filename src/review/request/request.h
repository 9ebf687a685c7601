/* SPDX-License-Identifier: Apache-2.0 */
/* request.h -- what a review has to do: REVIEW.json as plain arrays.
 *
 * request_read.h reads it, request_check.h holds it against the scene.
 *
 * Units    as in the names: degrees, metres, lx, cd m^-2 (this is a file's border). Azimuths
 *          and headings from north over east. Positions and directions in the scene's frame
 *          (+Y up).
 * Files    paths stand as seen from the working folder: those of the file are resolved beside
 *          it, and may name only what lies near it (base/reference.h).
 * Memory   everything lives in the arena of whoever read it.
 * Threads  const after reading; pure functions.
 */
#pragma once
#include <stdbool.h>

#include "base/lines.h"
#include "review/verdict.h"
#include "scene/scene.h"
#include "sky/epw.h"
#include "sky/weather_clock.h"
#include "sky/weather_light.h"
#include "vision/human_eye.h"

/* ---- how bright displays are set --------------------------------------------------------- */

/* A level of one display, or of all others ("*"). Levels multiply all that a display emits; 1:
 * as its panel was measured. */
typedef struct ReviewFixedLevel {
    const char *display; /* a material's name, "node:NAME", or "*" */
    double level;
} ReviewFixedLevel;

/* Of all displays, where the sensor has so many lx. */
typedef struct ReviewLevelPoint {
    double lux, level;
} ReviewLevelPoint;

typedef struct ReviewLevel {
    const char *name;
    ReviewFixedLevel *fixed;
    int fixed_count;
    /* In place of fixed levels: a curve for all displays. */
    bool is_curve;
    double position_m[3], normal[3]; /* the sensor's, scene's frame; normal is unit */
    const ReviewLevelPoint *points;  /* lux rises, level does not fall */
    int point_count;
} ReviewLevel;

/* A display as a review calls it, and by its material where that is another name. */
typedef struct ReviewDisplayName {
    const char *name, *material;
} ReviewDisplayName;

/* sensor_lux counts for a curve only. Of fixed levels the one by the display's own name counts
 * first, then its material's, then "*"; a display that is left out keeps `scene_level`. */
double review_level_at(const ReviewLevel *level, ReviewDisplayName display, double scene_level,
                       double sensor_lux);

/* The curve's value at an illuminance. Between two points level = a lux^b, a straight line in
 * log-log: points stand decades apart, as the eye's adaptation runs, and what makers draw on
 * such paper must not sag at a decade's beginning as a line in lux would. Where a point is at 0
 * lx or level 0 that has no logarithm, and the piece is linear. Beyond the ends: the end's. */
double review_level_of_lux(const ReviewLevel *level, double lux);

/* ---- a mirrored vehicle ------------------------------------------------------------------ */

/* The plane at which a variant mirrors the vehicle, as scene/change/mirror_change.h. */
typedef struct ReviewMirror {
    double across[3]; /* unit, scene's frame: the vehicle's right */
    double middle_m;  /* along it */
} ReviewMirror;

/* NULL: it stays where it is. */
void review_mirror_point(const ReviewMirror *mirror, double p[3]);
void review_mirror_direction(const ReviewMirror *mirror, double d[3]);

/* ---- eyes and where they look ------------------------------------------------------------ */

typedef enum ReviewEyeKind { EYE_CAMERA, EYE_POINT, EYE_BOX, EYE_ELLIPSE } ReviewEyeKind;

typedef struct ReviewEye {
    const char *name;
    ReviewEyeKind kind;
    const char *proposed_from;  /* by `--init` or `equip`, and nobody has said since that it
                                   is right; NULL: it was given */
    const char *camera;         /* camera: its name; NULL: camera_id counts it */
    int camera_id;              /* camera: its index; NO_ID: it is named */
    double position_m[3];       /* point; box, ellipse: its centre */
    double half_size_m[3];      /* box */
    int grid[3];                /* box: points along each axis, both ends in; 1: the middle */
    double axes_m[3];           /* ellipse: their lengths ahead, across and up */
    double tilt_deg;            /* ellipse: its front down, about the axis across */
    double half_axes_m[3][3];   /* ellipse: half of each, scene's frame */
    double move_m[3];           /* a variant's offset, scene's frame; else 0 */
    const ReviewMirror *mirror; /* a variant's, after that; else NULL */
} ReviewEye;

/* Points of a drivers' eye ellipse (SAE J941): its middle, the ends of its axes and the points
 * halfway between those of all three, on its surface. */
#define ELLIPSE_POINTS 15

/* A box has grid[0] * grid[1] * grid[2] points, x fastest; an ellipse ELLIPSE_POINTS, its
 * middle first; other eyes one. */
int review_eye_count(const ReviewEye *eye);

/* An eye of several points. */
bool review_eye_is_wide(const ReviewEye *eye);

/* Point i of an eye that is no camera. */
void review_eye_point(const ReviewEye *eye, int i, double out_m[3]);

/* The road that a gaze goes to, lit by night: its threshold increment is evaluated
 * (vision/road_glare.h). */
typedef struct ReviewRoad {
    double luminance_cd_m2;        /* photopic, mean, of the road itself */
    double s_p;                    /* scotopic over photopic, of its light; NaN: not given */
    const double *ages;            /* years */
    int age_count;                 /* 0: the request's observer alone */
    const double *dimming;         /* cd m^-2, rising: roads of the table of levels */
    int dimming_count;             /* 0: the program's own (ROAD_DIMMING) */
    const char *const *conditions; /* names of those in which it is evaluated */
    int condition_count;           /* 0: all moments without the sun. Sweeps that are
                                      named: without sun and sky */
} ReviewRoad;

#define ROAD_AGES_MOST 6
#define ROAD_DIMMING_MOST 12

/* Is the gaze's road evaluated in that condition, as far as the request says? */
bool review_road_is_in(const ReviewRoad *road, const char *condition);

typedef struct ReviewGaze {
    const char *name;       /* "symbols" when it goes to each symbol */
    const ReviewRoad *road; /* NULL: none is stated */
    bool at_symbols;
    double direction[3]; /* unit; else */
    bool *for_eye;       /* [eye_count]: whether that eye looks so */
} ReviewGaze;

/* ---- what is read ------------------------------------------------------------------------ */

/* Which part of the content is the foreground; AUTO: found from the rectangle itself. */
typedef enum ReviewPolarity {
    POLARITY_AUTO,
    POLARITY_LIGHT_ON_DARK,
    POLARITY_DARK_ON_LIGHT
} ReviewPolarity;

typedef struct ReviewSymbol {
    const char *name;
    const char *display; /* a material's name, or "node:NAME" */
    const char *content; /* picture; NULL: what the display shows in the scene */
    const char *mask;    /* picture of the content's size, white: foreground; NULL: none */
    bool has_uv;
    double uv[4];   /* left, top, right, bottom of the content; else all of it */
    bool find_text; /* symbols are to be found inside uv */
    ReviewPolarity polarity;
    const int *optional_for;  /* [eye_count]: 1: that eye need not see it; what it does see
                                 of it is judged all the same. NULL: all 0 */
    const bool *private_for;  /* [eye_count]: that eye must not read it. NULL: none */
    const int *distinct_from; /* symbols that its colour must not be taken for */
    int distinct_count;
} ReviewSymbol;

/* Of what must not be read. */
typedef struct ReviewPrivacy {
    bool is_given;
    double security_min; /* S (vision/privacy.h), above 0 */
} ReviewPrivacy;

/* More files of a scene: occupants. */
typedef struct ReviewWith {
    const char *name;
    const char **paths;
    int path_count;
} ReviewWith;

/* ---- conditions -------------------------------------------------------------------------- */

typedef enum ReviewConditionKind {
    CONDITION_MOMENT, /* the environment as it stands */
    CONDITION_SUN_SWEEP,
    CONDITION_YEAR_SWEEP
} ReviewConditionKind;

/* first, first + step ... last: both ends in, a whole number of steps. */
typedef struct ReviewRange {
    double first, last, step;
    int count; /* at least 1 */
} ReviewRange;

double review_range_value(const ReviewRange *range, int i);

typedef struct ReviewContent {
    const char *display, *path;
} ReviewContent;

/* What every eye wears (review/light/glasses.h). */
typedef struct ReviewGlasses {
    const char *words;    /* as the request says */
    double transmittance; /* luminous, (0, 1]; unused with a curve */
    const Curve *curve;   /* at each wavelength; NULL: grey */
    bool is_polarising;
    double axis_deg;   /* along which light comes through, from upright to the right */
    double extinction; /* light along it over light across it, at least 1 */
} ReviewGlasses;

typedef struct ReviewCondition {
    const char *name;
    const ReviewGlasses *glasses; /* NULL: none */
    ReviewConditionKind kind;
    bool has_environment;    /* moment without: as in the scene's files. Sweeps:
                                air and ground of a clear sky, whose sun is replaced */
    Environment environment; /* its heading as below, forward as the request's */
    const char **lights;     /* more files of the scene */
    int light_count;
    bool has_heading; /* none: a moment's environment's own; sun sweep: the azimuths
                         are the vehicle's, 0 ahead and 90 right */
    double heading_deg;
    int level_id;             /* into levels; NO_ID: the scene's own */
    int with_id;              /* into withs; NO_ID: nobody */
    ReviewPolarity *polarity; /* [symbol_count]: the symbol's own where none is given */
    ReviewContent *contents;  /* shown instead of the symbols' and the scene's */
    int content_count;
    /* sweep over the sun's direction, in a clear sky */
    ReviewRange azimuth_deg, elevation_deg;
    /* sweep over a year, UTC: steps from 1 January 00:00 to the year's end */
    int year;
    int weather_id;         /* into weathers; NO_ID: clear */
    WeatherLux weather_lux; /* by what its lux are known */
    SkyPlace where;         /* year; the weather file's where none is given */
    double step_minutes;
    const double *headings_deg;
    int heading_count;
    bool with_night; /* hours without sun count too */
} ReviewCondition;

/* A weather file, which may have gaps, and which instants it means. */
typedef struct ReviewWeather {
    const char *path;
    Weather weather;
    WeatherClock clock;
} ReviewWeather;

/* ---- variants ---------------------------------------------------------------------------- */

/* Differences from the review itself; what is not named stays as it is. */
typedef struct ReviewChange {
    const char *place;        /* JSON path of the variant */
    const SceneChange *scene; /* nodes, materials, hoods, the mirror */
    int scene_count;
    const SceneOverride *panels; /* by display: a file */
    int panel_count;
    const ReviewContent *contents; /* in every condition */
    int content_count;
    const ReviewFixedLevel *brightness; /* multiplies the level that a display has from
                                           anywhere; the display's own name counts first, then
                                           its material's, then "*" */
    int brightness_count;
    const ReviewMirror *mirror; /* what `scene` mirrors; NULL: nothing is */
} ReviewChange;

typedef struct ReviewVariant {
    const char *name;
    const char **words; /* its changes in words, one text a change */
    int word_count;
    ReviewChange change;
    ReviewLevel *levels; /* take the places of those of their names */
    int level_count;
    const char **scenes; /* in place of the review's */
    int scene_count;     /* 0: the review's scenes */
    const char **more;   /* files besides */
    int more_count;
    double (*eye_moves)[3]; /* m, one an eye */
} ReviewVariant;

/* Where a display's surface is: all parts of its material, or those of one node. */
typedef struct ReviewDisplay {
    int display_id;
    const int *part_ids;
    int part_count; /* at least 1 */
} ReviewDisplay;

/* ---- displays in glass ------------------------------------------------------------------- */

/* A part of the view that images of displays in glass are kept out of: a cone. */
typedef struct ReviewPaneArea {
    const char *name;
    double direction[3];  /* unit: its axis */
    double within_deg;    /* half its width */
    double contrast_most; /* that an image in it may have; NaN: no limit */
} ReviewPaneArea;

typedef struct ReviewPaneImages {
    double within_deg;    /* of areas that say none, and about each gaze that has a
                             direction; without either about `forward` */
    double contrast_most; /* of areas that say none, and of those; NaN: no limit */
    double against_cd_m2; /* what images are seen against has at least this */
    ReviewPaneArea *areas;
    int area_count;
} ReviewPaneImages;

/* ---- all of it --------------------------------------------------------------------------- */

typedef struct ReviewFrames {
    int width, height; /* pixels */
    double noise;      /* relative error, 0..1 */
    int worst;         /* how many of the worst cases are rendered; 0: none */
    bool is_denoised;  /* as pictures: what is measured of a frame never is */
    bool has_variants; /* the worst is rendered with each, too */
} ReviewFrames;

/* For whom visibility levels are told besides the observer, and of how long a glance. */
typedef struct ReviewVisibility {
    bool is_asked;
    double glance_s;    /* VISIBILITY_GLANCE_LONG and more: as long as it takes */
    const double *ages; /* years */
    int age_count;
} ReviewVisibility;

#define REVIEW_AGES_MOST 8

/* A file that was read, for provenance. */
typedef struct ReviewInput {
    const char *path;
    uint64_t hash; /* XXH3 64 */
} ReviewInput;

typedef struct ReviewRequest {
    const char *file;  /* REVIEW.json as the user named it */
    const char *title; /* the file's name where none is given */
    ReviewDocument document;
    const char **scenes; /* paths, the first holds the displays */
    int scene_count;
    ReviewEye *eyes;
    int eye_count;
    double forward[3]; /* where the vehicle points: unit, not vertical */
    HumanEye observer;
    ReviewVisibility visibility;
    ReviewGaze *gazes;
    int gaze_count;
    ReviewWith *withs;
    int with_count;
    ReviewSymbol *symbols;
    int symbol_count;
    ReviewPrivacy privacy;
    const char *profile; /* a name of assets/profiles */
    ReviewLevel *levels;
    int level_count;
    double max_level; /* that levels may have; 1 where the file says nothing */
    ReviewCondition *conditions;
    int condition_count;
    ReviewWeather *weathers;
    int weather_count;
    double precision_contrast; /* relative standard error required */
    double precision_clear;    /* enough where the verdict is clear; at least that */
    int precision_paths;       /* at most for one reading; one that is not sure then
                                  has a wider interval */
    uint32_t seed;             /* random seed: another one takes other paths of the same light;
                                  0 as a rule */
    ReviewFrames frames;
    const ReviewPaneImages *pane_images; /* NULL: displays in glass are not looked for */
    ReviewVariant *variants;
    int variant_count;
    bool is_compared;           /* has variants that change more than levels, or is one of
                                   them: read from more paths (run/cases.c) */
    const ReviewChange *change; /* this variant's; NULL: the review itself */
    bool is_relevelled;         /* it changes levels of displays and nothing else */
    ReviewInput *inputs;        /* the file itself, weathers, skies' pictures */
    int input_count;
} ReviewRequest;

/* Every file that it reads, or names as a scene or a mask. */
Lines review_request_files(const ReviewRequest *request, Arena *arena);

/* A probe's random seed: `base`, hashed with the request's seed unless that is 0. Other seeds
 * show how much of a result is chance. */
uint32_t review_seed(const ReviewRequest *request, uint32_t base);

/* The request as a variant has it, with no variants of its own. */
ReviewRequest review_request_variant(const ReviewRequest *request, const ReviewVariant *variant,
                                     Arena *arena);

/* Whether anything that is to be compared changes more than levels. */
bool review_is_compared(const ReviewRequest *request);

/* What progress counts: a step a symbol and eye, and a gaze, of a moment; of a sweep one for
 * the response and one for its suns; a frame. As many as the request names: where a symbol is
 * text to be found there may be more of it. */
int review_condition_steps(const ReviewRequest *request, const ReviewCondition *condition);
int review_steps(const ReviewRequest *request, const bool *only); /* [condition]; NULL: all */

/* The factor on a display's level; 1 where no change sets it. */
double review_brightness(const ReviewRequest *request, ReviewDisplayName display);

/* Need that eye not see the symbol? */
bool review_is_optional(const ReviewRequest *request, int symbol_id, const ReviewEye *eye);

/* Must that eye not read the symbol? And is there any that must not be read? */
bool review_is_private(const ReviewRequest *request, int symbol_id, const ReviewEye *eye);
bool review_has_private(const ReviewRequest *request);

/* NULL: there is none. */
const ReviewCondition *review_condition_named(const ReviewRequest *request, const char *name);
const ReviewEye *review_eye_named(const ReviewRequest *request, const char *name);

/* Does that eye look so, elsewhere than at symbols? And how many such pairs are there? */
bool review_is_look(const ReviewGaze *gaze, int eye_id);
int review_look_count(const ReviewRequest *request);

/* SPDX-License-Identifier: Apache-2.0 */
/* verdict.h -- the results of a glare review: for one symbol, seen by one eye under one
 * condition; for a sweep over many suns; for all of them.
 *
 * Units    cd m^-2, arc minutes, degrees. Azimuths from north over east. Points in the
 *          coordinates of the case's scene.
 * Memory   its maker owns it; texts and lists live in the review's arena.
 * Threads  plain data.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "base/confidence.h"
#include "base/vec.h"

/* The four outcomes. Pass: the whole 95 % interval of each figure that is required keeps its
 * limit; fail: that of one breaks it; too close: a limit lies within; unjudged: something that
 * is required is not known, and Unjudged says why. */
typedef enum Verdict { VERDICT_PASS, VERDICT_FAIL, VERDICT_TOO_CLOSE, VERDICT_UNJUDGED } Verdict;
/* Here and below NULL ends the words. "pass", "fail", "too close", "cannot be judged". */
extern const char *const verdict_names[5];

/* How bad it is: pass 0, too close 1, cannot be judged 2, fail 3. */
int verdict_rank(Verdict verdict);

/* Why a case cannot be judged. */
typedef enum Unjudged {
    UNJUDGED_NOT,    /* it can */
    UNJUDGED_HIDDEN, /* less than SEEN_LEAST of it is seen */
    UNJUDGED_PANEL,  /* its panel says of itself that it is not usable */
    UNJUDGED_DATA,   /* more than UNJUDGED_DATA_SHARE of the light by things without data */
    UNJUDGED_LIMIT,  /* no limit that counts applies to it */
    UNJUDGED_FIGURE, /* a figure that a limit is about could not be found out */
    UNJUDGED_COUNT
} Unjudged;
extern const char *const unjudged_names[UNJUDGED_COUNT + 1]; /* NULL, "hidden", "panel", ... */

/* Share of the reflected light above which materials without data decide the contrast: a limit
 * of 2 : 1 is then missed or met by what nobody measured. */
#define UNJUDGED_DATA_SHARE 0.1

/* What keeps a case open that is too close: sampling, which more paths lessen; or, whatever
 * their number, what its panel states of its own errors, what is known of the sun's image in
 * its mirror, of a visibility level of the veil in the eye, or of a symbol's image in glass. */
typedef enum OpenBy {
    OPEN_NOT,
    OPEN_BY_PATHS,
    OPEN_BY_PANEL,
    OPEN_BY_SUN,
    OPEN_BY_VEIL,
    OPEN_BY_IMAGE,
    OPEN_COUNT
} OpenBy;
extern const char *const open_names[OPEN_COUNT + 1]; /* NULL, "paths", "panel error", ... */

/* The least share of the box about a symbol's foreground that an eye must see: of a half or
 * less, what is seen may be another symbol, such as 3 for 38 or for 8. */
#define SEEN_LEAST 0.5
bool review_is_seen(double visible_share);

typedef enum Ambient { AMBIENT_NIGHT, AMBIENT_TWILIGHT, AMBIENT_DAY, AMBIENT_SUN } Ambient;
extern const char *const ambient_names[5]; /* "night", "twilight", "day", "sun" */

/* Half a 95 % interval, in standard errors. */
#define INTERVAL_SIGMAS 1.959964

/* (brighter + added) / (darker + added) of two luminances, cd m^-2; infinite over 0, 1 of two
 * zeros. */
double luminance_contrast(double one, double other, double added);

/* The judged quantity: a limit of the profile, held against what was found. `value`, `found`,
 * `low` and `high` are of the limit's own kind, in its unit; whatever is printed beside each
 * other comes from one of these (review_words.h).
 *
 * Margin: how far the figure is beyond its limit, on a scale on which full wash-out, nothing
 * that stands out, is -1 (-100 %) for every limit and 0 lies on the limit. With the progress
 * p = ln(ratio) of all kinds of contrast, each turned into the contrast ratio that it stands
 * for (judge.h), and p = figure of heights and strokes: p(found) / p(value) - 1, of an upper
 * limit p(value) / p(found) - 1. Of visual security p is the figure S itself: -1 is a picture
 * of which nothing is hidden. */
typedef struct LimitVerdict {
    const char *name, *kind, *unit, *source;
    double value; /* the limit */
    bool read_in_the_standard;
    bool is_upper;    /* the most, not the least */
    bool is_advice;   /* preferred, not required: shown, and not counted */
    double found;     /* NaN: nothing to hold against it */
    double low, high; /* 95 % interval of `found`; equal where it is exact */
    double margin;    /* above; NaN where `found` is */
    Verdict verdict;
    double age_years;    /* of a visibility level: who has it; 0 or NaN: nobody */
    const char *by_pane; /* of a symbol's image in glass (private_image.h); NULL: itself */
    const char *beside;  /* the symbol from which a colour differs least; NULL: it is about one */
    double sampling[2];  /* Figure's (quantity.h) */
    bool is_veils[2];
    bool has_veil; /* the veil in the eye counts in `found` */
} LimitVerdict;

/* What a display's panel says of itself (panel/query/panel_stated.h). */
typedef struct CasePanel {
    const char *verdict; /* "good", "usable with care", "not usable"; NULL: nothing */
    const char *reason;  /* the worst of its reasons; NULL: none */
    bool is_coarse;      /* a reason begins with "coarse" */
    bool is_unusable;    /* its verdict is "not usable" */
    double emission_error, reflection_error; /* relative, rms over all that was measured;
                                                0: not stated */
    const char *assumed; /* of the emission's spectra, in words; NULL: nothing */
} CasePanel;

/* A ray of a cause, m: from the eye over what it meets to where the light began. */
typedef struct CaseRay {
    const Vec3 *points;
    int count;
} CaseRay;

/* A way by which light comes to the symbol: "glass Window_FL: through", ... in the order in
 * which the eye's ray meets them. */
typedef struct CaseCause {
    const char *const *chain;
    int links;
    double share;            /* of the reflected light, 0..1 */
    double cd_m2, low, high; /* the cause's light, and its 95 % interval */
    double contrast_without; /* the case's contrast if this light were not; NaN: none */
    const CaseRay *rays;     /* some of it, drawn with a chance that goes with their light */
    int ray_count;
} CaseCause;

/* The share of one thing in the reflected light. */
typedef struct CaseShare {
    const char *what;
    double share, cd_m2; /* 0..1 */
} CaseShare;

/* A thing that hides a share, 0..1, of the box about a symbol's foreground from an eye. */
typedef struct CaseHider {
    const char *what; /* a node and its material, or that it shows its back */
    double share;
} CaseHider;

/* All of the reflected light by one kind of thing, greatest first, "other" last: shares add up
 * to 1. */
typedef struct CaseGroup {
    const CaseShare *list;
    int count;
} CaseGroup;

typedef enum CauseGroup {
    GROUP_LIGHT,   /* where it began: sun, sky, a lamp, a display */
    GROUP_OPENING, /* the last pane that it passed, or none */
    GROUP_SURFACE, /* what the symbol mirrors or is lit by: a surface, or a light by itself */
    CAUSE_GROUPS
} CauseGroup;

/* How a picture shows the world: what stands at `eye` + x right + y up + z forward is, of a
 * perspective view, at x / z of half_width and y / z of half_height from its middle; else at x
 * and y. */
typedef struct CaseView {
    Vec3 eye, right, up, forward; /* m; unit */
    bool is_perspective;
    double half_width, half_height;
    int width, height; /* pixels */
} CaseView;

/* What passes and no longer does once a display stands at another level. */
typedef struct RemedyBreak {
    const char *subject, *viewer; /* Finding's */
    LimitVerdict line;            /* judged again with it */
} RemedyBreak;

/* A change that would remedy the case, or help. */
typedef struct CaseRemedy {
    const char *what;
    double contrast_ratio; /* with it */
    double level;          /* of the display with it; NaN: the figure has no meaning */
    LimitVerdict then;     /* the limit that it is to remedy, judged again with it */
    Verdict verdict;       /* the case's with it */
    const RemedyBreak *breaks;
    int break_count;
} CaseRemedy;

typedef struct CaseLuminances {
    double foreground, background; /* emitted to the eye */
    double reflected;              /* by the part that is judged; all that is reflected */
    double mirror, scattered;      /* the reflected light's two parts */
    double veil;                   /* that stray light lays over the gaze point, in the eye */
} CaseLuminances;

/* A rectangle of a display's content, uv. */
typedef struct CaseBox {
    double left, top, right, bottom;
} CaseBox;

/* A symbol as a whole, beside the part of it that is judged. */
typedef struct CaseWhole {
    CaseBox part;                 /* which that is */
    double reflected;             /* mean over all that is visible of the box about its
                                     foreground, cd m^-2; NaN: not known */
    MeanInterval reflected_range; /* 95 % */
    double contrast_ratio;        /* by that mean, veil included where the profile counts it;
                                     NaN likewise */
    double lit_share;             /* of the whole, 0..1, in the direct sun; NaN: no sun */
} CaseWhole;

CaseWhole case_whole_unknown(void);

/* How a symbol stands above what somebody of an age just sees (vision/visibility.h). The target
 * is one of its strokes, as wide as that, before its background. */
typedef struct CaseVisibility {
    double age_years;
    bool is_observer;   /* the request's observer */
    double size_arcmin; /* of the target */
    double glance_s;
    double veil_times;      /* stray light in that eye, over that in the observer's */
    double veil_doubt;      /* half its 95 % interval, over it; 0: not known */
    double adapted_cd_m2;   /* background, reflected light and veil, through the sunglasses */
    double threshold_cd_m2; /* the least difference that is seen */
    double level;           /* times that it differs; NaN: not known */
    double low, high;       /* 95 %: of what is reflected, of the veil, and of the panel's
                               stated errors */
    const char *doubts;     /* where the formula is doubtful; NULL: nowhere */
    double sampling[2];     /* Figure's (quantity.h) */
    bool is_veils[2];
} CaseVisibility;

/* A place of an eye box or ellipse, and how it sees what must not be read: read by few paths,
 * as is enough to find the worst of all. */
typedef struct CasePlace {
    double eye_m[3]; /* world */
    Verdict verdict;
    double visible_share;
    double contrast_ratio; /* NaN: nothing of it is seen */
    double contrast_low, contrast_high;
} CasePlace;

#define CASE_BATCHES 32

/* The light of a symbol's brighter part as it comes to the eye, XYZ in cd m^-2. */
typedef struct ColourLight {
    double emitted[3], reflected[3], veil[3]; /* veil: in the eye; 0: it does not count */
    double lit;                               /* the case's luminance of the part then */
    MeanInterval range;                       /* of reflected[1] */
    double batches[CASE_BATCHES][3];          /* of what is reflected, by independent batches */
    double emission_error, reflection_error;  /* CasePanel's */
    bool is_on_display;                       /* on that of the case */
} ColourLight;

/* The colour of a symbol as it is seen, and how far that is from another: Delta u'v' of CIE 1976
 * (ask_colour.h). */
typedef struct CaseColour {
    const char *symbol;       /* the case's own, or one that it must be told from */
    double uv[2], dark_uv[2]; /* u', v': as it is seen; alone, in the dark */
    double apart;             /* its own: between these two; another: between both as they are
                                 seen, by the same eye in the same light */
    double low, high;         /* 95 % */
    double sampling;          /* the share of that interval which more paths lessen */
    ColourLight *light;       /* of which it is made; NULL: it is not kept */
} CaseColour;

typedef struct ReviewCase {
    const char *condition, *eye, *symbol, *display;
    Ambient ambient;
    const char *when;                          /* of a sweep's worst: date, time, heading; NULL: the
                                                  condition's */
    bool has_sun;                              /* above the horizon */
    double sun_azimuth_deg, sun_elevation_deg; /* of a sweep's worst: of the vehicle */
    CaseLuminances luminance_cd_m2;
    CaseWhole whole;
    MeanInterval reflected_range;       /* of sampling alone; of a sweep's steps of the response
                                          too. The contrasts are made of these luminances
                                          (judge_contrasts) */
    double contrast_ratio;              /* (brighter + reflected) / (darker + reflected) */
    double contrast_low, contrast_high; /* 95 %: of sampling, and of the panel's stated
                                           errors (judge_contrasts) */
    double contrast_with_veil;
    double sampling_share[2]; /* of what more paths lessen in the ratio's doubt below and above,
                                 0..1 */
    double height_arcmin;     /* the foreground's extent along the content's v */
    double stroke_ratio;      /* its strokes' width over a character's height; NaN: it has
                                 no strokes (judge.h) */
    double jnd;               /* steps of DICOM's GSDF between the two, veil included */
    double visibility;        /* Michelson contrast, veil included, by the least that an eye
                                 sees of strokes that wide (Barten) */
    const CaseVisibility *visibilities; /* the observer's first; none: nobody asked */
    int visibility_count;
    const CaseColour *colours; /* its own first, then those that it must be told from and that
                                  are seen; none: nobody asked, or the case is a step of a sweep */
    int colour_count;
    long paths;                  /* that what is reflected was read from */
    const double *batches;       /* [CASE_BATCHES] estimates by independent batches of them, cd
                                    m^-2, whose mean is luminance_cd_m2.reflected; NULL: not
                                    known */
    double precision_asked;      /* of the contrast, relative: coarser where the verdict is
                                    clear; NaN: nothing is visible */
    double precision_reached;    /* its standard error, relative; NaN likewise */
    double alike_within;         /* of a variant: the reading is the review's, from which its own is
                                    no further than this share (run/alike.h); NaN: it was read by
                                    itself */
    const struct CaseKept *kept; /* of the review's, for that (run/cases.c); NULL: nothing is */
    OpenBy open_by;              /* what keeps a case open that is too close */
    double visible_share;        /* of the box about its foreground, 0..1 */
    const CaseHider *hiders;     /* of all else, greatest first: with it they add up to 1 */
    int hider_count;
    double eye_failed_share; /* of an eye box's points: those that fail; NaN: one point */
    double eye_m[3];         /* where the eye was, world; of a box its worst point */
    double origin_m[3];      /* of the scene that it was (scene/scene.h): its rays, view and
                                rim are in its coordinates */
    bool is_optional;        /* the request says that this eye need not see it */
    bool must_not_be_read;   /* nor may it read it: the verdict is of that (judge.h) */
    const CasePlace *places; /* of that, and of an eye box or ellipse: all of its points */
    int place_count;
    const struct CaseImage *images; /* of that: by panes (private_image.h) */
    int image_count;
    double level;                 /* at which the display was set, 1: as measured */
    double glasses_transmittance; /* luminous, of the observer's sunglasses; 1: none. All
                                   luminances are reported without that factor */
    const char *glasses;          /* the sunglasses in words; NULL: none */
    double glasses_display_loss;  /* the share of the symbol's own light that they take beyond
                                    what they take of any: by a polariser or their colour */
    CasePanel panel;              /* what the display's panel says of itself */
    double own_reflected;         /* cd m^-2 of what is reflected that began at the display
                                     itself; NaN: not known */
    double veil_displays;         /* cd m^-2 of the veil, at most, that grow with the display's
                                     level; 0: nothing is known of it */
    double display_lux;           /* illuminance of the display's face */
    const LimitVerdict *limits;   /* all that apply */
    int limit_count;
    int limit_id;            /* the contrast limit that required the most; -1: none */
    double margin;           /* of the limit limit_id; NaN: there is none */
    Verdict verdict;         /* the worst of its limits' that count */
    Unjudged unjudged;       /* why it cannot be judged */
    const CaseCause *causes; /* greatest first */
    int cause_count;
    CaseGroup groups[CAUSE_GROUPS];
    double without_data_share; /* of the reflected light, via materials without data */
    double guessed_share;      /* of it, via materials that `equip` guessed */
    double extrapolated_share; /* of it, as the panel extrapolates what was measured */
    const char *empty_seat;    /* its back, behind an eye where nobody sits, via which much of
                                  the reflected light comes; NULL: none */
    double empty_seat_share;   /* of the reflected light */
    CaseRemedy *remedies;      /* a brightness; or none */
    int remedy_count;
    const char *frame;    /* picture's name within the folder; NULL: none was rendered */
    const CaseView *view; /* of the frame; NULL: not known */
    const Vec3 *rim;      /* once around the symbol, m; of a case without a frame
                             of its own none */
    int rim_count;
} ReviewCase;

/* Does it count, and lie within the interval of its figure? */
bool limit_is_open(const LimitVerdict *limit);

/* Is it too close, and would no number of paths decide it? */
bool case_is_undecidable(const ReviewCase *c);

/* Is enough of it seen to judge it? Of what must not be read, anything. */
bool case_is_seen(const ReviewCase *c);

/* What keeps it from being read, where it must not be read and cannot: nothing of it is seen;
 * else its contrast is as low as its limit of visual security requires. */
typedef enum KeptBy { KEPT_NOT, KEPT_HIDDEN, KEPT_SECURITY, KEPT_COUNT } KeptBy;
extern const char *const kept_names[KEPT_COUNT + 1]; /* NULL, "hidden", "visual security" */
KeptBy case_kept_by(const ReviewCase *c);

/* A case of which no figure is known: all are NaN, and nothing is seen. */
ReviewCase review_case_unknown(void);

/* Does it count? Not where a symbol that need not be seen is hidden, nor where nothing is
 * required of it. */
bool review_case_counts(const ReviewCase *c);

/* The veil in the eye, by where its light begins: the parts add up to it. */
typedef struct GazeVeil {
    double sun, sky, lamps; /* seen straight or through glass; lamps: displays too */
    double glints;          /* sun, lamps and displays via mirrors and panes alone */
    double surfaces;        /* all else: what is lit, and the sky in mirrors */
    double near;            /* sky and surfaces within 1 degree: what the eye looks at */
} GazeVeil;

typedef struct GazeRoad GazeRoad; /* road_verdict.h */

/* The view of an eye that looks elsewhere than at a symbol, such as at the road, and what is
 * lost to it. */
typedef struct GazeFinding {
    const char *condition, *eye, *gaze;
    double sun_deg; /* between the gaze and the sun, seen or not; NaN: none is up */
    double veil;    /* cd m^-2, that stray light lays over the gaze, in the eye */
    MeanInterval veil_range;
    GazeVeil veil_parts;
    double cornea_lux; /* of the pupil's plane */
    double through;    /* cd m^-2 along the gaze: what it looks at, as it arrives */
    double mirrored;   /* cd m^-2, what a pane mirrors over `through` */
    MeanInterval mirrored_range;
    const char *mirrored_by;   /* the pane that mirrors most; NULL: nothing is mirrored */
    const char *mirrored_from; /* what most of it shows; NULL likewise */
    /* Shares of a distant object's contrast: both veils add to the object and to its
     * background alike (CIE S 017, "equivalent veiling luminance": of disability glare or of
     * veiling reflections), so that Weber's contrast (L - B)/B keeps B/(B + veils) of itself.
     * What is near is the background B, and no veil. NaN: no light. */
    double contrast_behind_glass; /* what the mirrored light leaves; 1: all */
    double contrast_left;         /* what that and the veil in the eye leave together */
    MeanInterval contrast_range;  /* of contrast_left */
    GazeRoad *road;               /* it is at a road lit by night; NULL: not stated */
    const LimitVerdict *limits;   /* all that apply, by age where it is somebody's */
    int limit_count;
    Verdict verdict; /* the worst of them */
    Unjudged unjudged;
} GazeFinding;

/* Contrast left below which a gaze is marked as poor: half is lost. No limit. */
#define GAZE_POOR 0.5

/* One symbol and eye over many suns. */
typedef struct ReviewSweep {
    const char *condition, *eye, *symbol;
    long cases;
    double failed_share;            /* of its steps, weighted by time, as suns/sweep_suns.h
                                       counts it: the verdict is the worst's, which was
                                       read again */
    double longest_failure_minutes; /* at a stretch; NaN: the sweep has no times */
    double failed_minutes;          /* that share of the time that is swept, under one heading;
                                       NaN likewise */
    const char *headings;           /* "heading 90°", "mean of 4 headings"; NULL likewise */
    double middle_contrast;         /* of an eye box: ratio at the worst step of its middle, whose
                                       steps these are; NaN: one point, or nothing is seen */
    ReviewCase worst;
    const char *table; /* "sweeps/NAME.csv" */
} ReviewSweep;

/* The sun as one mirror throws it into one eye, over the suns of a sweep. */
typedef struct ReviewFalseSun {
    const char *condition, *eye;
    const char *mirror;     /* node and material */
    double share;           /* of the time (of a sweep without times: of the suns) */
    double minutes;         /* all headings together; NaN: the sweep has no times */
    double longest_minutes; /* at a stretch, under one heading; NaN likewise */
    /* Of the time at which it is worst: */
    const char *when; /* date, time, heading; NULL: the sweep has no times */
    double sun_azimuth_deg, sun_elevation_deg; /* of the vehicle */
    double lux;                                /* at the eye, on a plane that faces the image */
    const char *gaze;  /* where the eye looks: a symbol's name or a gaze's */
    double angle_deg;  /* from the gaze to the image */
    double veil_cd_m2; /* that it lays over what is looked at */
    const LimitVerdict *limits;
    int limit_count;
    Verdict verdict; /* the worst of them */
} ReviewFalseSun;

typedef struct ReviewResponse {
    const char *probe;
    const char *file; /* "responses/NAME.response", or where it is kept else; NULL: unknown */
    long paths;
    long bytes; /* of the file */
    double relative_error;
} ReviewResponse;

/* A variant's change of one symbol and eye, in a moment or at a sweep's worst. */
typedef struct ReviewDifference {
    const ReviewCase *before, *after;
    const ReviewSweep *sweep_before, *sweep_after; /* NULL: a moment */
    double margin;             /* after less before, of the contrast's margin; NaN: one has none */
    MeanInterval margin_range; /* both were read by the same random numbers, whose luck they
                            share; NaN likewise */
    bool is_other_part;        /* the same symbol is judged at another part of it: where that
                                  changes, figures of variants that change smoothly have a step */
} ReviewDifference;

/* A file that was read. */
typedef struct ReviewFile {
    const char *path;   /* as it was opened */
    const char *xxh3;   /* XXH3 64 of the bytes that were read, 16 hexadecimal digits */
    const char *sha256; /* of the same bytes, 64 digits; NULL: not known, as of a file that is
                           another now */
} ReviewFile;

/* Of the report: texts as its author states them; NULL: not stated. */
typedef struct ReviewDocument {
    const char *number, *revision, *date, *author;
} ReviewDocument;

/* What a verdict rests on besides the light. */
typedef enum RestKind {
    REST_PANEL,    /* of a display that is read */
    REST_MATERIAL, /* that nobody described: all others are as the scene's files have them */
    REST_EYE,
    REST_OCCUPANT, /* under so many of the conditions */
    REST_LIMITS,   /* so many of the profile's */
    REST_KINDS
} RestKind;
extern const char *const rest_kinds[REST_KINDS + 1]; /* "panel", "material", ... */

typedef enum RestBasis {
    REST_MEASURED,
    REST_SYNTHETIC,
    REST_NOT_STATED, /* panels */
    REST_GUESSED,
    REST_WITHOUT_DATA, /* materials */
    REST_GIVEN,
    REST_PROPOSED, /* eyes */
    REST_PRESENT,
    REST_NOBODY, /* occupants */
    REST_READ,
    REST_QUOTED, /* limits, in the standard */
    REST_BASES
} RestBasis;
extern const char *const rest_bases[REST_BASES + 1]; /* "measured", "synthetic", ... */

typedef struct ReviewRest {
    RestKind kind;
    RestBasis basis;
    const char *name;  /* of the display, material, eye, occupant or profile; NULL: nobody's */
    const char *words; /* of a panel its own name and instrument, of a material what it was
                          taken as, of an eye from what it was proposed; NULL: nothing more */
    long count, of;
} ReviewRest;

typedef struct Review Review;

/* The same review with something changed: verdicts alone, no causes. */
typedef struct ReviewVariantFound {
    const char *name;
    const char *const *words; /* what it changes, one text a change */
    int word_count;
    Review *review;
    ReviewDifference *differences; /* of each of its cases, then of each of its sweeps */
    int difference_count;
    ReviewDifference worst;           /* of the least margins of all, whose cases may differ */
    const char *frame_before, *frame; /* pictures' names within the folder: one view
                                         without and with the change; NULL: none */
    const ReviewCase *seen;           /* of the review: what they show */
} ReviewVariantFound;

struct Review {
    const char *title, *profile; /* profile: the standard's name and edition */
    const char *superseded_by;   /* what stands in that standard's place; NULL: it stands */
    ReviewDocument document;
    ReviewCase *cases;
    int case_count;
    ReviewSweep *sweeps;
    int sweep_count;
    GazeFinding *gazes;
    int gaze_count;
    ReviewResponse *responses;
    int response_count;
    ReviewFalseSun *false_suns; /* by condition and eye, the worst first */
    int false_sun_count;
    struct PaneFinding *pane_images; /* pane_verdict.h; of a request that names them */
    int pane_image_count;
    ReviewVariantFound *variants; /* in the request's order */
    int variant_count;
    const char *without_data; /* names of materials without data; NULL: there are none */
    int without_data_count;
    const char *const *notes; /* what a reader must know: approximations, gaps in data */
    int note_count;
    ReviewRest *rests_on;
    int rests_on_count;
    ReviewFile *inputs; /* every file that was read, once each */
    int input_count;
    bool pass; /* nothing fails, and all that is required could be judged;
                  strict: nor is anything too close, or of a material
                  without data */
    bool is_strict;
    bool has_summaries;  /* beside its page, one a symbol */
    int main_cards;      /* of its page: so many of the worst cases and sweeps have
                            their cards there, the others on a page beside; 0: all */
    bool is_beside;      /* this is about that page */
    const Review *whole; /* this is its part about one symbol: cards stand on its
                            pages; NULL: it is no part */
};

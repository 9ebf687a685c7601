/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/pane_findings.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "review/chain/chains.h"
#include "review/eye/pane_image_reading.h"
#include "review/judge.h"
#include "review/request/request_check.h"

#define PRECISION 0.01
#define PATHS_MOST 32768
#define SEARCH_BYTES ((size_t)1 << 34) /* of address space */

/* ---- where ------------------------------------------------------------------------------- */

/* Axes of the directions that are told: the vehicle's. */
static Frame frame_of(const ReviewRequest *request) {
    Vec3 z = vec3_from_doubles(request->forward);
    Vec3 x = vec3_normalize(vec3_cross(z, vec3(0, 1, 0)));
    return (Frame){x, vec3_cross(x, z), z};
}

static void angles_of(const Frame *frame, Vec3 towards, double out_deg[2]) {
    Vec3 local = frame_to_local(frame, towards);
    double x = (double)local.x, y = (double)local.y, z = (double)local.z;
    out_deg[0] = degrees_from_radians(atan2(x, z));
    out_deg[1] = degrees_from_radians(atan2(y, sqrt(x * x + z * z)));
}

/* Degrees, within 180 of another: outlines behind the eye do not break. */
static double near_to(double degrees, double other) {
    return degrees - 360 * round((degrees - other) / 360);
}

static void set_place(const PaneImage *image, const Frame *frame, PaneFinding *out, Arena *arena) {
    double *outline = ARENA_NEW(arena, double, 2 * image->outline_count), middle[2];
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    angles_of(frame, image->towards, middle);
    for (int i = 0; i < image->outline_count; i++) {
        double *at = outline + 2 * i;
        angles_of(frame, image->outline[i], at);
        at[0] = near_to(at[0], middle[0]);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    out->right_deg = middle[0];
    out->up_deg = middle[1];
    out->width_deg = high[0] - low[0];
    out->height_deg = high[1] - low[1];
    out->outline_deg = outline;
    out->outline_count = 2 * image->outline_count;
    out->corner_count = image->outline_count;
    out->corners = memcpy(ARENA_NEW(arena, Vec3, image->outline_count), image->outline,
                          sizeof *image->outline * (size_t)image->outline_count);
}

/* From a direction to the nearest of the image's. */
static double degrees_off(const PaneImage *image, const double direction[3]) {
    Vec3 axis = vec3_from_doubles(direction);
    double least = INFINITY;
    for (int i = 0; i < 3 * image->cell_count; i++) {
        Vec3 at = image->cells[i / 3].corner[i % 3], across = vec3_cross(at, axis);
        least = fmin(least, atan2((double)vec3_length(across), (double)vec3_dot(at, axis)));
    }
    return degrees_from_radians(least);
}

/* ---- what is to be kept free ------------------------------------------------------------- */

/* About a direction, as the request has it for all. */
static ReviewPaneArea area_towards(const ReviewPaneImages *panes, const char *name,
                                   const double direction[3]) {
    ReviewPaneArea area = {
        .name = name, .within_deg = panes->within_deg, .contrast_most = panes->contrast_most};
    memcpy(area.direction, direction, sizeof area.direction);
    return area;
}

/* Those of an eye: its gazes and the areas; straight ahead where there is neither. */
static ReviewPaneArea *areas_of(const ReviewRequest *request, int eye, int *count, Arena *arena) {
    const ReviewPaneImages *panes = request->pane_images;
    ReviewPaneArea *list =
        ARENA_NEW(arena, ReviewPaneArea, request->gaze_count + panes->area_count + 1);
    *count = 0;
    for (int i = 0; i < request->gaze_count; i++) {
        const ReviewGaze *gaze = &request->gazes[i];
        if (review_is_look(gaze, eye))
            list[(*count)++] = area_towards(panes, gaze->name, gaze->direction);
    }
    for (int i = 0; i < panes->area_count; i++) list[(*count)++] = panes->areas[i];
    if (!*count) list[(*count)++] = area_towards(panes, "ahead", request->forward);
    return list;
}

/* The area that allows the least; of several, or none with a limit, the nearest. How much
 * contrast it allows: INFINITY, any. */
static double set_area(const PaneImage *image, const ReviewPaneArea *areas, int count,
                       PaneFinding *out) {
    double most = INFINITY;
    out->off_deg = INFINITY;
    for (int i = 0; i < count; i++) {
        double off = degrees_off(image, areas[i].direction);
        double own = isnan(areas[i].contrast_most) ? INFINITY : areas[i].contrast_most;
        if (off > areas[i].within_deg) continue;
        if (out->area && (own > most || (own == most && off >= out->off_deg))) continue;
        out->area = areas[i].name;
        out->off_deg = off;
        most = own;
    }
    if (!out->area) out->off_deg = (double)NAN;
    return most;
}

/* ---- one display in one pane ------------------------------------------------------------- */

static const char *why_none(const PaneFinding *f, Arena *arena) {
    if (f->shown_share > 0) return NULL;
    if (f->ends_share >= f->away_share && f->ends_share >= f->covered_share)
        return "the pane ends before it";
    if (f->away_share >= f->covered_share) return "it turns its back to the pane";
    return arena_format(arena, "%s stands between", f->covered_by);
}

static void set_figure(Estimate found, double least, double *value, MeanInterval *range) {
    *value = fmax(found.mean, least);
    *range = (MeanInterval){fmax(found.interval.low, least), fmax(found.interval.high, least)};
}

static void set_light(const Setup *setup, Vec3 eye, const PaneImage *image, PaneFinding *out,
                      Arena scratch) {
    PaneImageGoal goal = {eye, image, PRECISION, PATHS_MOST, 0};
    PaneImageReading found = pane_image_read(setup, &goal, scratch);
    set_figure(found.image, 0, &out->image, &out->image_range);
    set_figure(found.through, 0, &out->behind, &out->behind_range);
    set_figure(found.against, setup->request->pane_images->against_cd_m2, &out->against,
               &out->against_range);
    out->ghost_share = found.ghost_share;
    out->ghost_arcmin = 60 * degrees_from_radians(found.ghost_rad);
    pane_set_contrast(out);
}

static PaneFinding finding_unknown(void) {
    const double nan = (double)NAN;
    const MeanInterval range = {nan, nan};
    return (PaneFinding){.right_deg = nan,
                         .up_deg = nan,
                         .width_deg = nan,
                         .height_deg = nan,
                         .image = nan,
                         .image_range = range,
                         .behind = nan,
                         .behind_range = range,
                         .against = nan,
                         .against_range = range,
                         .contrast = nan,
                         .contrast_range = range,
                         .ghost_share = nan,
                         .ghost_arcmin = nan,
                         .off_deg = nan};
}

typedef struct PaneEye {
    const Setup *setup;
    const char *name;
    Vec3 at;
    const ReviewPaneArea *areas;
    int area_count;
    const Profile *profile;
    Ambient ambient;
} PaneEye;

/* The name by which symbols are on it. */
static const char *name_on(const Setup *setup, const Part *part, Arena scratch) {
    const ReviewRequest *request = setup->request;
    int id = setup->scene->materials[part->material_id].display_id;
    ReviewDisplay display;
    Error ignored;
    for (int i = 0; i < request->symbol_count; i++)
        if (review_display_find(setup->scene, request->symbols[i].display, &scratch, &display,
                                &ignored) &&
            display.display_id == id)
            return request->symbols[i].display;
    return NULL;
}

static PaneFinding finding_of(const PaneEye *eye, const PaneImage *image, Arena scratch,
                              Arena *arena) {
    const Setup *setup = eye->setup;
    Frame frame = frame_of(setup->request);
    PaneFinding out = finding_unknown();
    out.condition = setup->condition->name;
    out.eye = eye->name;
    out.display = chain_part_words(setup->scene, image->part_id, arena);
    out.pane = chain_part_words(setup->scene, image->pane_id, arena);
    out.shows = name_on(setup, &setup->scene->parts[image->part_id], scratch);
    out.shown_share = image->share.shown;
    out.ends_share = image->share.ends;
    out.away_share = image->share.away;
    out.covered_share = image->share.covered;
    if (image->covered_by != NO_ID)
        out.covered_by = chain_part_words(setup->scene, image->covered_by, arena);
    out.none = why_none(&out, arena);
    if (out.none) return out;
    set_place(image, &frame, &out, arena);
    set_light(setup, eye->at, image, &out, scratch);
    double most = set_area(image, eye->areas, eye->area_count, &out);
    judge_pane(&out, eye->profile, eye->ambient, most);
    return out;
}

/* ---- all of them ------------------------------------------------------------------------- */

static void add_eye(const PaneEye *eye, Arena *arena, Review *review) {
    int count;
    Arena scratch = arena_reserve(SEARCH_BYTES);
    PaneImage *images = pane_images_find(eye->setup, eye->at, &count, &scratch);
    review->pane_images = ARENA_GROW(arena, PaneFinding, review->pane_images,
                                     review->pane_image_count, review->pane_image_count + count);
    for (int i = 0; i < count; i++)
        review->pane_images[review->pane_image_count++] =
            finding_of(eye, &images[i], scratch, arena);
    arena_release(&scratch);
}

bool setup_pane_images(const Setup *setup, const Profile *profile, Arena *arena, Review *review,
                       Error *err) {
    const ReviewRequest *request = setup->request;
    Vec3 towards;
    Ambient ambient = setup_sun(setup, &towards, NULL) ? AMBIENT_DAY : AMBIENT_NIGHT;
    for (int i = 0; i < request->eye_count; i++) {
        PaneEye eye = {
            .setup = setup, .name = request->eyes[i].name, .profile = profile, .ambient = ambient};
        if (!setup_eye_middle(setup, &request->eyes[i], *arena, &eye.at, err)) return false;
        eye.areas = areas_of(request, i, &eye.area_count, arena);
        add_eye(&eye, arena, review);
    }
    return true;
}

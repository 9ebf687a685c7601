/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_rays.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "review/output/review_words.h"
#include "text/text.h"

/* The Okabe and Ito palette, and lighter and darker ones between. */
static const unsigned char COLOURS[][3] = {
    {0xe6, 0x9f, 0x00}, {0x56, 0xb4, 0xe9}, {0xd5, 0x5e, 0x00}, {0x00, 0x9e, 0x73},
    {0xcc, 0x79, 0xa7}, {0xf0, 0xe4, 0x42}, {0x00, 0x72, 0xb2}, {0xff, 0xb0, 0x90},
    {0x8c, 0xd9, 0xc0}, {0xb0, 0xb0, 0xff}};
#define COLOUR_COUNT (int)(sizeof COLOURS / sizeof *COLOURS)

/* sRGB of cause i, 0..1: distinct without colour vision, too, by their order in lightness. */
static void ray_colour(int i, float srgb[3]) {
    for (int k = 0; k < 3; k++) srgb[k] = (float)COLOURS[i % COLOUR_COUNT][k] / 255;
}

/* ---- rays -------------------------------------------------------------------------------- */

#define NEAR_M 0.02    /* nothing nearer to the eye is drawn */
#define RIM_APART 0.01 /* share of a picture's width between a symbol and its line */

/* In a picture x is to the right and y down, pixels; before the eye right and up, metres. z is
 * metres before the eye in both. */
typedef struct SeenPoint {
    double x, y, z;
} SeenPoint;

static SeenPoint before_eye(const CaseView *view, Vec3 p) {
    Vec3 d = vec3_sub(p, view->eye);
    return (SeenPoint){(double)vec3_dot(d, view->right), (double)vec3_dot(d, view->up),
                       (double)vec3_dot(d, view->forward)};
}

static SeenPoint in_picture(const CaseView *view, SeenPoint p) {
    double depth = view->is_perspective ? p.z : 1;
    double x = (p.x / (depth * view->half_width) + 1) * 0.5 * view->width;
    double y = (1 - p.y / (depth * view->half_height)) * 0.5 * view->height;
    return (SeenPoint){x, y, p.z};
}

/* Narrows `kept`, shares 0..1 of the stretch, to what lies in 0..size along one axis. */
static void keep_within(double from, double to, double size, double kept[2]) {
    double step = to - from, low = -from / step, high = (size - from) / step;
    if (fabs(step) < 1e-9) {
        if (from < 0 || from > size) kept[1] = -1;
        return;
    }
    kept[0] = fmax(kept[0], fmin(low, high));
    kept[1] = fmin(kept[1], fmax(low, high));
}

/* The point of the stretch where it comes before the eye. */
static SeenPoint cut(SeenPoint hidden, SeenPoint shown) {
    double t = (NEAR_M - shown.z) / (hidden.z - shown.z);
    return (SeenPoint){shown.x + t * (hidden.x - shown.x), shown.y + t * (hidden.y - shown.y),
                       NEAR_M};
}

static void add_stretch(Text *html, const CaseView *view, SeenPoint a, SeenPoint b) {
    if (a.z < NEAR_M && b.z < NEAR_M) return;
    if (a.z < NEAR_M) a = cut(a, b);
    if (b.z < NEAR_M) b = cut(b, a);
    SeenPoint p = in_picture(view, a), q = in_picture(view, b);
    double kept[2] = {0, 1};
    keep_within(p.x, q.x, view->width, kept);
    keep_within(p.y, q.y, view->height, kept);
    if (!(kept[0] < kept[1])) return;
    text_format(html, "M%.0f %.0fL%.0f %.0f", p.x + kept[0] * (q.x - p.x),
                p.y + kept[0] * (q.y - p.y), p.x + kept[1] * (q.x - p.x),
                p.y + kept[1] * (q.y - p.y));
}

/* A cause's, all but the first stretch of each, which runs along the look. */
static void add_rays(Text *html, const CaseView *view, const CaseCause *cause) {
    for (int k = 0; k < cause->ray_count; k++) {
        const CaseRay *ray = &cause->rays[k];
        for (int i = 1; i + 1 < ray->count; i++)
            add_stretch(html, view, before_eye(view, ray->points[i]),
                        before_eye(view, ray->points[i + 1]));
    }
}

static void add_place(Text *html, const CaseView *view, const CaseRay *ray) {
    SeenPoint p = before_eye(view, ray->points[1]);
    if (p.z < NEAR_M) return;
    p = in_picture(view, p);
    if (p.x < 0 || p.x > view->width || p.y < 0 || p.y > view->height) return;
    text_format(html, "<circle cx=\"%.0f\" cy=\"%.0f\" r=\"%d\"/>", p.x, p.y,
                view->width / 320 + 2);
}

/* x, y in pixels: about a middle, half as wide and high. */
typedef struct PictureBox {
    double x, y, half_width, half_height;
} PictureBox;

static PictureBox rim_box(const ReviewCase *c) {
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < c->rim_count; i++) {
        SeenPoint p = in_picture(c->view, before_eye(c->view, c->rim[i]));
        double at[2] = {p.x, p.y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    return (PictureBox){(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (high[0] - low[0]) / 2,
                        (high[1] - low[1]) / 2};
}

/* Made wider by so many pixels on either side. */
static double widened(double x, double middle, double half, double by) {
    return middle + (x - middle) * (1 + by / fmax(half, 1));
}

static bool is_before_eye(const ReviewCase *c) {
    for (int i = 0; i < c->rim_count; i++)
        if (before_eye(c->view, c->rim[i]).z < NEAR_M) return false;
    return c->rim_count > 0;
}

static void add_rim_path(Text *html, const ReviewCase *c) {
    PictureBox box = rim_box(c);
    double by = RIM_APART * c->view->width;
    for (int i = 0; i < c->rim_count; i++) {
        SeenPoint p = in_picture(c->view, before_eye(c->view, c->rim[i]));
        text_format(html, "%c%.1f %.1f", i ? 'L' : 'M', widened(p.x, box.x, box.half_width, by),
                    widened(p.y, box.y, box.half_height, by));
    }
    text_add(html, "Z\"/>");
}

static void add_line(Text *html, const ReviewCase *c) {
    text_add(html, "<g class=\"rim\"><path class=\"under\" d=\"");
    add_rim_path(html, c);
    text_add(html, "<path d=\"");
    add_rim_path(html, c);
    text_add(html, "</g>");
}

const char *review_rays_line(const ReviewCase *c, Arena *arena) {
    Text svg = {.arena = arena};
    add_line(&svg, c);
    return svg.data;
}

const char *review_rays_rim(const ReviewCase *c, Arena *arena) {
    Text svg = {.arena = arena};
    if (!c->view || !is_before_eye(c)) return "";
    text_format(&svg,
                "<svg class=\"rim\" viewBox=\"0 0 %d %d\" aria-hidden=\"true\" "
                "preserveAspectRatio=\"xMidYMid slice\">",
                c->view->width, c->view->height);
    add_line(&svg, c);
    text_add(&svg, "</svg>");
    return svg.data;
}

#define CLOSE_SIZE 6     /* of what is shown close up, over the symbol's */
#define CLOSE_LEAST 0.12 /* share of the picture's width and height */
#define CLOSE_MOST 0.4

/* Where a stretch of `size` about `middle` begins, so that it lies within 0..all. */
static double begin_within(double middle, double size, double all) {
    return fmin(fmax(middle - size / 2, 0), all - size);
}

bool review_rays_close_up(const ReviewCase *c, double box[4]) {
    const CaseView *view = c->view;
    if (!view || !is_before_eye(c)) return false;
    PictureBox at = rim_box(c);
    if (at.x < 0 || at.x > view->width || at.y < 0 || at.y > view->height) return false;
    double share =
        CLOSE_SIZE * 2 * fmax(at.half_width / view->width, at.half_height / view->height);
    share = fmin(fmax(share, CLOSE_LEAST), CLOSE_MOST);
    box[2] = share * view->width;
    box[3] = share * view->height;
    box[0] = begin_within(at.x, box[2], view->width);
    box[1] = begin_within(at.y, box[3], view->height);
    return true;
}

bool review_rays_has(const ReviewCase *c, int i) {
    return c->frame && c->view && c->causes[i].ray_count > 0;
}

const char *review_rays_id(const char *card_id, int i, Arena *arena) {
    return arena_format(arena, "%s-way%d", card_id, i + 1);
}

const char *review_rays_drawn(const ReviewCase *c, const char *card_id, Arena *arena) {
    const CaseView *view = c->view;
    Text svg = {.arena = arena}, *html = &svg;
    text_format(html, "<svg class=\"rays\" viewBox=\"0 0 %d %d\">", view->width, view->height);
    for (int i = 0; i < c->cause_count; i++) {
        const CaseCause *cause = &c->causes[i];
        float rgb[3];
        if (!review_rays_has(c, i)) continue;
        ray_colour(i, rgb);
        text_format(html, "<g id=\"%s\" style=\"--ray:#%02x%02x%02x\"><title>",
                    review_rays_id(card_id, i, arena), (int)(255 * rgb[0] + 0.5f),
                    (int)(255 * rgb[1] + 0.5f), (int)(255 * rgb[2] + 0.5f));
        escape_markup(html, words_chain(cause, arena));
        text_add(html, "</title><path class=\"under\" d=\"");
        add_rays(html, view, cause);
        text_add(html, "\"/><path d=\"");
        add_rays(html, view, cause);
        text_add(html, "\"/>");
        for (int k = 0; k < cause->ray_count; k++) add_place(html, view, &cause->rays[k]);
        text_add(html, "</g>");
    }
    text_add(html, "</svg>");
    return svg.data;
}

/* ---- displays in glass --------------------------------------------------------------------------
 */

#define PATH_BYTES 1024  /* of an outline's corners */
#define BEFORE_EYE 0.05f /* along the view's axis, of a unit direction */

/* A direction's place in the picture, pixels. */
static bool in_view(const CaseView *view, Vec3 towards, double at[2]) {
    float ahead = vec3_dot(towards, view->forward);
    if (ahead < BEFORE_EYE) return false;
    at[0] = (double)(vec3_dot(towards, view->right) / ahead) / view->half_width;
    at[1] = (double)(vec3_dot(towards, view->up) / ahead) / view->half_height;
    at[0] = 0.5 * (1 + at[0]) * view->width;
    at[1] = 0.5 * (1 - at[1]) * view->height;
    return true;
}

/* As a closed path; false: some of it is not before the eye. */
static bool path_of(const CaseView *view, const PaneFinding *f, Text *out) {
    for (int i = 0; i < f->corner_count; i++) {
        double at[2];
        if (!in_view(view, f->corners[i], at)) return false;
        text_format(out, "%c%.1f %.1f", i ? 'L' : 'M', at[0], at[1]);
    }
    text_add(out, "Z");
    return true;
}

static bool is_seen_in(const PaneFinding *f, const ReviewCase *c) {
    return !f->none && f->corners && !c->when && c->eye && c->condition &&
           !strcmp(f->eye, c->eye) && !strcmp(f->condition, c->condition);
}

const char *review_panes_drawn(const Review *review, const ReviewCase *c, Arena *arena) {
    Text all = {.arena = arena};
    if (!c->view || !c->view->is_perspective) return NULL;
    for (int i = 0; i < review->pane_image_count; i++) {
        const PaneFinding *f = &review->pane_images[i];
        char buffer[PATH_BYTES];
        Arena own = *arena;
        Text path = {.arena = &own};
        if (!is_seen_in(f, c) || !path_of(c->view, f, &path)) continue;
        snprintf(buffer, sizeof buffer, "%s", path.data);
        text_format(&all,
                    "<g class=\"rim\"><path class=\"under\" d=\"%s\"/>"
                    "<path d=\"%s\"/></g>",
                    buffer, buffer);
    }
    if (!all.data) return NULL;
    return arena_format(arena,
                        "<svg class=\"rim\" viewBox=\"0 0 %d %d\" "
                        "aria-hidden=\"true\" preserveAspectRatio=\"xMidYMid slice\">%s</svg>",
                        c->view->width, c->view->height, all.data);
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/pane_outlines.h"

#include <stdio.h>
#include <string.h>

#include "text/text.h"

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
    for (int i = 0; 2 * i < f->outline_count; i++) {
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

/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_levels.h"

#include <math.h>

#include "review/output/review_words.h"
#include "review/review_decide.h"
#include "text/text.h"
#include "vision/visibility.h"

const char *words_levels(const ReviewCase *c, Arena *arena) {
    Text text = {.arena = arena};
    for (int i = 0; i < c->visibility_count; i++) {
        const CaseVisibility *v = &c->visibilities[i];
        if (isnan(v->level)) continue;
        text_format(&text, "%s%s at %g%s", text.size ? ", " : "visibility level ",
                    words_within(v->level, v->low, v->high, arena), v->age_years,
                    text.size ? "" : " years");
    }
    return text.data ? text.data : "";
}

const char *words_judged_and_levels(const ReviewCase *c, Arena *arena) {
    const char *judged = words_judged(c, arena), *levels = words_levels(c, arena);
    return *levels ? arena_format(arena, "%s; %s", judged, levels) : judged;
}

const char *words_level(const CaseVisibility *v, Arena *arena) {
    const char *doubt = v->doubts ? arena_format(arena, "; doubtful: %s", v->doubts) : "";
    if (isnan(v->level)) return arena_format(arena, "–%s", doubt);
    if (v->low == v->high) return arena_format(arena, "%s%s", words_figure(v->level, arena), doubt);
    return arena_format(arena, "%s, 95 %% sure between %s and %s%s",
                        words_within(v->level, v->low, v->high, arena),
                        words_within(v->low, v->low, v->high, arena),
                        words_within(v->high, v->low, v->high, arena), doubt);
}

const char *words_target(const CaseVisibility *v, Arena *arena) {
    const char *glance = v->glance_s < VISIBILITY_GLANCE_LONG
                             ? arena_format(arena, "in a glance of %g s", v->glance_s)
                             : "for as long as it takes";
    return arena_format(arena,
                        "one of its strokes, %s arc minutes wide, looked at %s; the eye "
                        "adapted to %s cd/m²: background, reflected light and veil",
                        words_figure(v->size_arcmin, arena), glance,
                        words_figure(v->adapted_cd_m2, arena));
}

bool review_has_levels(const Review *review) {
    bool has = false;
    for (int i = 0; i < review_case_count(review); i++)
        has = has || review_case_at(review, i)->visibility_count > 0;
    return has;
}

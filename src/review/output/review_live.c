/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_live.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file_write.h"
#include "base/mathd.h"
#include "page/page.h"
#include "review/output/review_link.h"
#include "review/review_decide.h"
#include "text/json_text.h"

/* Sweeps beyond that much text stay as they are drawn: one minute a step over a year. */
#define SWEEPS_BYTES ((size_t)6 << 20)
#define SCRIPT_BYTES ((size_t)1 << 34) /* address space: what is not touched costs nothing */

/* ---- codes ------------------------------------------------------------------------------- */

#define CODES 65535 /* of a figure: 0 is 0 or none, the last one infinite */

/* The place of a value on a logarithmic scale from 1e-6 to 1e9. */
static uint32_t log_code(double value) {
    if (!(value > 0)) return 0;
    double share = log_d(value / 1e-6) / log_d(1e15);
    if (!isfinite(value)) return CODES;
    return 1 + (uint32_t)(fmin(fmax(share, 0), 1) * (CODES - 2) + 0.5);
}

/* In steps of 0.001 from -1 on; 0: there is none. */
static uint32_t margin_code(double margin) {
    if (isnan(margin)) return 0;
    return 1 + (uint32_t)(1000 * (fmin(fmax(margin, -1), 64) + 1) + 0.5);
}

/* ---- sweeps ------------------------------------------------------------------------------ */

/* Numbers are packed in `arena`, and are gone from there when they stand in the document. */
typedef struct Packer {
    const Review *review;
    const ReviewLive *live;
    Arena arena;
    Error *err;
    bool ok;
    size_t bytes; /* packed so far */
} Packer;

static void set_codes(Packer *to, json_t *object, const char *name, const uint32_t *codes,
                      int count, int bytes) {
    Arena scratch = to->arena;
    const char *packed = page_packed(codes, (size_t)count, bytes, &scratch, to->err);
    to->ok &= packed != NULL;
    to->bytes += packed ? strlen(packed) : 0;
    if (packed) json_object_set_new(object, name, json_string_nocheck(packed));
}

static json_t *sky_json(Packer *to, const LiveSky *sky) {
    Packer own = *to;
    int count = sky->count;
    uint32_t *codes = ARENA_NEW(&own.arena, uint32_t, 4 * (size_t)count);
    json_t *headings = json_array();
    for (int i = 0; i < sky->heading_count; i++)
        json_array_append_new(headings, json_real(sky->headings_deg[i]));
    for (int i = 0; i < count; i++) {
        const LiveSun *sun = &sky->suns[i];
        double turns = sun->azimuth_deg / 360;
        codes[i] = (uint32_t)(36000 * (turns - floor(turns)) + 0.5) % 36000;
        codes[count + i] = (uint32_t)(100 * (sun->elevation_deg + 90) + 0.5);
        codes[2 * count + i] = (uint32_t)sun->step;
        codes[3 * count + i] = (uint32_t)sun->heading_id;
    }
    json_t *sky_of = json_pack("{s:i, s:i, s:f, s:o}", "count", count, "year", sky->year, "minutes",
                               sky->step_minutes, "headings", headings);
    set_codes(&own, sky_of, "azimuth", codes, count, 2);
    set_codes(&own, sky_of, "elevation", codes + count, count, 2);
    if (sky->year) set_codes(&own, sky_of, "step", codes + 2 * count, count, 4);
    if (sky->year) set_codes(&own, sky_of, "heading", codes + 3 * count, count, 1);
    to->ok = own.ok;
    to->bytes = own.bytes;
    return sky_of;
}

static void set_numbers(Packer *to, json_t *object, const char *name, const float *values,
                        int count) {
    Arena kept = to->arena;
    uint32_t *codes = ARENA_NEW(&to->arena, uint32_t, count);
    for (int i = 0; i < count; i++) codes[i] = log_code((double)values[i]);
    set_codes(to, object, name, codes, count, 2);
    to->arena = kept;
}

static const float *display_numbers(const LiveSweep *sweep, bool is_lux) {
    return is_lux ? sweep->lux : sweep->level;
}

/* A display's numbers are the same for all of its symbols and eyes: they stand in the first
 * sweep alone, and the others hold its index. */
static void set_display_numbers(Packer *to, json_t *object, int at, bool is_lux) {
    const LiveSweep *sweeps = to->live->sweeps;
    const char *name = is_lux ? "lux" : "level";
    const float *own = display_numbers(&sweeps[at], is_lux);
    int count = sweeps[at].sky->count, same = 0;
    while (same < at &&
           (sweeps[same].sky != sweeps[at].sky ||
            memcmp(display_numbers(&sweeps[same], is_lux), own, (size_t)count * sizeof *own) != 0))
        same++;
    if (same < at) page_set_count(object, name, same);
    else set_numbers(to, object, name, own, count);
}

static void set_judged(Packer *to, json_t *object, const LiveSweep *sweep) {
    Arena kept = to->arena;
    int count = sweep->sky->count;
    uint32_t *margins = ARENA_NEW(&to->arena, uint32_t, count);
    uint32_t *verdicts = ARENA_NEW(&to->arena, uint32_t, count);
    for (int i = 0; i < count; i++) {
        margins[i] = margin_code((double)sweep->margin[i]);
        verdicts[i] = sweep->verdict[i];
    }
    set_codes(to, object, "margin", margins, count, 2);
    set_codes(to, object, "verdict", verdicts, count, 1);
    to->arena = kept;
}

/* Suns of the same condition, seen by the same eye, of which there are pictures: the card that
 * has it, and where the sun stands. */
static json_t *seen_json(const Packer *to, const ReviewSweep *like) {
    json_t *seen = json_array();
    for (int i = 0; i < to->review->sweep_count; i++) {
        const ReviewSweep *s = &to->review->sweeps[i];
        Arena scratch = to->arena;
        if (strcmp(s->condition, like->condition) || strcmp(s->eye, like->eye) || !s->worst.frame)
            continue;
        json_array_append_new(seen,
                              json_pack("[s,o,o]", review_card_id(to->review, &s->worst, &scratch),
                                        json_figure(s->worst.sun_azimuth_deg),
                                        json_figure(s->worst.sun_elevation_deg)));
    }
    return seen;
}

static json_t *sweep_json(Packer *to, int at, int sky_id) {
    const LiveSweep *sweep = &to->live->sweeps[at];
    int count = sweep->sky->count;
    json_t *out =
        json_pack("{s:i, s:i, s:i, s:o}", "id", sweep->sweep_id, "sky", sky_id, "worst",
                  sweep->worst, "seen", seen_json(to, &to->review->sweeps[sweep->sweep_id]));
    set_numbers(to, out, "contrast", sweep->contrast, count);
    set_numbers(to, out, "low", sweep->low, count);
    set_numbers(to, out, "high", sweep->high, count);
    set_numbers(to, out, "reflected", sweep->reflected, count);
    set_numbers(to, out, "mirror", sweep->mirror, count);
    set_display_numbers(to, out, at, false);
    set_display_numbers(to, out, at, true);
    set_judged(to, out, sweep);
    return out;
}

/* Sweeps of one condition follow each other. Those that are left out lose nothing that the
 * page would show without script. */
static void set_sweeps(Packer *to, json_t *document) {
    const LiveSky *last = NULL;
    json_t *sweeps = json_array(), *skies = json_array();
    for (int i = 0; to->ok && i < to->live->sweep_count && to->bytes <= SWEEPS_BYTES; i++) {
        const LiveSky *sky = to->live->sweeps[i].sky;
        if (sky != last) json_array_append_new(skies, sky_json(to, sky));
        json_array_append_new(sweeps, sweep_json(to, i, (int)json_array_size(skies) - 1));
        last = sky;
    }
    json_object_set_new(document, "sweeps", sweeps);
    json_object_set_new(document, "skies", skies);
}

/* ---- all of it --------------------------------------------------------------------------- */

/* Takes the value. */
static void add_value(Text *text, json_t *value) {
    char *compact = json_dumps(value, JSON_COMPACT | JSON_REAL_PRECISION(9) | JSON_ENCODE_ANY);
    text_add(text, compact ? compact : "null");
    free(compact);
    json_decref(value);
}

static bool add_all(Text *to, const Review *review, const ReviewLive *live, Error *err) {
    Arena own = arena_reserve(SCRIPT_BYTES);
    Packer packer = {.review = review, .live = live, .arena = own, .err = err, .ok = true};
    json_t *document = json_object();
    set_sweeps(&packer, document);
    add_value(to, document);
    arena_release(&own);
    return packer.ok;
}

bool review_live_write(const Review *review, const ReviewLive *live, const char *path, Error *err) {
    Arena own = arena_reserve(SCRIPT_BYTES);
    Text script = {.arena = &own};
    text_add(&script, "window.liveData=");
    bool ok = add_all(&script, review, live, err);
    text_add(&script, ";\n");
    ok = ok && file_write(path, script.data, script.size, err);
    arena_release(&own);
    return ok;
}

bool review_live_add(Text *html, const Review *review, const ReviewLive *live, Error *err) {
    if (live->sweep_count == 0) return true;
    if (live->beside) {
        text_format(html, "<script src=\"%s\"></script>\n", live->beside);
        return true;
    }
    text_add(html, "<script type=\"application/json\" id=\"live-data\">\n");
    if (!add_all(html, review, live, err)) return false;
    text_add(html, "</script>\n");
    return true;
}

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

/* The place of a value above 0 on a logarithmic scale, 1 .. steps; 0: none, or not above 0. */
static uint32_t log_code(double value, double low, double high, int steps)
{
    if (!(value > 0)) return 0;
    double share = log_d(value / low) / log_d(high / low);
    if (!(share > 0)) return 1;
    return 1 + (uint32_t)(fmin(share, 1) * (steps - 1) + 0.5);
}

/* X, Y, Z of linear Rec.709 (D65). */
static void xyz_of(const double rgb[3], double xyz[3])
{
    static const double M[3][3] = {{0.412390799266, 0.357584339384, 0.180480788402},
                                   {0.212639005872, 0.715168678768, 0.0721923153607},
                                   {0.0193308187156, 0.119194779795, 0.95053215225}};
    for (int i = 0; i < 3; i++)
        xyz[i] = M[i][0] * rgb[0] + M[i][1] * rgb[1] + M[i][2] * rgb[2];
}

static uint32_t chroma_code(double numerator, double denominator)
{
    double code = denominator > 0 ? 410 * numerator / denominator + 0.5 : 0;
    return (uint32_t)(code > 0 ? fmin(code, 255) : 0);
}

/* Luminance in the lower 16 bits, then u', then v'. No light, no colour. */
static uint32_t light_code(const double rgb[3])
{
    double xyz[3];
    xyz_of(rgb, xyz);
    uint32_t luminance = log_code(xyz[1], 1e-5, 1e10, 4095);
    double   sum = xyz[0] + 15 * xyz[1] + 3 * xyz[2];
    if (luminance == 0) return 0;
    return luminance | chroma_code(4 * xyz[0], sum) << 16 | chroma_code(9 * xyz[1], sum) << 24;
}

const char *live_layer_pack(const float *const rgb[3], size_t count, Arena *arena, Error *err)
{
    Arena     own = arena_reserve((size_t)1 << 34);
    uint32_t *codes = ARENA_NEW(&own, uint32_t, count);
    for (size_t i = 0; i < count; i++) {
        double light[3] = {(double)rgb[0][i], (double)rgb[1][i], (double)rgb[2][i]};
        bool   is_finite = isfinite(light[0]) && isfinite(light[1]) && isfinite(light[2]);
        codes[i] = is_finite ? light_code(light) : 0;
    }
    const char *packed = page_packed(codes, count, 4, arena, err);
    arena_release(&own);
    return packed;
}

/* ---- sweeps ------------------------------------------------------------------------------ */

/* Numbers are packed in `arena`, and are gone from there when they stand in the document. */
typedef struct Packer {
    const Review     *review;
    const ReviewLive *live;
    Arena             arena;
    Error            *err;
    bool              ok;
    size_t            bytes; /* packed so far */
} Packer;

static void set_codes(Packer *to, json_t *object, const char *name, const uint32_t *codes,
                      int count, int bytes)
{
    Arena       scratch = to->arena;
    const char *packed = page_packed(codes, (size_t)count, bytes, &scratch, to->err);
    to->ok &= packed != NULL;
    to->bytes += packed ? strlen(packed) : 0;
    if (packed) json_object_set_new(object, name, json_string_nocheck(packed));
}

static json_t *sky_json(Packer *to, const LiveSky *sky)
{
    Packer    own = *to;
    int       count = sky->count;
    uint32_t *codes = ARENA_NEW(&own.arena, uint32_t, 4 * (size_t)count);
    json_t   *headings = json_array();
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
    json_t *sky_of = json_pack("{s:i, s:i, s:f, s:o}", "count", count, "year", sky->year, "minutes", sky->step_minutes,
                               "headings", headings);
    set_codes(&own, sky_of, "azimuth", codes, count, 2);
    set_codes(&own, sky_of, "elevation", codes + count, count, 2);
    if (sky->year) set_codes(&own, sky_of, "step", codes + 2 * count, count, 4);
    if (sky->year) set_codes(&own, sky_of, "heading", codes + 3 * count, count, 1);
    to->ok = own.ok;
    to->bytes = own.bytes;
    return sky_of;
}

static void set_numbers(Packer *to, json_t *object, const char *name, const float *values,
                        int count)
{
    Arena     kept = to->arena;
    uint32_t *codes = ARENA_NEW(&to->arena, uint32_t, count);
    for (int i = 0; i < count; i++)
        codes[i] = log_code((double)values[i], 1e-6, 1e9, 65535);
    set_codes(to, object, name, codes, count, 2);
    to->arena = kept;
}

static const float *display_numbers(const LiveSweep *sweep, bool is_lux)
{
    return is_lux ? sweep->lux : sweep->level;
}

/* A display's numbers are the same for all of its symbols and eyes: they stand in the first
 * sweep alone, and the others hold its index. */
static void set_display_numbers(Packer *to, json_t *object, int at, bool is_lux)
{
    const LiveSweep *sweeps = to->live->sweeps;
    const char      *name = is_lux ? "lux" : "level";
    const float     *own = display_numbers(&sweeps[at], is_lux);
    int              count = sweeps[at].sky->count, same = 0;
    while (same < at && (sweeps[same].sky != sweeps[at].sky ||
                         memcmp(display_numbers(&sweeps[same], is_lux), own,
                                (size_t)count * sizeof *own) != 0))
        same++;
    if (same < at) page_set_count(object, name, same);
    else set_numbers(to, object, name, own, count);
}

static void set_states(Packer *to, json_t *object, const LiveSweep *sweep)
{
    Arena     kept = to->arena;
    uint32_t *codes = ARENA_NEW(&to->arena, uint32_t, sweep->sky->count);
    for (int i = 0; i < sweep->sky->count; i++)
        codes[i] = (uint32_t)(sweep->verdict[i] | sweep->ambient[i] << 2);
    set_codes(to, object, "state", codes, sweep->sky->count, 1);
    to->arena = kept;
}

static json_t *limit_json(const LimitVerdict *limit)
{
    return limit ? json_pack("[f,s]", limit->value, limit->kind) : json_null();
}

/* Where a case's picture is among the live ones; -1: nowhere. */
static int picture_of(const ReviewLive *live, const ReviewCase *c)
{
    for (int i = 0; c->frame && i < live->picture_count; i++)
        if (!strcmp(live->pictures[i].frame, c->frame)) return i;
    return -1;
}

/* Suns of the same condition, seen by the same eye, of which there are pictures: the card that
 * has it, and where the sun stands. */
static json_t *seen_json(const Packer *to, const ReviewSweep *like)
{
    json_t *seen = json_array();
    for (int i = 0; i < to->review->sweep_count; i++) {
        const ReviewSweep *s = &to->review->sweeps[i];
        Arena              scratch = to->arena;
        if (strcmp(s->condition, like->condition) || strcmp(s->eye, like->eye) ||
            picture_of(to->live, &s->worst) < 0)
            continue;
        json_array_append_new(
            seen, json_pack("[s,o,o]", review_card_id(to->review, &s->worst, &scratch),
                            json_figure(s->worst.sun_azimuth_deg),
                            json_figure(s->worst.sun_elevation_deg)));
    }
    return seen;
}

static json_t *sweep_json(Packer *to, int at, int sky_id)
{
    const LiveSweep *sweep = &to->live->sweeps[at];
    int              count = sweep->sky->count;
    json_t          *limits = json_array();
    for (int i = 0; i < 4; i++) json_array_append_new(limits, limit_json(sweep->asked[i]));
    json_t *out = json_pack("{s:i, s:i, s:i, s:o, s:o, s:o, s:o}", "id", sweep->sweep_id, "sky",
                            sky_id, "worst", sweep->worst, "foreground",
                            json_figure(sweep->foreground), "background",
                            json_figure(sweep->background), "limits", limits, "seen",
                            seen_json(to, &to->review->sweeps[sweep->sweep_id]));
    set_numbers(to, out, "reflected", sweep->reflected, count);
    set_numbers(to, out, "mirror", sweep->mirror, count);
    set_display_numbers(to, out, at, false);
    set_display_numbers(to, out, at, true);
    set_states(to, out, sweep);
    return out;
}

/* Sweeps of one condition follow each other. Those that are left out lose nothing that the
 * page would show without script. */
static void set_sweeps(Packer *to, json_t *document)
{
    const LiveSky *last = NULL;
    json_t        *sweeps = json_array(), *skies = json_array();
    for (int i = 0; to->ok && i < to->live->sweep_count && to->bytes <= SWEEPS_BYTES; i++) {
        const LiveSky *sky = to->live->sweeps[i].sky;
        if (sky != last) json_array_append_new(skies, sky_json(to, sky));
        json_array_append_new(sweeps, sweep_json(to, i, (int)json_array_size(skies) - 1));
        last = sky;
    }
    json_object_set_new(document, "sweeps", sweeps);
    json_object_set_new(document, "skies", skies);
}

/* ---- pictures ---------------------------------------------------------------------------- */

static json_t *layers_json(const LivePicture *p)
{
    const char *layers[6] = {p->scene,        p->displays,    p->eye_scene,
                             p->eye_displays, p->clean_scene, p->clean_displays};
    json_t     *list = json_array();
    for (int i = 0; i < (p->clean_scene ? 6 : 4); i++)
        json_array_append_new(list, json_string_nocheck(layers[i] ? layers[i] : ""));
    return list;
}

static json_t *picture_json(const LivePicture *p)
{
    json_t *out = json_pack(
        "{s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:f, s:b}", "frame", p->frame, "width", p->width,
        "height", p->height, "grey", p->grey_cd_m2, "low", p->low, "high", p->high, "age",
        p->age_years, "pigment", p->pigment, "eye", p->eye_scene != NULL);
    if (p->clean_scene) page_set(out, "label", p->label);
    if (p->beside) page_set(out, "script", p->beside);
    else json_object_set_new(out, "layers", layers_json(p));
    return out;
}

/* A case that has a picture: its card, and what its readings are made of. */
static json_t *case_json(const Packer *to, const ReviewCase *c, int picture)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    Arena                 scratch = to->arena;
    return json_pack("{s:s, s:i, s:i, s:o, s:o, s:o, s:o, s:o}", "card",
                     review_card_id(to->review, c, &scratch), "picture", picture, "verdict",
                     (int)c->verdict, "level", json_figure(c->level), "foreground",
                     json_figure(l->foreground), "background", json_figure(l->background),
                     "reflected", json_figure(l->reflected), "limit",
                     limit_json(c->limit_id >= 0 ? &c->limits[c->limit_id] : NULL));
}

static void set_pictures(Packer *to, json_t *document)
{
    json_t *pictures = json_array(), *cases = json_array();
    for (int i = 0; i < to->live->picture_count; i++)
        json_array_append_new(pictures, picture_json(&to->live->pictures[i]));
    for (int i = 0; i < review_case_count(to->review); i++) {
        const ReviewCase *c = review_case_at(to->review, i);
        int               picture = picture_of(to->live, c);
        if (picture >= 0) json_array_append_new(cases, case_json(to, c, picture));
    }
    json_object_set_new(document, "pictures", pictures);
    json_object_set_new(document, "cases", cases);
    json_object_set_new(document, "colours", json_string(to->live->colours));
}

/* ---- all of it --------------------------------------------------------------------------- */

/* Takes the value. */
static void add_value(Text *text, json_t *value)
{
    char *compact = json_dumps(value, JSON_COMPACT | JSON_REAL_PRECISION(9) | JSON_ENCODE_ANY);
    text_add(text, compact ? compact : "null");
    free(compact);
    json_decref(value);
}

bool live_layers_write(const LivePicture *picture, const char *path, Error *err)
{
    Arena own = arena_reserve(SCRIPT_BYTES);
    Text  script = {.arena = &own};
    text_format(&script, "liveLayers(\"%s\",", picture->beside);
    add_value(&script, layers_json(picture));
    text_add(&script, ");\n");
    bool ok = file_write(path, script.data, script.size, err);
    arena_release(&own);
    return ok;
}

static bool add_all(Text *to, const Review *review, const ReviewLive *live, Error *err)
{
    Arena   own = arena_reserve(SCRIPT_BYTES);
    Packer  packer = {.review = review, .live = live, .arena = own, .err = err, .ok = true};
    json_t *document = json_object();
    set_sweeps(&packer, document);
    set_pictures(&packer, document);
    add_value(to, document);
    arena_release(&own);
    return packer.ok;
}

bool review_live_write(const Review *review, const ReviewLive *live, const char *path,
                       Error *err)
{
    Arena own = arena_reserve(SCRIPT_BYTES);
    Text  script = {.arena = &own};
    text_add(&script, "window.liveData=");
    bool ok = add_all(&script, review, live, err);
    text_add(&script, ";\n");
    ok = ok && file_write(path, script.data, script.size, err);
    arena_release(&own);
    return ok;
}

bool review_live_add(Text *html, const Review *review, const ReviewLive *live, Error *err)
{
    if (live->sweep_count + live->picture_count == 0) return true;
    if (live->beside) {
        text_format(html, "<script src=\"%s\"></script>\n", live->beside);
        return true;
    }
    text_add(html, "<script type=\"application/json\" id=\"live-data\">\n");
    if (!add_all(html, review, live, err)) return false;
    text_add(html, "</script>\n");
    return true;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "review/output/review_live.h"

#include <math.h>
#include <string.h>

#include "base/file_write.h"
#include "base/mathd.h"
#include "page/page.h"
#include "review/output/review_link.h"
#include "review/review_decide.h"

/* Sweeps beyond that much text stay as they are drawn: one minute a step over a year. */
#define SWEEPS_BYTES ((size_t)6 << 20)
#define SCRIPT_BYTES ((size_t)1 << 30) /* address space: what is not touched costs nothing */

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
    Text      packed = {.arena = arena};
    for (size_t i = 0; i < count; i++) {
        double light[3] = {(double)rgb[0][i], (double)rgb[1][i], (double)rgb[2][i]};
        bool   is_finite = isfinite(light[0]) && isfinite(light[1]) && isfinite(light[2]);
        codes[i] = is_finite ? light_code(light) : 0;
    }
    bool ok = page_data_add(&packed, codes, count, 4, own, err);
    arena_release(&own);
    return ok ? packed.data : NULL;
}

/* ---- sweeps ------------------------------------------------------------------------------ */

/* The page's text, and room to work. */
typedef struct Writer {
    Text  *html;
    Arena *arena;
    Error *err;
} Writer;

typedef struct LiveFound {
    const Review     *review;
    const ReviewLive *live;
} LiveFound;

/* Null unless finite. */
static void add_figure(Text *html, const char *name, double value)
{
    if (isfinite(value)) text_format(html, ",\"%s\":%.9g", name, value);
    else text_format(html, ",\"%s\":null", name);
}

static bool add_codes(const Writer *to, const char *name, const uint32_t *codes, size_t count,
                      int bytes)
{
    text_format(to->html, ",\"%s\":\"", name);
    if (!page_data_add(to->html, codes, count, bytes, *to->arena, to->err)) return false;
    text_add(to->html, "\"");
    return true;
}

static bool add_sky(const Writer *to, const LiveSky *sky)
{
    Arena     scratch = *to->arena;
    size_t    count = (size_t)sky->count;
    uint32_t *codes = ARENA_NEW(&scratch, uint32_t, 4 * count);
    for (size_t i = 0; i < count; i++) {
        const LiveSun *sun = &sky->suns[i];
        double turns = sun->azimuth_deg / 360;
        codes[i] = (uint32_t)(36000 * (turns - floor(turns)) + 0.5) % 36000;
        codes[count + i] = (uint32_t)(100 * (sun->elevation_deg + 90) + 0.5);
        codes[2 * count + i] = (uint32_t)sun->step;
        codes[3 * count + i] = (uint32_t)sun->heading_id;
    }
    Writer own = {to->html, &scratch, to->err};
    text_format(to->html, "{\"count\":%d,\"route\":%s,\"year\":%d,\"minutes\":%.9g,",
                sky->count, sky->is_route ? "true" : "false", sky->year, sky->step_minutes);
    text_add(to->html, "\"headings\":[");
    for (int i = 0; i < sky->heading_count; i++)
        text_format(to->html, i ? ",%.9g" : "%.9g", sky->headings_deg[i]);
    text_add(to->html, "]");
    if (!add_codes(&own, "azimuth", codes, count, 2) ||
        !add_codes(&own, "elevation", codes + count, count, 2))
        return false;
    if (sky->year && (!add_codes(&own, "step", codes + 2 * count, count, 4) ||
                      !add_codes(&own, "heading", codes + 3 * count, count, 1)))
        return false;
    text_add(to->html, "}");
    return true;
}

static bool add_numbers(const Writer *to, const char *name, const float *values, int count)
{
    Arena     scratch = *to->arena;
    uint32_t *codes = ARENA_NEW(&scratch, uint32_t, count);
    for (int i = 0; i < count; i++)
        codes[i] = log_code((double)values[i], 1e-6, 1e9, 65535);
    return add_codes(&(Writer){to->html, &scratch, to->err}, name, codes, (size_t)count, 2);
}

static const float *display_numbers(const LiveSweep *sweep, bool is_lux)
{
    return is_lux ? sweep->lux : sweep->level;
}

/* A display's numbers are the same for all of its symbols and eyes: they stand in the first
 * sweep alone, and the others hold its index. */
static bool add_display_numbers(const Writer *to, const LiveSweep *sweeps, int at, bool is_lux)
{
    const char  *name = is_lux ? "lux" : "level";
    const float *own = display_numbers(&sweeps[at], is_lux);
    int          count = sweeps[at].sky->count;
    for (int i = 0; i < at; i++)
        if (sweeps[i].sky == sweeps[at].sky &&
            !memcmp(display_numbers(&sweeps[i], is_lux), own, (size_t)count * sizeof *own)) {
            text_format(to->html, ",\"%s\":%d", name, i);
            return true;
        }
    return add_numbers(to, name, own, count);
}

static bool add_states(const Writer *to, const LiveSweep *sweep)
{
    Arena     scratch = *to->arena;
    int       count = sweep->sky->count;
    uint32_t *codes = ARENA_NEW(&scratch, uint32_t, count);
    for (int i = 0; i < count; i++)
        codes[i] = (uint32_t)(sweep->verdict[i] | sweep->ambient[i] << 2);
    return add_codes(&(Writer){to->html, &scratch, to->err}, "state", codes, (size_t)count, 1);
}

static void add_limit(Text *html, const LimitVerdict *limit)
{
    if (limit) text_format(html, "[%.9g,\"%s\"]", limit->value, limit->kind);
    else text_add(html, "null");
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
static void add_seen(Text *html, const LiveFound *found, const ReviewSweep *like)
{
    int added = 0;
    text_add(html, ",\"seen\":[");
    for (int i = 0; i < found->review->sweep_count; i++) {
        const ReviewSweep *s = &found->review->sweeps[i];
        if (strcmp(s->condition, like->condition) || strcmp(s->eye, like->eye) ||
            picture_of(found->live, &s->worst) < 0)
            continue;
        text_format(html, "%s[\"s%d\",%.9g,%.9g]", added++ ? "," : "", i,
                    s->worst.sun_azimuth_deg, s->worst.sun_elevation_deg);
    }
    text_add(html, "]");
}

static bool add_sweep(const Writer *to, const LiveFound *found, int at, int sky_id)
{
    const LiveSweep *sweeps = found->live->sweeps, *sweep = &sweeps[at];
    int              count = sweep->sky->count;
    text_format(to->html, "{\"id\":%d,\"sky\":%d,\"worst\":%d", sweep->sweep_id, sky_id,
                sweep->worst);
    add_figure(to->html, "foreground", sweep->foreground);
    add_figure(to->html, "background", sweep->background);
    text_add(to->html, ",\"limits\":[");
    for (int i = 0; i < 4; i++) {
        if (i > 0) text_add(to->html, ",");
        add_limit(to->html, sweep->asked[i]);
    }
    text_add(to->html, "]");
    add_seen(to->html, found, &found->review->sweeps[sweep->sweep_id]);
    if (!add_numbers(to, "reflected", sweep->reflected, count) ||
        !add_numbers(to, "mirror", sweep->mirror, count) ||
        !add_display_numbers(to, sweeps, at, false) ||
        !add_display_numbers(to, sweeps, at, true) || !add_states(to, sweep))
        return false;
    text_add(to->html, "}");
    return true;
}

/* Sweeps of one condition follow each other. Those that are left out lose nothing that the
 * page would show without script. */
static bool add_sweeps(const Writer *to, const LiveFound *found)
{
    const ReviewLive *live = found->live;
    Text  skies = {.arena = to->arena};
    Arena own = arena_reserve((size_t)1 << 34);
    Writer sky_to = {&skies, &own, to->err}, sweep_to = {to->html, &own, to->err};
    const LiveSky *last = NULL;
    int    sky_id = -1;
    size_t start = to->html->size;
    bool   ok = true;
    text_add(to->html, "\"sweeps\":[");
    for (int i = 0; ok && i < live->sweep_count; i++) {
        const LiveSweep *sweep = &live->sweeps[i];
        if (to->html->size - start + skies.size > SWEEPS_BYTES) break;
        if (sweep->sky != last) {
            if (++sky_id > 0) text_add(&skies, ",");
            ok = add_sky(&sky_to, sweep->sky);
        }
        last = sweep->sky;
        if (i > 0) text_add(to->html, ",");
        ok = ok && add_sweep(&sweep_to, found, i, sky_id);
    }
    arena_release(&own);
    text_format(to->html, "],\n\"skies\":[%s]", skies.data ? skies.data : "");
    return ok;
}

/* ---- pictures ---------------------------------------------------------------------------- */

static void add_layers(Text *to, const LivePicture *p)
{
    const char *layers[4] = {p->scene, p->displays, p->eye_scene, p->eye_displays};
    for (int i = 0; i < 4; i++) {
        text_add(to, i ? ",\"" : "[\"");
        text_add(to, layers[i] ? layers[i] : "");
        text_add(to, "\"");
    }
    text_add(to, "]");
}

bool live_layers_write(const LivePicture *picture, const char *path, Error *err)
{
    Arena own = arena_reserve((size_t)1 << 34);
    Text  script = {.arena = &own};
    text_format(&script, "liveLayers(\"%s\",", picture->beside);
    add_layers(&script, picture);
    text_add(&script, ");\n");
    bool ok = file_write(path, script.data, script.size, err);
    arena_release(&own);
    return ok;
}

static void add_picture(Text *html, const LivePicture *p)
{
    text_format(html, "{\"frame\":\"%s\",\"width\":%d,\"height\":%d,\"grey\":%.9g,"
                "\"low\":%.9g,\"high\":%.9g,\"age\":%.9g,\"pigment\":%.9g,\"eye\":%s,",
                p->frame, p->width, p->height, p->grey_cd_m2, p->low, p->high, p->age_years,
                p->pigment, p->eye_scene ? "true" : "false");
    if (p->beside) {
        text_format(html, "\"script\":\"%s\"}", p->beside);
        return;
    }
    text_add(html, "\"layers\":");
    add_layers(html, p);
    text_add(html, "}");
}

/* A case that has a picture: its card, and what its readings are made of. */
static void add_case(Text *html, const Review *review, const ReviewCase *c, int picture,
                     Arena *arena)
{
    const CaseLuminances *l = &c->luminance_cd_m2;
    text_format(html, "{\"card\":\"%s\",\"picture\":%d,\"verdict\":%d",
                review_card_id(review, c, arena), picture, (int)c->verdict);
    add_figure(html, "level", c->level);
    add_figure(html, "foreground", l->foreground);
    add_figure(html, "background", l->background);
    add_figure(html, "reflected", l->reflected);
    text_add(html, ",\"limit\":");
    add_limit(html, c->limit_id >= 0 ? &c->limits[c->limit_id] : NULL);
    text_add(html, "}");
}

static void add_pictures(Text *html, const Review *review, const ReviewLive *live, Arena *arena)
{
    int added = 0;
    text_add(html, ",\n\"pictures\":[");
    for (int i = 0; i < live->picture_count; i++) {
        if (i > 0) text_add(html, ",\n");
        add_picture(html, &live->pictures[i]);
    }
    text_add(html, "],\n\"cases\":[");
    for (int i = 0; i < review_case_count(review); i++) {
        const ReviewCase *c = review_case_at(review, i);
        int picture = picture_of(live, c);
        if (picture < 0) continue;
        if (added++ > 0) text_add(html, ",");
        add_case(html, review, c, picture, arena);
    }
    text_format(html, "],\"colours\":\"%s\"}", live->colours);
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool add_all(Text *to, const Review *review, const ReviewLive *live, Arena *arena,
                    Error *err)
{
    Writer writer = {to, arena, err};
    text_add(to, "{");
    if (!add_sweeps(&writer, &(LiveFound){review, live})) return false;
    add_pictures(to, review, live, arena);
    return true;
}

bool review_live_write(const Review *review, const ReviewLive *live, const char *path,
                       Error *err)
{
    Arena own = arena_reserve(SCRIPT_BYTES), words = arena_reserve(SCRIPT_BYTES);
    Text  script = {.arena = &own};
    text_add(&script, "window.liveData=");
    bool ok = add_all(&script, review, live, &words, err);
    if (ok) {
        text_add(&script, ";\n");
        ok = file_write(path, script.data, script.size, err);
    }
    arena_release(&words);
    arena_release(&own);
    return ok;
}

bool review_live_add(Text *html, const Review *review, const ReviewLive *live, Arena *arena,
                     Error *err)
{
    if (live->sweep_count + live->picture_count == 0) return true;
    if (live->beside) {
        text_format(html, "<script src=\"%s\"></script>\n", live->beside);
        return true;
    }
    text_add(html, "<script type=\"application/json\" id=\"live-data\">\n");
    if (!add_all(html, review, live, arena, err)) return false;
    text_add(html, "</script>\n");
    return true;
}

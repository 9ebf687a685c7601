/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/luxmeter.h"

#include <ctype.h>
#include <string.h>

#include "print/print.h"
#include "cli/options/answer.h"
#include "render/illuminance.h"
#include "scene/load/scene_load.h"
#include "spectrum/photometry.h"
#include "text/point_rows.h"

#define MANY 64 /* points, from which on progress is shown */

typedef struct Places {
    FacingPoint *list;
    int count;
    bool is_single; /* one option with its numbers: the answer is no list */
} Places;

/* ---- where ------------------------------------------------------------------------------- */

/* Numbers with commas, or what is meant to be such. */
static bool is_numbers(const char *text) {
    int commas = 0;
    for (const char *at = text; *at; at++) commas += *at == ',';
    return commas == 5 || (commas && (isdigit((unsigned char)*text) || strchr("+-.", *text)));
}

static bool read_place(const char *text, FacingPoint *out, Error *err) {
    double values[6];
    if (!cli_numbers(text, 6, values))
        return error_set(err, ERROR_USAGE,
                         "--illuminance %.200s: required 6 numbers with "
                         "commas between (X,Y,Z,NX,NY,NZ), or a file of them",
                         text);
    for (int i = 0; i < 6; i++)
        if (!(values[i] >= -1e9 && values[i] <= 1e9))
            return error_set(err, ERROR_USAGE,
                             "--illuminance: %g is out of range, required "
                             "-1000000000 to 1000000000",
                             values[i]);
    return point_row_set(values, out) || error_set(err, ERROR_USAGE,
                                                   "--illuminance: the normal (%g, %g, %g) has no "
                                                   "direction",
                                                   values[3], values[4], values[5]);
}

static bool read_places(const CliTexts *texts, Arena *arena, Places *out, Error *err) {
    *out = (Places){.is_single = texts->count == 1 && is_numbers(texts->list[0])};
    for (int i = 0; i < texts->count; i++) {
        FacingPoint one, *more = &one;
        int count = 1;
        const char *text = texts->list[i];
        if (is_numbers(text) ? !read_place(text, &one, err)
                             : !point_rows_read(text, arena, &more, &count, err))
            return false;
        out->list = ARENA_GROW(arena, FacingPoint, out->list, out->count, out->count + count);
        memcpy(out->list + out->count, more, (size_t)count * sizeof *more);
        out->count += count;
    }
    return true;
}

/* ---- the answer -------------------------------------------------------------------------- */

static void xy_of(const Illuminance *e, float xy[2]) {
    float xyz[3];
    for (int k = 0; k < 3; k++) xyz[k] = (float)e->xyz_lx[k];
    xy_from_xyz(xyz, xy);
}

static json_t *json_of(const FacingPoint *at, const Illuminance *e, long samples) {
    float xy[2];
    xy_of(e, xy);
    return json_pack("{s:f, s:[f,f], s:[f,f], s:I, s:[f,f,f], s:[f,f,f]}", "illuminance_lx",
                     e->xyz_lx[1], "illuminance_interval", e->low_lx, e->high_lx, "xy",
                     (double)xy[0], (double)xy[1], "samples", (json_int_t)samples, "place",
                     at->place[0], at->place[1], at->place[2], "normal", at->normal[0],
                     at->normal[1], at->normal[2]);
}

static void print_csv(const Places *places, const Illuminance *found) {
    print("x,y,z,nx,ny,nz,illuminance_lx,low_lx,high_lx,cie_x,cie_y\n");
    for (int i = 0; i < places->count; i++) {
        const double *p = places->list[i].place, *n = places->list[i].normal;
        float xy[2];
        xy_of(&found[i], xy);
        print("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", p[0], p[1], p[2], n[0],
              n[1], n[2], found[i].xyz_lx[1], found[i].low_lx, found[i].high_lx, (double)xy[0],
              (double)xy[1]);
    }
}

static const Column ILLUMINANCE[] = {{.key = "illuminance_lx",
                                      .words = "illuminance",
                                      .unit = "lx",
                                      .interval = "illuminance_interval"},
                                     {.key = "xy", .words = "x, y", .is_fixed = true, .places = 4},
                                     {.key = "place", .words = "at", .unit = "m"},
                                     COLUMN_DIGITS("normal", "facing", NULL, 4),
                                     COLUMN_KEY("samples", "paths")};
const TableKind luxmeter_kind = TABLE_KIND("illuminance", NULL, ILLUMINANCE);

static bool print_answer(const Cli *cli, const LuxmeterRequest *request, const Places *places,
                         const Illuminance *found, Error *err) {
    if (request->wants_csv) {
        print_csv(places, found);
        return true;
    }
    json_t *list = json_array();
    for (int i = 0; i < places->count; i++)
        json_array_append_new(list, json_of(&places->list[i], &found[i], request->samples));
    json_t *answer = places->is_single ? json_incref(json_array_get(list, 0)) : json_incref(list);
    json_decref(list);
    return cli_print_answer(&luxmeter_kind, answer, cli->json, err);
}

/* ---- the measurement --------------------------------------------------------------------- */

static LitPoint *lit_points(const Scene *scene, const Places *places, Arena *arena) {
    LitPoint *out = ARENA_NEW(arena, LitPoint, places->count);
    for (int i = 0; i < places->count; i++) {
        const FacingPoint *at = &places->list[i];
        out[i] = (LitPoint){scene_from_world(scene->origin, at->place),
                            vec3_from_doubles(at->normal), false};
    }
    return out;
}

bool luxmeter_run(const Cli *cli, const LuxmeterRequest *request, Arena *arena, Error *err) {
    Problems problems = problems_start(arena);
    Places places;
    Scene *scene;
    if (request->wants_csv && cli->json)
        return error_set(err, ERROR_USAGE, "--csv and --json exclude each other");
    if (!read_places(&request->places, arena, &places, err)) return false;
    const SceneAsked asked = {&request->scene, &request->environment, cli->progress, &cli->outputs};
    if (!scene_options_load(&asked, arena, &problems, &scene, err)) return false;
    cli_print_warnings(&problems);
    const IlluminanceOptions options = {.points = lit_points(scene, &places, arena),
                                        .count = places.count,
                                        .samples = request->samples,
                                        .max_bounces = 64,
                                        .threads = cli->threads,
                                        .progress =
                                            places.count > MANY ? cli->progress : PROGRESS_NONE};
    Illuminance *found = ARENA_NEW(arena, Illuminance, places.count);
    bool ok = illuminance_measure(scene, &options, arena, found, err) &&
              print_answer(cli, request, &places, found, err);
    scene_close(scene);
    return ok;
}

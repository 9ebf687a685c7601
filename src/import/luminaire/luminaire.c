/* SPDX-License-Identifier: Apache-2.0 */
#include "import/luminaire/luminaire.h"

#include <math.h>
#include <stdarg.h>

#include "base/file.h"
#include "base/mathd.h"
#include "base/units.h"
#include "import/set/import_rows.h"
#include "import/text/text_options.h"

#define ROUND_PLANES 36
#define DOUBT_BYTES 400

typedef struct Plane {
    double c_deg;
    int source; /* index of the stored plane */
} Plane;

void luminaire_doubt(Luminaire *luminaire, Arena *arena, const char *format, ...) {
    va_list list;
    if (luminaire->doubts == LUMINAIRE_DOUBTS_MAX) return;
    va_start(list, format);
    luminaire->doubt[luminaire->doubts++] = arena_format_list(arena, DOUBT_BYTES, format, list);
    va_end(list);
}

/* ---- all planes -------------------------------------------------------------------------- */

static double turned(double degrees) {
    double angle = fmod(degrees, 360);
    return angle < 0 ? angle + 360 : angle;
}

static bool is_there(const Plane *plane, int count, double c_deg) {
    for (int i = 0; i < count; i++)
        if (fabs(remainder(plane[i].c_deg - c_deg, 360)) < 1e-6) return true;
    return false;
}

static void sort_planes(Plane *plane, int count) {
    for (int i = 1; i < count; i++)
        for (int k = i; k > 0 && plane[k].c_deg < plane[k - 1].c_deg; k--) {
            Plane swap = plane[k];
            plane[k] = plane[k - 1];
            plane[k - 1] = swap;
        }
}

/* The stored planes and their mirror images, each azimuth once. Types A and B have them all,
 * and do not go around. */
static int expand_planes(const Luminaire *in, Plane *plane) {
    int count = 0;
    if (in->type != WEB_C) {
        for (; count < in->planes; count++) plane[count] = (Plane){in->c_deg[count], count};
        return count;
    }
    if (in->is_round) {
        for (int i = 0; i < ROUND_PLANES; i++)
            plane[count++] = (Plane){i * 360.0 / ROUND_PLANES, 0};
        return count;
    }
    for (int i = 0; i < in->planes; i++) {
        double c = turned(in->c_deg[i]);
        if (!is_there(plane, count, c)) plane[count++] = (Plane){c, i};
    }
    for (int m = 0; m < 2; m++) {
        int stored = count;
        for (int i = 0; i < stored && in->mirror_deg[m] >= 0; i++) {
            double c = turned(2 * in->mirror_deg[m] - plane[i].c_deg);
            if (!is_there(plane, count, c)) plane[count++] = (Plane){c, plane[i].source};
        }
    }
    sort_planes(plane, count);
    return count;
}

/* ---- flux -------------------------------------------------------------------------------- */

/* Integral of I sin(gamma) between two gammas (radians), I linear between them. */
static double ring_integral(double a, double b, double at_a, double at_b) {
    double slope = (at_b - at_a) / (b - a);
    return at_a * cos_d(a) - at_b * cos_d(b) + slope * (sin_d(b) - sin_d(a));
}

/* Flux of one plane from gamma 0 up to a limit, lm per radian of azimuth. */
static double plane_flux(const Luminaire *in, int plane, double limit_deg) {
    const double *intensity = in->intensity_cd + (size_t)plane * (size_t)in->gammas;
    double sum = 0, limit = radians_from_degrees(limit_deg);
    for (int i = 1; i < in->gammas; i++) {
        double a = radians_from_degrees(in->gamma_deg[i - 1]);
        double b = radians_from_degrees(in->gamma_deg[i]), at_b = intensity[i];
        if (a >= limit) break;
        if (b > limit) {
            at_b = intensity[i - 1] + (at_b - intensity[i - 1]) * (limit - a) / (b - a);
            b = limit;
        }
        sum += ring_integral(a, b, intensity[i - 1], at_b);
    }
    return sum;
}

/* Each plane stands for half the way to its neighbours. In types A and B gamma is the latitude
 * plus 90: the same integral, and nothing but `front`, +-90 of longitude, is there. */
static double total_flux(const Luminaire *in, const Plane *plane, int count, double limit_deg) {
    double sum = 0, turn = in->type == WEB_C ? 360 : 0;
    if (in->type != WEB_C) limit_deg = 180;
    for (int i = 0; i < count; i++) {
        int last = turn > 0 ? count - 1 : 0, first = turn > 0 ? 0 : count - 1;
        double before = i ? plane[i - 1].c_deg : plane[last].c_deg - turn;
        double after = i + 1 < count ? plane[i + 1].c_deg : plane[first].c_deg + turn;
        double width = count > 1 ? radians_from_degrees((after - before) / 2) : 2 * PI;
        sum += width * plane_flux(in, plane[i].source, limit_deg);
    }
    return sum;
}

static bool note_flux(const Luminaire *in, const Plane *plane, int count, ImportSet *set,
                      Error *err) {
    const char *name = path_name(in->file);
    double front = total_flux(in, plane, count, 90), all = total_flux(in, plane, count, 180);
    if (!(front > 0))
        return error_at(err, ERROR_INPUT, in->file, "",
                        "shines nothing within 90 degrees of gamma 0, required: a luminaire "
                        "that lights in front of its face");
    import_note(set, "%s: the intensities add up to %.6g lm in front of the face", name, front);
    if (all > front * (1 + 1e-9))
        import_note(set, "%s: %.3g%% of the flux goes beyond 90 degrees and is left out", name,
                    100 * (all - front) / all);
    if (in->stated_lm > 0)
        import_note(set,
                    "%s: %.6g lm in all directions, the file states %.6g lm (%s): ratio "
                    "%.4f",
                    name, all, in->stated_lm, in->stated_as, all / in->stated_lm);
    else
        import_note(set, "%s: %.6g lm in all directions; the file states none (absolute)", name,
                    all);
    return true;
}

/* ---- the table --------------------------------------------------------------------------- */

static bool find_area(const Luminaire *in, const ImportOptions *options, double *area_m2,
                      Error *err) {
    double given = options->area_mm[0] * options->area_mm[1] * 1e-6;
    *area_m2 = given > 0 ? given : in->area_m2;
    return *area_m2 > 0 || error_at(err, ERROR_INPUT, in->file, "",
                                    "states no luminous area, which luminance needs — give it "
                                    "with --area-mm W,H");
}

static double phi_of(const ImportOptions *options, double c_deg) {
    const TextOptions *d = options->text;
    double zero = d && d->has_azimuth_zero ? d->azimuth_zero_deg : 0;
    int sense = d && d->azimuth_sense ? d->azimuth_sense : -1;
    return turned(zero + sense * c_deg);
}

/* Unit direction of a grid point, luminaire's frame. */
static Vec3 direction_at(WebType type, double c, double gamma) {
    Vec3 d = vec3((float)(sin_d(gamma) * cos_d(c)), (float)(sin_d(gamma) * sin_d(c)),
                  -(float)cos_d(gamma));
    return luminaire_from_web(type, d);
}

/* Where a grid point lies as the viewer sees it, degrees. */
static void view_angles(const Luminaire *in, const ImportOptions *options, double c_deg,
                        double gamma_deg, double *theta_deg, double *phi_deg) {
    *theta_deg = gamma_deg;
    *phi_deg = phi_of(options, c_deg);
    if (in->type == WEB_C) return;
    Vec3 d = direction_at(in->type, radians_from_degrees(c_deg), radians_from_degrees(gamma_deg));
    double right = (double)d.y, up = (double)d.x, across = sqrt(right * right + up * up);
    *theta_deg = degrees_from_radians(atan2_d(across, -(double)d.z));
    *phi_deg = phi_of(options, across > 0 ? -degrees_from_radians(atan2_d(up, right)) : 0);
}

static void fill(const Luminaire *in, const Plane *plane, int count, const ImportOptions *options,
                 double area_m2, ImportRows *rows) {
    for (int i = 0; i < count; i++)
        for (int k = 0; k < in->gammas; k++) {
            double theta, phi;
            view_angles(in, options, plane[i].c_deg, in->gamma_deg[k], &theta, &phi);
            if (theta > 90 - 1e-6) continue; /* a flat face has no luminance at its horizon */
            size_t at = (size_t)plane[i].source * (size_t)in->gammas + (size_t)k;
            double cosine = cos_d(radians_from_degrees(theta));
            double luminance = in->intensity_cd[at] / (area_m2 * cosine);
            import_rows_put(rows, theta, phi, &luminance);
        }
}

static void note_azimuths(const Luminaire *in, const ImportOptions *options, double area_m2,
                          ImportSet *set) {
    const char *sense =
        phi_of(options, 90) == turned(phi_of(options, 0) + 90) ? "counter-clockwise" : "clockwise";
    if (in->type == WEB_C)
        import_note(set,
                    "%s: luminance is intensity over %.6g mm2 times the cosine; C-planes "
                    "run %s as the viewer sees them",
                    path_name(in->file), area_m2 * 1e6, sense);
    else
        import_note(set,
                    "%s: luminance is intensity over %.6g mm2 times the cosine; type %s: "
                    "the viewer sees V run up and H to the left",
                    path_name(in->file), area_m2 * 1e6, in->type == WEB_A ? "A" : "B");
}

bool luminaire_add(const Luminaire *in, const ImportOptions *options, ImportSet *set, Error *err) {
    Arena *arena = set->arena;
    Plane *plane = ARENA_NEW(arena, Plane, 4 * (size_t)in->planes + ROUND_PLANES);
    int count = expand_planes(in, plane);
    size_t most = (size_t)count * (size_t)in->gammas;
    double area_m2;
    if (most > IMPORT_ROWS_MAX)
        return error_at(err, ERROR_INPUT, in->file, "",
                        "has %zu directions, required: at "
                        "most %d",
                        most, IMPORT_ROWS_MAX);
    if (!find_area(in, options, &area_m2, err) || !note_flux(in, plane, count, set, err))
        return false;
    ImportTable table = {.source = IMPORT_WHITE, .file = in->file, .level = 255, .component = 'Y'};
    ImportRows rows = import_rows(arena, (int)most, 0, 1);
    fill(in, plane, count, options, area_m2, &rows);
    import_rows_give_measured(&rows, &table);
    note_azimuths(in, options, area_m2, set);
    for (int i = 0; i < in->doubts; i++)
        import_note(set, "%s: %s", path_name(in->file), in->doubt[i]);
    if (in->name && !set->panel) set->panel = in->name;
    return import_add(set, &table, err);
}

/* ---- all directions ---------------------------------------------------------------------- */

/* Row i is a plane of the file; in type C the row behind the last closes the turn. */
static void fill_web(const Luminaire *in, const Plane *plane, float *c, float *relative,
                     IntensityWeb *web) {
    bool closes = in->type == WEB_C;
    for (int i = 0; i <= web->planes; i++) {
        const Plane *at = &plane[closes ? i % web->planes : i];
        const double *row = in->intensity_cd + (size_t)at->source * (size_t)in->gammas;
        double turns = closes && i == web->planes ? 2 * PI : 0;
        c[i] = (float)(radians_from_degrees(at->c_deg) + turns);
        for (int k = 0; k < in->gammas; k++) {
            float cd = (float)row[k];
            relative[i * in->gammas + k] = cd;
            if (!(cd > web->largest_cd)) continue;
            web->largest_cd = cd;
            web->brightest = direction_at(in->type, (double)c[i], (double)web->gamma[k]);
        }
    }
}

double luminaire_flux(const Luminaire *in, Arena scratch) {
    Plane *plane = ARENA_NEW(&scratch, Plane, 4 * (size_t)in->planes + ROUND_PLANES);
    return total_flux(in, plane, expand_planes(in, plane), 180);
}

bool luminaire_web(const Luminaire *in, Arena *arena, IntensityWeb *out, Error *err) {
    Plane *plane = ARENA_NEW(arena, Plane, 4 * (size_t)in->planes + ROUND_PLANES);
    int count = expand_planes(in, plane);
    int planes = in->type != WEB_C ? count - 1 : in->is_round ? 1 : count;
    size_t total = (size_t)(planes + 1) * (size_t)in->gammas;
    float *gamma = ARENA_NEW(arena, float, in->gammas);
    if (total > IMPORT_ROWS_MAX)
        return error_at(err, ERROR_INPUT, in->file, "",
                        "has %zu directions, required: at "
                        "most %d",
                        total, IMPORT_ROWS_MAX);
    float *c = ARENA_NEW(arena, float, planes + 1), *relative = ARENA_NEW(arena, float, total);
    for (int k = 0; k < in->gammas; k++) gamma[k] = (float)radians_from_degrees(in->gamma_deg[k]);
    IntensityWeb web = {in->type, planes, in->gammas, c, gamma, relative, 0, 0, vec3(0, 0, -1)};
    web.flux_lm = (float)total_flux(in, plane, count, 180);
    fill_web(in, plane, c, relative, &web);
    if (!(web.largest_cd > 0))
        return error_at(err, ERROR_INPUT, in->file, "",
                        "has no intensity above 0 cd, required: a luminaire that lights");
    for (size_t i = 0; i < total; i++) relative[i] /= web.largest_cd;
    *out = web;
    return true;
}

/* ---- tilted lamps ------------------------------------------------------------------------ */

/* The luminaire that is not tilted has its photometric zero straight down: gamma = 0, or in
 * type A V = -90; its photometric horizontal is C = 0, or in type A (0, 0) (LM-63-2002, 3). */
static Vec3 lamp_axis(const LuminaireTilt *tilt, WebType type) {
    if (tilt->geometry == 3) return vec3(0, 1, 0);
    bool is_zero = tilt->geometry == 1;
    if (type == WEB_A) return is_zero ? vec3(-1, 0, 0) : vec3(0, 0, -1);
    return is_zero ? vec3(0, 0, -1) : vec3(1, 0, 0);
}

double luminaire_tilt_factor(const LuminaireTilt *tilt, WebType type, Vec3 down,
                             double *angle_deg) {
    *angle_deg = 0;
    if (!tilt->geometry) return 1;
    const double *angle = tilt->angle_deg, *factor = tilt->factor;
    Vec3 axis = lamp_axis(tilt, type), across = vec3_cross(axis, down);
    double along = (double)vec3_dot(axis, down), beside = (double)vec3_length(across);
    int last = tilt->count - 1, i = 0;
    double tilted = degrees_from_radians(atan2_d(beside, along)); /* from the vertical */
    if (tilt->geometry != 1) tilted = fabs(90 - tilted);
    if (angle[last] <= 90 && tilted > 90) tilted = 180 - tilted;
    *angle_deg = tilted;
    if (tilted <= angle[0]) return factor[0];
    if (tilted >= angle[last]) return factor[last];
    while (angle[i + 1] < tilted) i++;
    double share = (tilted - angle[i]) / (angle[i + 1] - angle[i]);
    return factor[i] + share * (factor[i + 1] - factor[i]);
}

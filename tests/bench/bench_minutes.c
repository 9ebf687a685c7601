/* SPDX-License-Identifier: Apache-2.0 */
/* bench_minutes PATHS EVERY REVIEW.json LIMIT ... -- minutes of a year in which the first
 * symbol, as the first eye sees it, has less contrast than each limit: of the first condition,
 * a year under clear skies at one level, for each of its headings; of EVERY so manyth day (1:
 * all) all minutes.
 *
 * Nothing of a sweep is used: paths of its own are traced for the sun of every minute (PATHS),
 * as a frame's are. Skies are read with paths, too, at so many places of the sun, and lie
 * between them. With the sweep it shares where the sun stands, how bright sun and sky are, what
 * the symbol emits, and the path tracer.
 *
 * Approximate  the sun's spectrum is a black body's of 5500 K, its illuminance that of the air:
 *              the first lines say by how much that moves what is reflected. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "base/sampler.h"
#include "base/units.h"
#include "bench_timing.h"
#include "review/request/request_read.h"
#include "review/run/cases.h"
#include "review/light/setup.h"

#define DAYS 365
#define DAY 1440 /* minutes: one piece of work */
#define PIECE 64 /* paths */
#define LIMITS_MOST 8
#define SKY_COLUMNS 12
#define SKY_PATHS 16384
#define SKY_PRECISION 0.003
#define BEAMS 29

/* Of the sun, degrees: skies, and beams, closer. */
static const double row_elevation[] = {0, 5, 16, 36, 66};
enum { SKY_ROWS = sizeof row_elevation / sizeof *row_elevation };

static double beam_elevation(int i) {
    return 0.09 * i * i;
}

typedef struct Brute {
    Setup setup;
    ProbeAim aim;
    PathContext by_sun; /* of all suns; lights are each one's own */
    DaylightInput air;
    int paths, every;
    double shown[2];                   /* cd m^-2 */
    double sky[SKY_ROWS][SKY_COLUMNS]; /* and the display's own light */
    double beam[BEAMS];                /* lx */
    double limits[LIMITS_MOST];
    int limit_count;
    double heading_deg;
    long failed[PARALLEL_THREADS_MAX][LIMITS_MOST], up[PARALLEL_THREADS_MAX];
    Arena rooms[PARALLEL_THREADS_MAX];
} Brute;

static _Noreturn void stop(const Error *err) {
    fprintf(stderr, "%s: %s\n", err->path, err->text);
    exit(2);
}

/* ---- light ------------------------------------------------------------------------------- */

static Environment environment_at(const Brute *b, SunAngles sun, double heading_deg) {
    const double *forward = b->setup.request->forward;
    return (Environment){.forward = vec3((float)forward[0], (float)forward[1], (float)forward[2]),
                         .heading = (float)radians_from_degrees(heading_deg),
                         .daylight = b->air,
                         .has_sun = true,
                         .sun_azimuth = (float)radians_from_degrees(sun.azimuth_deg),
                         .sun_elevation = (float)radians_from_degrees(sun.elevation_deg),
                         .sun_angular_radius = (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG)};
}

static double beam_at(const Brute *b, double elevation_deg) {
    int i = (int)sqrt(fmax(elevation_deg, 0) / beam_elevation(1));
    double low = beam_elevation(i), high = beam_elevation(i + 1);
    return b->beam[i] * pow(b->beam[i + 1] / b->beam[i], (elevation_deg - low) / (high - low));
}

static void fill_beam(void *user, int i, int worker) {
    Brute *b = user;
    Arena room = b->rooms[worker];
    DaylightInput input = b->air;
    Daylight sky;
    Error err = {0};
    input.sun_elevation = radians_from_degrees(beam_elevation(i));
    input.threads = 1;
    if (!daylight_build(&input, &room, &sky, &err)) stop(&err);
    b->beam[i] = sky.metrics.direct_normal_lx;
}

/* Under a sky with its sun (lux -1) or without (0), heading north. */
static double reading_under(Brute *b, SunAngles sun, float lux, Arena arena) {
    Environment environment = environment_at(b, sun, 0);
    ReadingGoal goal = {.precision = SKY_PRECISION, .most = SKY_PATHS};
    Error err = {0};
    environment.kind = ENVIRONMENT_SKY;
    environment.sun_illuminance_lx = lux;
    if (!setup_light(&b->setup, &environment, &arena, &err)) stop(&err);
    b->aim.context = &b->setup.context;
    return reading_take(&b->aim, &goal, &b->setup.tools, arena).reflected;
}

/* Between four values, the place is `along` from b to c (Catmull and Rom's cubic). */
static double between(double a, double b, double c, double d, double along) {
    double bend = 2 * a - 5 * b + 4 * c - d, twist = 3 * (b - c) + d - a;
    return b + 0.5 * along * (c - a + along * (bend + along * twist));
}

static double row_at(const double *row, double azimuth_deg) {
    double place = fmod(azimuth_deg + 720, 360) * SKY_COLUMNS / 360;
    int i = (int)place, n = SKY_COLUMNS;
    return between(row[(i + n - 1) % n], row[i % n], row[(i + 1) % n], row[(i + 2) % n], place - i);
}

static double sky_at(const Brute *b, SunAngles of_vehicle) {
    int row = 0;
    while (row < SKY_ROWS - 2 && row_elevation[row + 1] <= of_vehicle.elevation_deg) row++;
    double low = row_elevation[row], high = row_elevation[row + 1];
    double up = (of_vehicle.elevation_deg - low) / (high - low);
    return (1 - up) * row_at(b->sky[row], of_vehicle.azimuth_deg) +
           up * row_at(b->sky[row + 1], of_vehicle.azimuth_deg);
}

/* ---- a minute ---------------------------------------------------------------------------- */

/* What paths bring of the sun alone. */
static double sun_reading(const Brute *b, SunAngles sun, double heading_deg, Arena room) {
    Scene scene = *b->setup.scene; /* with light of its own */
    Lights *lights;
    Error err = {0};
    scene.environment = environment_at(b, sun, heading_deg);
    scene.environment.sun_illuminance_lx = (float)beam_at(b, sun.elevation_deg);
    if (!lights_build(&scene, &room, &lights, &err)) stop(&err);
    PathContext context = b->by_sun;
    ProbeAim aim = b->aim;
    context.lights = lights;
    PathStatistics statistics = {0};
    double sum = 0, found = 0;
    aim.context = &context;
    aim.is_spread = true;
    aim.seed = hash_combine(hash_u32((uint32_t)(1e5 * sun.elevation_deg)),
                            (uint32_t)(1e5 * sun.azimuth_deg));
    for (int first = 0; first < b->paths; first += PIECE) {
        ProbeLook looks[PIECE];
        b->setup.tools.kernel->look(&aim, first, first + PIECE, looks, &statistics);
        for (int i = 0; i < PIECE; i++) {
            sum += (double)looks[i].reflected[1];
            found += looks[i].is_found;
        }
    }
    return sum / found;
}

static void look_at_day(void *user, int item, int worker) {
    Brute *b = user;
    int day = item * b->every;
    const SkyPlace *where = &b->setup.condition->where;
    SkyTime start = {.year = b->setup.condition->year, .month = 1, .day = 1};
    double mbar, celsius;
    standard_atmosphere(where->altitude_m, &mbar, &celsius);
    for (int minute = 0; minute < DAY; minute++) {
        double when = sky_julian_day(&start) + day + (minute + 0.5) / DAY;
        SunPosition at = sun_position(when, sky_delta_t_s(when), where);
        SunAngles sun = {at.azimuth_deg,
                         at.elevation_deg + sun_refraction_deg(at.elevation_deg, mbar, celsius)};
        if (sun.elevation_deg < 0) continue;
        SunAngles of_vehicle = {sun.azimuth_deg - b->heading_deg, sun.elevation_deg};
        double reflected =
            (sky_at(b, of_vehicle) + sun_reading(b, sun, b->heading_deg, b->rooms[worker])) /
            (at.distance_au * at.distance_au);
        double contrast = luminance_contrast(b->shown[0], b->shown[1], reflected);
        b->up[worker]++;
        for (int i = 0; i < b->limit_count; i++) b->failed[worker][i] += contrast < b->limits[i];
    }
}

static void set_levels(Brute *b, float level) {
    for (int i = 0; i < b->setup.scene->display_count; i++)
        b->setup.scene->displays[i].level = level;
}

/* ---- a year ------------------------------------------------------------------------------ */

static void prepare(Brute *b, Arena arena) {
    b->air = daylight_input_default(DAYLIGHT_CLEAR);
    b->air.where = b->setup.condition->where;
    b->air.has_sun = b->air.no_moon = true;
    b->air.sun_lux = -1;
    parallel_for(b->setup.tools.threads, BEAMS, fill_beam, b);
    for (int row = 0; row < SKY_ROWS; row++)
        for (int c = 0; c < SKY_COLUMNS; c++)
            b->sky[row][c] = reading_under(
                b, (SunAngles){360.0 * c / SKY_COLUMNS, row_elevation[row]}, 0, arena);
}

/* What suns alone need besides themselves. Beams off mirrors are left to chance. */
static void prepare_suns(Brute *b, Arena *arena) {
    Lights *lights;
    Error err = {0};
    b->setup.scene->environment = environment_at(b, (SunAngles){0, 45}, 0);
    b->setup.scene->environment.sun_illuminance_lx = 1;
    set_levels(b, 0);
    if (!lights_build(b->setup.scene, arena, &lights, &err)) stop(&err);
    b->by_sun = path_context_build(b->setup.scene, b->setup.bvh, lights, SETUP_BOUNCES, arena);
    memset(b->by_sun.beams, 0, sizeof b->by_sun.beams);
}

/* Readings of the same sun with its own spectrum and with a black body's. */
static void compare_spectra(Brute *b, Arena arena) {
    for (int row = 1; row < SKY_ROWS; row += 3) {
        double own = 0, black = 0;
        for (int c = 0; c < SKY_COLUMNS; c += 6) {
            SunAngles sun = {360.0 * c / SKY_COLUMNS, row_elevation[row]};
            own += reading_under(b, sun, -1, arena);
            set_levels(b, 0);
            black += b->sky[row][c] + sun_reading(b, sun, 0, arena);
        }
        printf("sun %4.1f degrees high: black body %.4f of its own spectrum\n", row_elevation[row],
               black / own);
    }
    fflush(stdout);
}

static void tell_year(Brute *b, double heading_deg) {
    int threads = b->setup.tools.threads;
    b->heading_deg = heading_deg;
    for (int w = 0; w < threads; w++) {
        b->up[w] = 0;
        for (int i = 0; i < b->limit_count; i++) b->failed[w][i] = 0;
    }
    parallel_for(threads, (DAYS + b->every - 1) / b->every, look_at_day, b);
    for (int i = 0; i < b->limit_count; i++) {
        long failed = 0, up = 0;
        for (int w = 0; w < threads; w++) failed += b->failed[w][i], up += b->up[w];
        printf("heading %g limit %g: %ld of %ld minutes\n", heading_deg, b->limits[i], failed, up);
    }
    fflush(stdout);
}

static void open_first(Brute *b, const ReviewRequest *request, Problems *problems, Arena *arena) {
    SetupOptions options = {.request = request,
                            .condition = &request->conditions[0],
                            .means.threads = parallel_default_threads()};
    SetupSymbol *symbols;
    int count;
    Vec3 eye;
    Error err = {0};
    if (!setup_open(&options, arena, problems, &b->setup, &err) ||
        !setup_light(&b->setup, NULL, arena, &err) ||
        !setup_symbols(&b->setup, arena, &symbols, &count, &err) ||
        !setup_eye_middle(&b->setup, &request->eyes[0], *arena, &eye, &err))
        stop(&err);
    const SymbolSurface *surface = &symbols[0].surface;
    bool *is_visible = ARENA_NEW(arena, bool, surface->point_count);
    Vec3 *targets = ARENA_NEW(arena, Vec3, surface->point_count);
    b->aim = (ProbeAim){.context = &b->setup.context, .eye = eye, .targets = targets};
    SymbolVisibility seen = symbol_visibility(surface, &b->setup.context, eye, is_visible);
    for (int i = 0; i < surface->point_count; i++)
        if (is_visible[i]) targets[b->aim.target_count++] = surface->points[i].position;
    double level = (double)b->setup.scene->displays[symbols[0].display.display_id].level;
    SymbolLook look = {surface, &symbols[0].split, eye, b->setup.tools.threads, &seen};
    SymbolEmission shown = symbol_emission(&look, level);
    b->shown[0] = shown.xyz[SYMBOL_FOREGROUND][1];
    b->shown[1] = shown.xyz[SYMBOL_BACKGROUND][1];
}

int main(int argc, char **argv) {
    static Brute brute;
    Brute *b = &brute;
    Arena arena = arena_reserve((size_t)1 << 34);
    Problems problems = problems_start(&arena);
    ReviewRequest request;
    Error err = {0};
    b->paths = argc > 4 ? atoi(argv[1]) / PIECE * PIECE : 0;
    b->every = argc > 4 ? atoi(argv[2]) : 0;
    if (b->paths < PIECE || b->every < 1) {
        fprintf(stderr, "bench_minutes PATHS EVERY REVIEW.json LIMIT ...\n");
        return 1;
    }
    for (int i = 4; i < argc && b->limit_count < LIMITS_MOST; i++)
        b->limits[b->limit_count++] = atof(argv[i]);
    if (!review_request_read(argv[3], NULL, &arena, &problems, &request, &err)) stop(&err);
    open_first(b, &request, &problems, &arena);
    for (int w = 0; w < b->setup.tools.threads; w++) b->rooms[w] = arena_reserve((size_t)1 << 28);
    prepare(b, arena);
    printf("skies and beams: %.0f s of processor time\n", clock_seconds(CLOCK_PROCESS_CPUTIME_ID));
    fflush(stdout);
    prepare_suns(b, &arena);
    compare_spectra(b, arena);
    for (int h = 0; h < b->setup.condition->heading_count; h++)
        tell_year(b, b->setup.condition->headings_deg[h]);
    printf("all: %.0f s of processor time\n", clock_seconds(CLOCK_PROCESS_CPUTIME_ID));
    for (int w = 0; w < b->setup.tools.threads; w++) arena_release(&b->rooms[w]);
    setup_close(&b->setup);
    arena_release(&arena);
    return 0;
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/distant_probe.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/count.h"
#include "base/parallel.h"
#include "base/units.h"
#include "render/identity.h"
#include "review/light/reading.h"
#include "review/light/response_suns.h"

/* ---- a sky over a response --------------------------------------------------------------- */

/* A probe and what of it sends anything. */
typedef struct SkyProbe {
    DistantProbe *of;
    const int *cells;
    const Spectrum *shares; /* by band, of cells[i], first and rest together */
    const Spectrum *groups; /* by group, likewise */
    int count;
} SkyProbe;
_Static_assert(RESPONSE_GROUPS == SPECTRUM_LANES, "a cell's groups fill a spectrum's lanes");

/* A row of the table over all probes, so that each sky is looked up once. */
typedef struct SkySum {
    const Daylight *sky; /* the row's */
    const SkyProbe *probes;
    int probe_count, row, cell_count, first_azimuth;
    const bool *is_asked; /* [cell] by any of the probes */
    const SunAngles *at;  /* [cell] of the vehicle */
    Spectrum *bands;      /* [worker][cell], cd m^-2 */
    float *light;         /* [worker][cell] their sums */
} SkySum;

/* A total without each of the groups in turn, by their parts of white light. */
static void shares_without(const Response *response, const double white[RESPONSE_GROUPS],
                           double total, float out[RESPONSE_GROUPS]) {
    double all = 0;
    for (int k = 0; k < RESPONSE_GROUPS; k++) all += white[k];
    for (int k = 0; k < RESPONSE_GROUPS; k++)
        out[k] =
            (float)(all > 0 ? total * response_without(response, k, all, white[k]) / all : total);
}

/* A response to white light as samples by class and group; they add up to its groups. */
typedef struct WhiteSamples {
    double of[RESPONSE_CLASSES][RESPONSE_GROUPS];
} WhiteSamples;

static void add_white(const Response *response, int cell, double light, WhiteSamples *to) {
    const float *groups = response->groups + 2 * (size_t)cell * RESPONSE_GROUPS;
    double *sums = to->of[cell % RESPONSE_CLASSES];
    for (int k = 0; k < RESPONSE_GROUPS; k++) sums[k] += light * (double)groups[k];
}

/* The same of a total, and what that is without each group. */
static BrightSamples read_white(const Response *response, const WhiteSamples *white, double total,
                                float without[RESPONSE_GROUPS]) {
    BrightSamples bright = {0};
    double groups[RESPONSE_GROUPS] = {0}, all = 0;
    for (int c = 0; c < RESPONSE_CLASSES; c++)
        for (int k = 0; k < RESPONSE_GROUPS; k++) groups[k] += white->of[c][k];
    for (int k = 0; k < RESPONSE_GROUPS; k++) all += groups[k];
    for (int c = 0; c < RESPONSE_CLASSES && all > 0; c++)
        for (int k = 0; k < RESPONSE_GROUPS; k++)
            bright_add(&bright, total / all * white->of[c][k]);
    shares_without(response, groups, total, without);
    return bright;
}

static void look_up(const SkySum *sum, int azimuth, Spectrum *bands, float *light) {
    double turn = 360.0 * azimuth / SKY_AZIMUTHS;
    for (int cell = 0; cell < sum->cell_count; cell++) {
        float of_cell[LIGHT_BANDS];
        if (!sum->is_asked[cell]) continue;
        light_bands_sky(sum->sky, (float)radians_from_degrees(sum->at[cell].elevation_deg),
                        (float)radians_from_degrees(sum->at[cell].azimuth_deg - turn), of_cell);
        memcpy(&bands[cell], of_cell, sizeof bands[cell]);
        light[cell] = 0;
        for (int b = 0; b < LIGHT_BANDS; b++) light[cell] += of_cell[b];
    }
}

/* In single precision: some thousands of positive terms keep five digits. */
static void sum_probe(const SkyProbe *probe, const Spectrum *bands, const float *light,
                      size_t place) {
    const Response *response = &probe->of->response;
    Spectrum total = {0}, groups[RESPONSE_CLASSES] = {{0}};
    WhiteSamples white;
    double sum = 0;
    for (int i = 0; i < probe->count; i++) {
        int cell = probe->cells[i];
        total += probe->shares[i] * bands[cell];
        groups[cell % RESPONSE_CLASSES] += probe->groups[i] * light[cell];
    }
    for (int c = 0; c < RESPONSE_CLASSES; c++)
        for (int k = 0; k < RESPONSE_GROUPS; k++) white.of[c][k] = (double)groups[c][k];
    for (int b = 0; b < LIGHT_BANDS; b++) sum += (double)total[b];
    probe->of->sky[place] = sum;
    probe->of->sky_bright[place] =
        read_white(response, &white, sum, probe->of->sky_without + place * RESPONSE_GROUPS);
}

static void sum_sky(void *user, int item, int worker) {
    const SkySum *sum = user;
    int azimuth = (sum->first_azimuth + item) % SKY_AZIMUTHS;
    Spectrum *bands = sum->bands + (size_t)worker * (size_t)sum->cell_count;
    float *light = sum->light + (size_t)worker * (size_t)sum->cell_count;
    look_up(sum, azimuth, bands, light);
    for (int i = 0; i < sum->probe_count; i++)
        sum_probe(&sum->probes[i], bands, light, (size_t)(sum->row * SKY_AZIMUTHS + azimuth));
}

static bool sends_anything(const Response *response, int cell) {
    size_t at = (size_t)cell * LIGHT_BANDS;
    for (int b = 0; b < LIGHT_BANDS; b++)
        if (response->first[at + (size_t)b] + response->rest[at + (size_t)b] > 0) return true;
    return false;
}

/* Relative to the vehicle, for any heading. */
static SunAngles vehicle_angles(const Setup *setup, Vec3 direction) {
    SunAngles angles = setup_angles(setup, direction);
    angles.azimuth_deg -= degrees_from_radians((double)setup->scene->environment.heading);
    return angles;
}

static Spectrum *new_spectra(Arena *arena, size_t count) {
    return arena_alloc(arena, sizeof(Spectrum), _Alignof(Spectrum), count);
}

static SkyProbe sky_probe(DistantProbe *probe, bool *is_asked, Arena *scratch) {
    const Response *response = &probe->response;
    int all = response->cells.count;
    int *cells = ARENA_NEW(scratch, int, all);
    Spectrum *shares = new_spectra(scratch, (size_t)all);
    Spectrum *groups = new_spectra(scratch, (size_t)all);
    SkyProbe out = {probe, cells, shares, groups, 0};
    for (int cell = 0; cell < all; cell++) {
        size_t from = (size_t)cell * LIGHT_BANDS;
        Spectrum rest;
        if (!sends_anything(response, cell)) continue;
        memcpy(&shares[out.count], response->first + from, sizeof *shares);
        memcpy(&rest, response->rest + from, sizeof rest);
        memcpy(&groups[out.count], response->groups + 2 * (size_t)cell * RESPONSE_GROUPS,
               sizeof *groups);
        shares[out.count] += rest;
        cells[out.count++] = cell;
        is_asked[cell] = true;
    }
    return out;
}

/* ---- skies that are sampled -------------------------------------------------------------- */

/* A probe's answers to all skies of a table, in one piece: sky, sky_bright, sky_without. */
static size_t answer_bytes(const SkyTable *table) {
    return (size_t)table->count * SKY_AZIMUTHS *
           (sizeof(double) + sizeof(BrightSamples) + RESPONSE_GROUPS * sizeof(float));
}

static void place_answers(DistantProbe *probe, const SkyTable *table, Arena *arena) {
    size_t places = (size_t)table->count * SKY_AZIMUTHS;
    probe->sky = arena_alloc(arena, 1, _Alignof(double), answer_bytes(table));
    probe->sky_bright = (BrightSamples *)(probe->sky + places);
    probe->sky_without = (float *)(probe->sky_bright + places);
}

/* Until they are summed. */
static void forget_answers(DistantProbe *probe, const SkyTable *table) {
    memset(probe->sky, 0, answer_bytes(table));
    for (int i = 0; i < table->count * SKY_AZIMUTHS; i++) probe->sky[i] = (double)NAN;
}

static bool sum_skies(DistantProbe *const *probes, int count, const DistantTools *tools,
                      Arena scratch, Error *err) {
    int rows = tools->table->count, threads = tools->setup->tools.threads;
    const Response *first = &probes[0]->response; /* all have the same triangles */
    int cells = first->cells.count;
    bool *is_asked = ARENA_NEW(&scratch, bool, cells);
    SunAngles *at = ARENA_NEW(&scratch, SunAngles, cells);
    SkyProbe *list = ARENA_NEW(&scratch, SkyProbe, count);
    for (int i = 0; i < count; i++) list[i] = sky_probe(probes[i], is_asked, &scratch);
    for (int cell = 0; cell < cells; cell++)
        at[cell] = vehicle_angles(tools->setup, first->centers[cell]);
    SkySum sum = {.probes = list,
                  .probe_count = count,
                  .cell_count = cells,
                  .first_azimuth = tools->table->first_azimuth,
                  .is_asked = is_asked,
                  .at = at,
                  .bands = new_spectra(&scratch, (size_t)threads * (size_t)cells),
                  .light = ARENA_NEW(&scratch, float, (size_t)threads *(size_t)cells)};
    for (; sum.row < rows; sum.row++) {
        Arena room = scratch;
        sum.sky = sky_table_make(tools->table, sum.row, &room, err);
        if (!sum.sky) return false;
        parallel_for(threads, tools->table->azimuths, sum_sky, &sum);
    }
    return true;
}

static bool sample_table(DistantProbe *const *probes, int count, const DistantTools *tools,
                         Arena *arena, Error *err) {
    for (int i = 0; i < count; i++) {
        place_answers(probes[i], tools->table, arena);
        forget_answers(probes[i], tools->table);
    }
    return count ? sum_skies(probes, count, tools, *arena, err)
                 : sky_table_make_suns(tools->table, arena, err);
}

/* ---- probes ------------------------------------------------------------------------------ */

static Vec3 *sun_directions(const DistantTools *tools, Arena *arena) {
    double heading = degrees_from_radians((double)tools->setup->scene->environment.heading);
    Vec3 *towards = ARENA_NEW(arena, Vec3, tools->suns.count);
    for (int i = 0; i < tools->suns.count; i++) {
        SunAngles angles = tools->suns.list[i].at;
        angles.azimuth_deg += heading;
        towards[i] = setup_direction(tools->setup, angles);
    }
    return towards;
}

void distant_probe_respond(DistantProbe *probe, const DistantTools *tools, Arena *arena) {
    ResponseOptions options = {tools->setup->tools, RESPONSE_LEVEL, tools->paths, tools->precision};
    response_trace(&probe->aim, &options, arena, &probe->response);
}

static const float *sample_suns(const DistantProbe *probe, const ResponseOptions *options,
                                const ProbeSuns *suns, Arena *arena) {
    const LightParts *parts = probe->parts;
    return sun_parts_worst(parts ? &parts->aim : &probe->aim, parts, options, suns, arena);
}

/* Those that may light the first vertex, by the response; *count: how many. */
static int *suns_that_reach(const Response *response, const ProbeSuns *suns, int *count,
                            Arena *arena) {
    int *list = ARENA_NEW(arena, int, suns->count);
    *count = 0;
    for (int i = 0; i < suns->count; i++)
        if (response_reaches(response, suns->towards[i])) list[(*count)++] = i;
    return list;
}

/* Samples only suns that may light it: most of them stand behind a roof. */
static const float *sample_scattered_suns(const DistantProbe *probe, const ResponseOptions *options,
                                          const ProbeSuns *all, Arena *arena) {
    float *shares = ARENA_NEW(arena, float, (size_t)all->count *RESPONSE_BANDS);
    Arena scratch = *arena;
    ProbeSuns some = *all;
    int *list = suns_that_reach(&probe->response, all, &some.count, &scratch);
    Vec3 *towards = ARENA_NEW(&scratch, Vec3, some.count);
    for (int i = 0; i < some.count; i++) towards[i] = all->towards[list[i]];
    some.towards = towards;
    if (!some.count) return shares;
    const float *found = sample_suns(probe, options, &some, &scratch);
    for (int i = 0; i < some.count; i++)
        memcpy(shares + (size_t)list[i] * RESPONSE_BANDS, found + (size_t)i * RESPONSE_BANDS,
               RESPONSE_BANDS * sizeof(float));
    return shares;
}

void distant_probe_sample_suns(DistantProbe *probe, const DistantTools *tools, Arena *arena) {
    ResponseOptions options = {tools->setup->tools, RESPONSE_LEVEL, tools->sun_paths, 0};
    ProbeSuns suns = {.towards = sun_directions(tools, arena),
                      .count = tools->suns.count,
                      .radius = (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG)};
    probe->scattered = sample_scattered_suns(probe, &options, &suns, arena);
    suns.by_mirror = true;
    options.paths = response_mirror_paths(&probe->aim, suns.radius);
    probe->mirror = tools->has_mirror ? sample_suns(probe, &options, &suns, arena) : NULL;
}

/* Skies of hours are many: their errors are those of an even one. */
static void read_even_sky(DistantProbe *probe, Arena *arena) {
    WhiteSamples white = {{{0}}};
    probe->sky_without = ARENA_NEW(arena, float, RESPONSE_GROUPS);
    probe->sky_bright = ARENA_NEW(arena, BrightSamples, 1);
    for (int cell = 0; cell < probe->response.cells.count; cell++)
        add_white(&probe->response, cell, 1, &white);
    probe->sky_bright[0] = read_white(&probe->response, &white, 1, probe->sky_without);
}

static void sample_hours(DistantProbe *probe, const DistantTools *tools, Arena *arena) {
    probe->sky = hour_skies_read(tools->hours, &probe->response, sun_directions(tools, arena),
                                 tools->suns.count, tools->setup->tools.threads, arena);
    read_even_sky(probe, arena);
}

bool distant_probes_sample_skies(DistantProbe *const *probes, int count, const DistantTools *tools,
                                 Arena *arena, Error *err) {
    if (!tools->hours) return sample_table(probes, count, tools, arena, err);
    for (int i = 0; i < count; i++) sample_hours(probes[i], tools, arena);
    return sample_table(NULL, 0, tools, arena, err);
}

/* Between four of a table's places. */
typedef struct SkyPlaces {
    size_t at[4];
    double weight[4];
} SkyPlaces;

static SkyPlaces sky_places(const SkyTable *table, SunAngles sun) {
    double share, turns = sun.azimuth_deg / 360, places;
    int row = sky_table_row(table, sun.elevation_deg, &share), next = row + (share > 0);
    places = (turns - floor(turns)) * SKY_AZIMUTHS;
    int a = (int)places % SKY_AZIMUTHS, b = (a + 1) % SKY_AZIMUTHS;
    double along = places - floor(places);
    size_t low = (size_t)row * SKY_AZIMUTHS, high = (size_t)next * SKY_AZIMUTHS;
    return (SkyPlaces){
        {low + (size_t)a, low + (size_t)b, high + (size_t)a, high + (size_t)b},
        {(1 - share) * (1 - along), (1 - share) * along, share * (1 - along), share * along}};
}

/* The sky's light, what it would be without each group, and its samples. */
static double read_sky(const DistantProbe *probe, const DistantTools *tools, int sun,
                       double without[RESPONSE_GROUPS], BrightSamples *bright) {
    double sky = 0;
    if (tools->hours) {
        sky = probe->sky[sun];
        bright->squares += probe->sky_bright->squares * sky * sky;
        bright->fourths += probe->sky_bright->fourths * sky * sky * sky * sky;
        for (int k = 0; k < RESPONSE_GROUPS; k++) without[k] = sky * (double)probe->sky_without[k];
        return sky;
    }
    SkyPlaces places = sky_places(tools->table, tools->suns.list[sun].at);
    double light = tools->suns.list[sun].light;
    for (int k = 0; k < RESPONSE_GROUPS; k++) without[k] = 0;
    for (int i = 0; i < 4; i++) {
        const float *of_place = probe->sky_without + places.at[i] * RESPONSE_GROUPS;
        const BrightSamples *samples = &probe->sky_bright[places.at[i]];
        double weight = places.weight[i], square = light * light;
        sky += weight * light * probe->sky[places.at[i]];
        bright->squares += weight * square * samples->squares;
        bright->fourths += weight * square * square * samples->fourths;
        for (int k = 0; k < RESPONSE_GROUPS; k++)
            without[k] += weight * light * (double)of_place[k];
    }
    return sky;
}

static void sun_bands(const DistantTools *tools, int sun, float bands[LIGHT_BANDS]) {
    const HourSkies *hours = tools->hours;
    if (!hours) {
        const DistantSun *of = &tools->suns.list[sun];
        sky_table_sun(tools->table, of->at.elevation_deg, of->light, bands);
        return;
    }
    for (int b = 0; b < LIGHT_BANDS; b++)
        bands[b] = hours->of_sun[sun] < 0 ? 0 : hours->list[hours->of_sun[sun]].sun_bands[b];
}

static void read_sun(const DistantProbe *probe, const DistantTools *tools, int sun,
                     DistantReading *to, double without[RESPONSE_GROUPS], BrightSamples *bright) {
    SunAngles angles = tools->suns.list[sun].at;
    float bands[LIGHT_BANDS];
    size_t at = (size_t)sun * LIGHT_BANDS;
    angles.azimuth_deg += degrees_from_radians((double)tools->setup->scene->environment.heading);
    sun_bands(tools, sun, bands);
    to->mirror = probe->mirror ? light_bands_sum(probe->mirror + at, bands) : 0;
    to->sun_first = light_bands_sum(probe->scattered + at, bands) + to->mirror;
    to->sun_rest = response_sun(&probe->response, setup_direction(tools->setup, angles), bands,
                                without, bright);
}

DistantReading distant_probe_read(const DistantProbe *probe, const DistantTools *tools, int sun) {
    BrightSamples bright = {0};
    double without[RESPONSE_GROUPS], of_sun[RESPONSE_GROUPS] = {0};
    DistantReading reading = {.sky = read_sky(probe, tools, sun, without, &bright)};
    if (!(tools->suns.list[sun].at.elevation_deg < -SUN_MEAN_RADIUS_DEG))
        read_sun(probe, tools, sun, &reading, of_sun, &bright);
    double sum = reading.sky + reading.sun_first + reading.sun_rest;
    for (int k = 0; k < RESPONSE_GROUPS; k++) without[k] += reading.sun_first + of_sun[k];
    reading.interval = response_interval(&probe->response, sum, without);
    reading.interval.high += bright_missing(&bright, 1, 1);
    return reading;
}

/* ---- readings that are kept -------------------------------------------------------------- */

#define ROOM_FIRST 1024

SunReadings sun_readings_start(Arena *arena) {
    SunReadings readings = {.arena = arena, .room = ROOM_FIRST};
    readings.places = ARENA_NEW(arena, KeptReading, ROOM_FIRST);
    return readings;
}

/* Where the sun is, or would be. */
static KeptReading *place_of(const SunReadings *readings, DistantSun sun) {
    size_t last = (size_t)readings->room - 1;
    size_t place = (size_t)XXH3_64bits(&sun, sizeof sun) & last;
    for (;; place = (place + 1) & last) {
        KeptReading *kept = &readings->places[place];
        if (!kept->is_taken ||
            (kept->sun.at.azimuth_deg == sun.at.azimuth_deg &&
             kept->sun.at.elevation_deg == sun.at.elevation_deg && kept->sun.light == sun.light))
            return kept;
    }
}

const double *sun_readings_find(const SunReadings *readings, DistantSun sun) {
    const KeptReading *kept = place_of(readings, sun);
    return kept->is_taken ? &kept->lux : NULL;
}

static void make_room(SunReadings *readings) {
    SunReadings wider = {
        .arena = readings->arena, .count = readings->count, .room = 2 * readings->room};
    wider.places = ARENA_NEW(wider.arena, KeptReading, wider.room);
    for (int i = 0; i < readings->room; i++) {
        const KeptReading *kept = &readings->places[i];
        if (kept->is_taken) *place_of(&wider, kept->sun) = *kept;
    }
    *readings = wider;
}

void sun_readings_add(SunReadings *readings, DistantSun sun, double lux) {
    if (2 * (readings->count + 1) > readings->room) make_room(readings);
    *place_of(readings, sun) = (KeptReading){sun, lux, true};
    readings->count++;
}

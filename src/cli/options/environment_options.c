/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/environment_options.h"

#include <math.h>
#include <string.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/units.h"
#include "image/light/light_picture.h"
#include "sky/weather_light.h"
#include "text/json_text.h"

#define HDRI_BYTES_MAX ((size_t)4 << 30)
#define CIE_DIFFUSE_LX 10000.0

/* One command line's changes while they are made. */
typedef struct Change {
    const EnvironmentChange *asked;
    Environment *environment;
    Scene *scene;
    Arena *arena;
    Problems *problems;
} Change;

static void add_input(Change *change, const char *path, uint64_t hash) {
    Scene *scene = change->scene;
    int count = scene->input_count;
    const char **inputs = ARENA_NEW(change->arena, const char *, count + 1);
    uint64_t *hashes = ARENA_NEW(change->arena, uint64_t, count + 1);
    for (int i = 0; i < count; i++) {
        inputs[i] = scene->inputs[i];
        hashes[i] = scene->input_hashes[i];
    }
    inputs[count] = path;
    hashes[count] = hash;
    scene->inputs = inputs;
    scene->input_hashes = hashes;
    scene->input_count = count + 1;
}

/* ---- the sky ----------------------------------------------------------------------------- */

static bool set_constant(Change *change, const char *text, Error *err) {
    double luminance;
    if (!cli_numbers(text, 1, &luminance) || luminance < 0 || luminance > SCENE_MOST_CD_M2)
        return error_set(err, ERROR_USAGE,
                         "--environment constant:%s: required: a luminance in cd/m2, 0 to %g", text,
                         SCENE_MOST_CD_M2);
    change->environment->kind = ENVIRONMENT_CONSTANT;
    change->environment->luminance_cd_m2 = (float)luminance;
    for (int i = 0; i < 3; i++) change->environment->color[i] = 1;
    return true;
}

static bool set_hdri(Change *change, const char *path, Error *err) {
    Environment *environment = change->environment;
    FileBytes bytes;
    LightPicture picture;
    if (!file_read(path, HDRI_BYTES_MAX, change->arena, &bytes, err) ||
        !light_picture_read(bytes, path, change->arena, change->problems, &picture, err))
        return false;
    if (environment->kind != ENVIRONMENT_HDRI) environment->hdri_scale = 1;
    environment->kind = ENVIRONMENT_HDRI;
    environment->hdri_path = path;
    environment->hdri = picture.image;
    environment->hdri_unit_cd_m2 = picture.unit_cd_m2;
    add_input(change, path, XXH3_64bits(bytes.data, bytes.size));
    return true;
}

/* A model of its own kind keeps the scene's settings; any model keeps its time and place. */
static void become(Change *change, EnvironmentKind kind, DaylightKind daylight) {
    Environment *environment = change->environment;
    DaylightInput old = environment->daylight;
    bool was_model = environment->kind >= ENVIRONMENT_CIE;
    if (environment->kind != kind) {
        environment->daylight = daylight_input_default(daylight);
        if (was_model) {
            environment->daylight.has_time = old.has_time;
            environment->daylight.when = old.when;
            environment->daylight.where = old.where;
        }
    }
    environment->kind = kind;
}

/* What is measured is the sun's light, too: an illuminance that the scene gave its sun goes. */
static void become_measured(Change *change) {
    become(change, ENVIRONMENT_PEREZ, DAYLIGHT_PEREZ);
    change->environment->sun_illuminance_lx = -1;
    change->environment->daylight.sun_lux = -1;
}

static bool set_cie(Change *change, const char *text, Error *err) {
    double number[2] = {0, -1};
    bool has_lux = false;
    char *copy = arena_string(change->arena, text, strlen(text)), *colon = strchr(copy, ':');
    if (colon) *colon = ',';
    if (cli_numbers(copy, 2, number)) has_lux = number[1] >= 0;
    else if (colon || !cli_numbers(copy, 1, number)) number[0] = 0;
    if (!(number[0] >= 1 && number[0] <= 16 && floor(number[0]) == number[0]) ||
        (colon && !has_lux) || number[1] > SCENE_MOST_LX)
        return error_set(err, ERROR_USAGE,
                         "--environment cie:%s: required: cie:N or cie:N:LUX with N 1 to 15 "
                         "(16: the traditional overcast sky) and LUX up to %g",
                         text, SCENE_MOST_LX);
    bool was_cie = change->environment->kind == ENVIRONMENT_CIE;
    become(change, ENVIRONMENT_CIE, DAYLIGHT_CIE);
    change->environment->daylight.cie_type = (int)number[0];
    if (has_lux) change->environment->daylight.diffuse_lux = number[1];
    else if (!was_cie) {
        change->environment->daylight.diffuse_lux = CIE_DIFFUSE_LX;
        problems_add(change->problems, SEVERITY_WARNING, "", "",
                     "--environment cie:%s says no illuminance: the sky is scaled to %g lx on a "
                     "horizontal plane (write cie:%s:LUX)",
                     text, CIE_DIFFUSE_LX, text);
    }
    return true;
}

static bool set_perez(Change *change, const char *text, Error *err) {
    double w_m2[2];
    if (!cli_numbers(text, 2, w_m2) || w_m2[0] < 0 || !(w_m2[1] > 0) ||
        fmax(w_m2[0], w_m2[1]) > SCENE_MOST_W_M2)
        return error_set(err, ERROR_USAGE,
                         "--environment perez:%s: required: perez:DIRECT,DIFFUSE, normal and "
                         "horizontal irradiance in W/m2, up to %g",
                         text, SCENE_MOST_W_M2);
    become_measured(change);
    change->environment->daylight.direct_w_m2 = w_m2[0];
    change->environment->daylight.diffuse_w_m2 = w_m2[1];
    change->environment->daylight.has_lux = false;
    return true;
}

static bool set_sky(Change *change, const char *text, Error *err) {
    if (!strncmp(text, "constant:", 9)) return set_constant(change, text + 9, err);
    if (!strncmp(text, "hdri:", 5) && text[5]) return set_hdri(change, text + 5, err);
    if (!strncmp(text, "cie:", 4)) return set_cie(change, text + 4, err);
    if (!strncmp(text, "perez:", 6)) return set_perez(change, text + 6, err);
    if (strcmp(text, "sky:clear"))
        return error_set(err, ERROR_USAGE,
                         "--environment %s: required: sky:clear, "
                         "cie:N[:LUX], perez:DIRECT,DIFFUSE, hdri:FILE or "
                         "constant:CD_M2",
                         text);
    become(change, ENVIRONMENT_SKY, DAYLIGHT_CLEAR);
    return true;
}

/* ---- a weather file's row as the light of a sky ------------------------------------------ */

const char *weather_option_text(const Environment *environment, Arena *arena) {
    const EnvironmentWeather *weather = &environment->weather;
    const WeatherClock *clock = &weather->clock;
    if (!weather->line) return NULL;
    const char *closure = clock->rows
                              ? arena_format(arena, "closes to %.1f W/m2, %.1f as hour means",
                                             clock->closure_w_m2, clock->means_closure_w_m2)
                              : "closure not known";
    return arena_format(arena,
                        "line %d (%02d-%02d, label %02d:%02d), %.0f min %s; its instant "
                        "%+.2f h from the label by %s, %s; lux by %s",
                        weather->line, weather->month, weather->day, (int)weather->label_h,
                        (int)lround(fmod(weather->label_h, 1) * 60) % 60, fabs(weather->apart_min),
                        weather->apart_min < 0 ? "before" : "after", clock->offset_h,
                        weather_clock_source_text(clock->source), closure,
                        weather_light_rule_text(&environment->daylight, arena));
}

static json_t *number_or_null(bool is_known, double value) {
    return is_known ? json_real(value) : json_null();
}

json_t *weather_option_json(const Environment *environment) {
    const EnvironmentWeather *weather = &environment->weather;
    const WeatherClock *clock = &weather->clock;
    if (!weather->line) return json_null();
    const double *lux = weather->file_lux;
    bool known = clock->rows > 0;
    return json_pack("{s:o, s:i, s:i, s:i, s:f, s:f, s:f, s:s, s:b, s:i, s:o, s:o, s:o, s:o, "
                     "s:o, s:o}",
                     "file", json_text(weather->file), "line", weather->line, "month",
                     weather->month, "day", weather->day, "label_h", weather->label_h,
                     "instant_minus_when_min", weather->apart_min, "offset_h", clock->offset_h,
                     "offset_source", weather_clock_source_text(clock->source), "closes",
                     (int)clock->closes, "closure_rows", clock->rows, "closure_w_m2",
                     number_or_null(known, clock->closure_w_m2), "closure_hour_means_w_m2",
                     number_or_null(known, clock->means_closure_w_m2), "best_offset_h",
                     number_or_null(known, clock->best_offset_h), "best_closure_w_m2",
                     number_or_null(known, clock->best_closure_w_m2), "file_direct_normal_lx",
                     number_or_null(lux[0] >= 0, lux[0]), "file_diffuse_horizontal_lx",
                     number_or_null(lux[1] >= 0, lux[1]));
}

typedef struct WeatherArgs {
    const char *file;
    SkyTime when;
    bool has_place;         /* the user's own: the station's is not taken */
    const double *offset_h; /* --weather-offset, or NULL */
    WeatherLux lux;
} WeatherArgs;

static bool check_row(const WeatherArgs *args, const WeatherHour *hour, double apart_min,
                      Arena *arena, Error *err) {
    const SkyTime *when = &args->when;
    if (!hour)
        return error_at(err, ERROR_INPUT, args->file, "",
                        "has no hour for month %d, day %d, %02d:%02d", when->month, when->day,
                        when->hour, when->minute);
    WeatherRowState state = weather_row_state(hour, args->lux);
    const char *place = arena_format(arena, "line %d", hour->line);
    if (state == WEATHER_ROW_DARK)
        return error_at(err, ERROR_INPUT, args->file, place,
                        "month %d, day %d, hour %g (its instant is %+.0f min from --when) is "
                        "dark (0 W/m2 diffuse), required: an hour by day — for a night use "
                        "--environment sky:clear",
                        hour->month, hour->day, hour->label_h, apart_min);
    return state == WEATHER_ROW_LIT ||
           error_at(err, ERROR_INPUT, args->file, place,
                    "month %d, day %d, hour %g %s; required direct and diffuse daylight%s",
                    hour->month, hour->day, hour->label_h, weather_row_lacks(hour, state, arena),
                    state == WEATHER_ROW_WITHOUT_LUX ? ", or --weather-lux perez" : "");
}

static void warn_of_water(const WeatherArgs *args, const WeatherHour *hour, Arena *arena,
                          Problems *problems) {
    if (hour->has_dew_point || args->lux == WEATHER_LUX_FILE) return;
    problems_add(problems, SEVERITY_WARNING, args->file, arena_format(arena, "line %d", hour->line),
                 "has no dew point (99.9): %g cm of water vapour are assumed for its lux",
                 WATER_USUAL_CM);
}

/* A row may be the wrong one for what is wrong of all. */
static bool add_doubt(const WeatherDoubts *doubts, Error *err) {
    const Error before = *err;
    return doubts->count && error_at(err, before.code, before.file, before.path, "%s — %s",
                                     before.text, doubts->text[0]);
}

/* Sets the light, the place and how they were found. What of the file cannot be meant goes to
 * *problems as a warning. */
static bool apply_weather(const WeatherArgs *args, Environment *environment, Arena *arena,
                          Problems *problems, Error *err) {
    Weather weather;
    double apart_min = 0;
    if (!weather_read(args->file, arena, &weather, err)) return false;
    WeatherClock clock = weather_clock_find(&weather, args->offset_h, *arena);
    const WeatherHour *hour = weather_clock_row(&weather, &clock, &args->when, &apart_min);
    WeatherDoubts doubts = weather_clock_doubts(&weather, &clock, arena);
    if (!check_row(args, hour, apart_min, arena, err)) return add_doubt(&doubts, err);
    environment->weather =
        (EnvironmentWeather){args->file,
                             hour->line,
                             hour->month,
                             hour->day,
                             hour->label_h,
                             apart_min,
                             {hour->direct_normal_lx, hour->diffuse_horizontal_lx},
                             clock};
    weather_light_take(hour, args->lux, &environment->daylight);
    if (!args->has_place) environment->daylight.where = weather.place;
    for (int i = 0; i < doubts.count; i++)
        problems_add(problems, SEVERITY_WARNING, args->file, "", "%s", doubts.text[i]);
    warn_of_water(args, hour, arena, problems);
    const char *doubt = weather_clock_row_doubt(&weather, &clock, hour, arena);
    if (doubt)
        problems_add(problems, SEVERITY_WARNING, args->file,
                     arena_format(arena, "line %d", hour->line),
                     "%s; the direct and diffuse light are taken", doubt);
    return true;
}

/* ---- time, place, weather ---------------------------------------------------------------- */

static bool needs_model(const Change *change, const char *option, Error *err) {
    return change->environment->kind >= ENVIRONMENT_CIE ||
           error_set(err, ERROR_USAGE,
                     "%s: there is no sky that it could change — add "
                     "--environment sky:clear, or cie: or perez:",
                     option);
}

static bool set_place(Change *change, const char *text, Error *err) {
    double place[3] = {0, 0, change->environment->daylight.where.altitude_m};
    if ((!cli_numbers(text, 3, place) && !cli_numbers(text, 2, place)) || fabs(place[0]) > 90 ||
        fabs(place[1]) > 360 || place[2] < -500 || place[2] > 60000)
        return error_set(err, ERROR_USAGE,
                         "--where %s: required: LAT,LON or LAT,LON,ALT: -90 to 90 and -360 to "
                         "360 degrees, -500 to 60000 m",
                         text);
    change->environment->daylight.where = (SkyPlace){place[0], place[1], place[2]};
    return true;
}

static bool set_time_and_place(Change *change, Error *err) {
    const EnvironmentChange *asked = change->asked;
    DaylightInput *daylight = &change->environment->daylight;
    if (!asked->when && !asked->where) return true;
    if (!needs_model(change, asked->when ? "--when" : "--where", err)) return false;
    if (asked->when && !sky_time_parse(asked->when, "", &daylight->when, err)) {
        err->code = ERROR_USAGE;
        return error_prefix(err, "--when");
    }
    if (asked->where && !set_place(change, asked->where, err)) return false;
    bool knows_place = asked->where || daylight->has_time || asked->weather;
    bool knows_time = asked->when || daylight->has_time;
    if (!knows_time && !asked->sun && !change->environment->has_sun)
        return error_set(err, ERROR_USAGE, "--where: there is no time yet — add --when TIME");
    if (!knows_place)
        return error_set(err, ERROR_USAGE, "--when: there is no place yet — add --where LAT,LON");
    daylight->has_time = knows_time;
    change->environment->has_sun &= !asked->when; /* a new time moves the sun */
    return true;
}

/* What stands beside a weather file alone. */
static bool no_weather(const EnvironmentChange *asked, Error *err) {
    const char *option = asked->has_weather_offset ? "--weather-offset"
                         : asked->has_weather_lux  ? "--weather-lux"
                                                   : NULL;
    return !option || error_set(err, ERROR_USAGE,
                                "%s: there is no weather file — add "
                                "--weather FILE.epw",
                                option);
}

static bool set_weather(Change *change, Error *err) {
    DaylightInput *daylight = &change->environment->daylight;
    const char *file = change->asked->weather;
    if (!file) return no_weather(change->asked, err);
    if (change->environment->kind != ENVIRONMENT_PEREZ && change->asked->environment)
        return error_set(err, ERROR_USAGE,
                         "--weather makes a Perez sky: it excludes "
                         "--environment %s",
                         change->asked->environment);
    become_measured(change);
    if (!change->asked->when && !daylight->has_time)
        return error_set(err, ERROR_USAGE, "--weather: there is no time yet — add --when TIME");
    SkyTime when = daylight->when;
    if (change->asked->when && !sky_time_parse(change->asked->when, "", &when, err)) return false;
    WeatherArgs args = {file, when, change->asked->where != NULL,
                        change->asked->has_weather_offset ? &change->asked->weather_offset_h : NULL,
                        (WeatherLux)change->asked->weather_lux};
    if (!apply_weather(&args, change->environment, change->arena, change->problems, err))
        return false;
    FileBytes bytes;
    if (!file_read(file, HDRI_BYTES_MAX, change->arena, &bytes, err)) return false;
    add_input(change, file, XXH3_64bits(bytes.data, bytes.size));
    return true;
}

static bool set_air(Change *change, Error *err) {
    const EnvironmentChange *asked = change->asked;
    if (!asked->has_turbidity && !asked->has_visibility) return true;
    if (change->environment->kind != ENVIRONMENT_SKY)
        return error_set(err, ERROR_USAGE,
                         "--%s: there is no air to set — add "
                         "--environment sky:clear",
                         asked->has_turbidity ? "turbidity" : "visibility");
    if (asked->has_turbidity) {
        change->environment->daylight.turbidity = asked->turbidity;
        change->environment->daylight.visibility_km = 0;
    }
    if (asked->has_visibility) change->environment->daylight.visibility_km = asked->visibility_km;
    return true;
}

static bool set_moon(Change *change, Error *err) {
    if (!change->asked->no_moon) return true;
    if (change->environment->kind != ENVIRONMENT_SKY)
        return error_set(err, ERROR_USAGE,
                         "--no-moon: only a clear sky has a moon to leave "
                         "out — add --environment sky:clear");
    change->environment->daylight.no_moon = true;
    return true;
}

static bool set_ground(Change *change, Error *err) {
    static const char *const names[] = {"land", "sea", "cloud"};
    const char *text = change->asked->ground;
    DaylightInput *daylight = &change->environment->daylight;
    double top = daylight->cloud_top_m;
    if (!text) return true;
    if (change->environment->kind != ENVIRONMENT_SKY)
        return error_set(err, ERROR_USAGE,
                         "--ground: only a clear sky has a ground to choose — "
                         "add --environment sky:clear");
    bool has_top = !strncmp(text, "cloud:", 6);
    for (int i = 0; i < 3; i++) {
        if (strcmp(text, names[i]) && !(i == FLOOR_CLOUD && has_top)) continue;
        if (has_top && (!cli_numbers(text + 6, 1, &top) || top < 0 || top > 20000)) break;
        daylight->floor = (FloorKind)i;
        daylight->cloud_top_m = top;
        return true;
    }
    return error_set(err, ERROR_USAGE,
                     "--ground %s: required: land, sea, cloud or cloud:TOP "
                     "with the clouds' top 0 to 20000 m above the sea",
                     text);
}

/* ---- the sun ----------------------------------------------------------------------------- */

static bool set_sun(Change *change, const char *text, Error *err) {
    Environment *environment = change->environment;
    bool is_model = environment->kind >= ENVIRONMENT_CIE;
    double sun[3] = {0, 0, environment->has_sun ? (double)environment->sun_illuminance_lx : -1};
    if (!strcmp(text, "off")) {
        environment->has_sun = false;
        environment->daylight.sun_lux = 0;
        return true;
    }
    if (!strcmp(text, "auto")) {
        environment->has_sun = false;
        environment->daylight.sun_lux = -1;
        return environment->daylight.has_time ||
               error_set(err, ERROR_USAGE,
                         "--sun auto: there is no time and place — add --when "
                         "and --where");
    }
    bool has_lux = cli_numbers(text, 3, sun);
    if ((!has_lux && !cli_numbers(text, 2, sun)) || fabs(sun[0]) > 360 || fabs(sun[1]) > 90 ||
        (has_lux && (sun[2] < 0 || sun[2] > SCENE_MOST_LX)))
        return error_set(
            err, ERROR_USAGE,
            "--sun %s: required: auto, off, or AZ,EL,LUX with AZ -360 to 360 and EL -90 "
            "to 90 degrees and LUX 0 to %g",
            text, SCENE_MOST_LX);
    if (!has_lux && !environment->has_sun && !is_model)
        return error_set(err, ERROR_USAGE,
                         "--sun %s: the scene's sun has no illuminance to keep — write AZ,EL,LUX",
                         text);
    environment->has_sun = true;
    environment->sun_azimuth = (float)radians_from_degrees(sun[0]);
    environment->sun_elevation = (float)radians_from_degrees(sun[1]);
    environment->sun_illuminance_lx = (float)sun[2];
    if (!(environment->sun_angular_radius > 0))
        environment->sun_angular_radius = (float)radians_from_degrees(SUN_MEAN_RADIUS_DEG);
    return true;
}

static bool set_directions(Change *change, Error *err) {
    const EnvironmentChange *asked = change->asked;
    Environment *environment = change->environment;
    if (asked->has_heading) environment->heading = (float)radians_from_degrees(asked->heading_deg);
    if (vec3_length(environment->forward) == 0) environment->forward = vec3(0, 0, -1);
    if (!asked->has_forward) return true;
    Vec3 forward =
        vec3((float)asked->forward[0], (float)asked->forward[1], (float)asked->forward[2]);
    if (forward.x == 0 && forward.z == 0)
        return error_set(err, ERROR_USAGE,
                         "--forward %g,%g,%g: required: a vector that is not vertical",
                         asked->forward[0], asked->forward[1], asked->forward[2]);
    environment->forward = forward;
    return true;
}

static bool set_illuminance(Change *change, Error *err) {
    if (!change->asked->has_hdri_lux) return true;
    if (change->environment->kind != ENVIRONMENT_HDRI)
        return error_set(err, ERROR_USAGE,
                         "--hdri-lux: there is no HDRI — add --environment hdri:FILE");
    change->environment->horizontal_illuminance_lx = (float)change->asked->hdri_lux;
    return true;
}

/* A sky that is computed needs to know where the sun stands. */
static bool knows_sun(const Change *change, Error *err) {
    const Environment *environment = change->environment;
    bool any = environment->kind < ENVIRONMENT_PEREZ || environment->has_sun ||
               environment->daylight.has_time;
    return any || error_set(err, ERROR_USAGE,
                            "--environment %s: where does the sun stand? — add "
                            "--when and --where, or --sun AZ,EL",
                            change->asked->environment);
}

bool environment_change(const EnvironmentChange *asked, Scene *scene, Arena *arena,
                        Problems *problems, Error *err) {
    Change change = {asked, &scene->environment, scene, arena, problems};
    return (!asked->environment || set_sky(&change, asked->environment, err)) &&
           set_weather(&change, err) && set_time_and_place(&change, err) &&
           set_illuminance(&change, err) && set_air(&change, err) && set_moon(&change, err) &&
           set_ground(&change, err) && (!asked->sun || set_sun(&change, asked->sun, err)) &&
           knows_sun(&change, err) && set_directions(&change, err);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* Texts: spectra, weather, command lines, URIs. */
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "cli/options/environment_options.h"
#include "harness.h"
#include "sky/weather_clock.h"
#include "spectrum/curve.h"
#include "text/uri.h"
#include "text/json_text.h"

#define ARGUMENTS_MAX 32

void fuzz_curve(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Curve curve;
    const char *text = arena_string(arena, (const char *)data, size);
    if (!curve_parse(text, "curve.csv", CURVE_SHARES, &curve, NULL, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    for (int i = 0; i < CURVE_COUNT; i++) fuzz_claim(isfinite(curve.value[i]), "a curve is finite");
}

void fuzz_weather(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    Weather weather;
    const char *path = fuzz_file("weather.epw", data, size, arena);
    if (!weather_read(path, arena, &weather, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    SkyTime time = {2026, 6, 21, 8, 30, 0, 2};
    fuzz_claim(weather.count > 0, "a weather file has hours");
    for (int i = 0; i < weather.count; i++) {
        const WeatherHour *hour = &weather.hour[i];
        fuzz_claim(!hour->has_light ||
                       (hour->direct_normal_w_m2 >= 0 && hour->diffuse_horizontal_w_m2 >= 0 &&
                        isfinite(hour->direct_normal_w_m2)),
                   "light is not negative");
    }
    WeatherClock clock = weather_clock_find(&weather, NULL, *arena);
    double apart = 0;
    weather_clock_row(&weather, &clock, &time, &apart);
    fuzz_claim(isfinite(clock.offset_h) && fabs(apart) <= 31, "a row has its instant");
}

/* ---- command lines ----------------------------------------------------------------------- */

/* Lines become arguments behind a command's name; --help would print. */
static int arguments_of(char *text, char **argv) {
    int count = 0;
    argv[count++] = "fuzz";
    while (*text && count < ARGUMENTS_MAX) {
        char *end = text + strcspn(text, "\n");
        bool is_last = !*end;
        *end = 0;
        if (strcmp(text, "--help") != 0) argv[count++] = text;
        text = is_last ? end : end + 1;
    }
    return count;
}

#define WEATHER \
    "LOCATION,Munich,-,DEU,IWEC Data,108660,48.13,11.70,1.0,529.0\n" \
    "1983,6,21,9,60,?9?9,18.3,11.2,63,95200,390,1400,330,620,600,150,66000,60000,17000," \
    "2000,200,2.1,3,3,20.0,77777,9,999999999,210,0.1500,0,88,0.18,0.0,1.0\n"

/* Files that a command line names are not the fuzzer's: they are known ones. */
static void replace_files(EnvironmentChange *change, Arena *arena) {
    if (change->weather) change->weather = fuzz_file("known.epw", WEATHER, strlen(WEATHER), arena);
    if (change->environment && !strncmp(change->environment, "hdri:", 5))
        change->environment = "hdri:none.hdr";
}

void fuzz_environment(const uint8_t *data, size_t size, Arena *arena) {
    Cli cli;
    Error err = {0};
    Scene scene = {.environment = {.color = {1, 1, 1}, .forward = {0, 0, -1}}};
    Problems problems = problems_start(arena);
    EnvironmentChange change = {0};
    char *argv[ARGUMENTS_MAX + 1] = {0};
    const Option options[] = {ENVIRONMENT_OPTIONS(&change)};
    const CliCommand command = {
        "fuzz", "", "", "", options, (int)(sizeof options / sizeof *options), 0, 2};
    int argc = arguments_of(fuzz_text(data, size, arena), argv);
    if (!cli_parse(&command, argc, argv, arena, &cli, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    replace_files(&change, arena);
    if (!environment_change(&change, &scene, arena, &problems, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    const Environment *e = &scene.environment;
    fuzz_claim(isfinite(e->luminance_cd_m2) && isfinite(e->sun_illuminance_lx) &&
                   isfinite(e->heading) && isfinite(e->sun_azimuth),
               "an environment is finite");
    fuzz_claim(vec3_dot(e->forward, e->forward) > 0, "forward points somewhere");
}

/* Options of every kind. */
void fuzz_cli(const uint8_t *data, size_t size, Arena *arena) {
    Cli cli;
    Error err = {0};
    bool flag = false, given = false;
    const char *text = NULL, *name, *value;
    double number = 1, numbers[3] = {0};
    long whole = 1;
    int sides[2] = {1, 1}, choice = 0;
    CliTexts texts = {0};
    char *argv[ARGUMENTS_MAX + 1] = {0};
    const Option options[] = {
        {"--flag", OPTION_FLAG, NULL, "", &flag, .given = &given},
        {"--text", OPTION_TEXT, "T", "", &text},
        {"--number", OPTION_NUMBER, "N", "", &number, .low = -10, .high = 10},
        {"--integer", OPTION_INTEGER, "N", "", &whole, .low = 1, .high = 1000000},
        {"--numbers", OPTION_NUMBERS, "X,Y,Z", "", numbers, .low = -1, .high = 1, .count = 3},
        {"--size", OPTION_SIZE, "WxH", "", sides},
        {"--choice", OPTION_CHOICE, "red|green|blue", "", &choice},
        {"--content", OPTION_TEXTS, "M=V", "", &texts},
    };
    const CliCommand command = {"fuzz", "", "", "", options, 8, 0, 3};
    int argc = arguments_of(fuzz_text(data, size, arena), argv);
    if (!cli_parse(&command, argc, argv, arena, &cli, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    fuzz_claim(number >= -10 && number <= 10 && whole >= 1 && whole <= 1000000,
               "numbers are in range");
    for (int i = 0; i < 3; i++) fuzz_claim(fabs(numbers[i]) <= 1, "each of several as well");
    fuzz_claim(sides[0] >= 1 && sides[0] <= 65536 && sides[1] >= 1 && sides[1] <= 65536,
               "a size is in range");
    fuzz_claim(choice >= 0 && choice < 3 && cli.threads >= 1 && cli.argument_count <= 3,
               "choices, threads and arguments are in range");
    for (int i = 0; i < texts.count; i++)
        if (!cli_name_value("--content", texts.list[i], arena, &name, &value, &err))
            fuzz_claim_refusal(&err);
    for (int i = 0; i < cli.argument_count; i++) {
        SkyTime time;
        json_decref(json_text(cli.arguments[i]));
        if (!sky_time_parse(cli.arguments[i], "--when", &time, &err)) fuzz_claim_refusal(&err);
    }
}

void fuzz_uri(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    FileBytes bytes;
    const char *type;
    char *plain, *uri = fuzz_text(data, size, arena);
    if (uri_is_data(uri)) {
        if (data_uri_decode(uri, arena, &bytes, &type, &err))
            fuzz_claim(bytes.size <= size && bytes.data[bytes.size] == 0 && strlen(type) < size,
                       "a data URI holds less than its text");
        else fuzz_claim_refusal(&err);
    } else if (uri_decode(uri, arena, &plain, &err)) {
        fuzz_claim(strlen(plain) <= strlen(uri), "decoding makes a URI no longer");
        fuzz_claim(path_climb(plain) >= 0 && path_climb(plain) <= (int)strlen(plain),
                   "a path climbs no more than it has parts");
        path_beside("folder/scene.gltf", plain, arena);
    } else {
        fuzz_claim_refusal(&err);
    }
}

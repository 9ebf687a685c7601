/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/weather_light.h"

#define SUN_MOST_W_M2 1410.0
#define SUN_MOST_LX 140000.0
#define DIFFUSE_SURELY_W_M2 1.0 /* has lux in a file that has any */
#define DIRECT_SURELY_W_M2 20.0
#define RATIO_FROM_W_M2 20.0 /* below, rounding to 100 lx decides it */
#define RATIO_LEAST 50.0
#define RATIO_MOST 300.0

static bool has_lux(double lux, double w_m2, double surely) {
    return lux > 0 || (lux == 0 && w_m2 < surely);
}

static bool is_whole(const WeatherHour *hour) {
    double diffuse = hour->diffuse_horizontal_w_m2, lux = hour->diffuse_horizontal_lx;
    if (!has_lux(hour->direct_normal_lx, hour->direct_normal_w_m2, DIRECT_SURELY_W_M2) ||
        !has_lux(lux, diffuse, DIFFUSE_SURELY_W_M2))
        return false;
    return diffuse < RATIO_FROM_W_M2 ||
           (lux >= RATIO_LEAST * diffuse && lux <= RATIO_MOST * diffuse);
}

static bool is_too_bright(const WeatherHour *hour) {
    return hour->direct_normal_w_m2 > SUN_MOST_W_M2 ||
           hour->diffuse_horizontal_w_m2 > SUN_MOST_W_M2;
}

WeatherRowState weather_row_state(const WeatherHour *hour, WeatherLux lux) {
    double direct = hour->direct_normal_w_m2, diffuse = hour->diffuse_horizontal_w_m2;
    if (!hour->has_light) return WEATHER_ROW_WITHOUT_VALUES;
    if (is_too_bright(hour)) return WEATHER_ROW_TOO_BRIGHT;
    if (!(diffuse > 0)) return direct > 0 ? WEATHER_ROW_WITHOUT_SKY : WEATHER_ROW_DARK;
    if (lux == WEATHER_LUX_PEREZ) return WEATHER_ROW_LIT;
    if (hour->direct_normal_lx > SUN_MOST_LX || hour->diffuse_horizontal_lx > SUN_MOST_LX)
        return WEATHER_ROW_TOO_BRIGHT;
    return is_whole(hour) ? WEATHER_ROW_LIT : WEATHER_ROW_WITHOUT_LUX;
}

static const char *lux_text(double lux, Arena *arena) {
    return lux < 0 ? "no lx" : arena_format(arena, "%g lx", lux);
}

const char *weather_row_lacks(const WeatherHour *hour, WeatherRowState state, Arena *arena) {
    double direct = hour->direct_normal_w_m2, diffuse = hour->diffuse_horizontal_w_m2;
    double lux[2] = {hour->direct_normal_lx, hour->diffuse_horizontal_lx};
    bool is_of_watts = is_too_bright(hour);
    switch (state) {
    case WEATHER_ROW_WITHOUT_SKY:
        return arena_format(arena, "has %g W/m2 of direct light and no diffuse", direct);
    case WEATHER_ROW_WITHOUT_LUX:
        return arena_format(arena, "has %s direct and %s diffuse beside %g and %g W/m2",
                            lux_text(lux[0], arena), lux_text(lux[1], arena), direct, diffuse);
    case WEATHER_ROW_TOO_BRIGHT:
        return arena_format(arena,
                            "has %g %s of direct and %g of diffuse light, more than the "
                            "sun's own %g",
                            is_of_watts ? direct : lux[0], is_of_watts ? "W/m2" : "lx",
                            is_of_watts ? diffuse : lux[1],
                            is_of_watts ? SUN_MOST_W_M2 : SUN_MOST_LX);
    default: return "has no direct or no diffuse radiation";
    }
}

void weather_light_take(const WeatherHour *hour, WeatherLux lux, DaylightInput *out) {
    out->direct_w_m2 = hour->direct_normal_w_m2;
    out->diffuse_w_m2 = hour->diffuse_horizontal_w_m2;
    out->has_lux = lux == WEATHER_LUX_FILE;
    if (out->has_lux) {
        out->direct_lux = hour->direct_normal_lx;
        out->diffuse_lux = hour->diffuse_horizontal_lx;
    }
    out->water_source = hour->has_dew_point ? WATER_DEW_POINT : WATER_ASSUMED;
    out->water_cm =
        hour->has_dew_point ? water_from_dew_point_cm(hour->dew_point_c) : WATER_USUAL_CM;
}

/* ---- words ------------------------------------------------------------------------------- */

const char *weather_lux_text(WeatherLux lux) {
    return lux == WEATHER_LUX_FILE ? "file" : "perez 1990";
}

const char *weather_water_text(WaterSource source) {
    static const char *const texts[] = {"assumed", "given", "dew point"};
    return texts[source];
}

const char *weather_light_rule_text(const DaylightInput *input, Arena *arena) {
    if (input->has_lux) return "the file's own lux columns";
    return arena_format(arena, "Perez 1990's luminous efficacies, %.2f cm of water (%s)",
                        input->water_cm, weather_water_text(input->water_source));
}

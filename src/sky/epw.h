/* epw.h -- weather files of EnergyPlus: a place and the direct and diffuse light of every hour.
 *
 * Source    EnergyPlus, Auxiliary Programs: EPW data dictionary. Header line LOCATION, then
 * data rows of comma-separated fields, hours 1 to 24 of local standard time; a row's values are
 * those of the hour that ends there, so that the sun stands as at its middle. Memory    the
 * arena's. Threads: const once read. Fails     with file and line, what was found and what was
 * wanted. Missing values (9999) are told by has_light = false.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "sky/sun_position.h"

typedef struct WeatherHour {
    SkyTime middle; /* of the hour */
    double  direct_normal_w_m2, diffuse_horizontal_w_m2;
    double  dry_bulb_c, dew_point_c, pressure_mbar;
    double  precipitable_water_cm; /* negative: missing */
    double  aerosol_depth;         /* broadband; negative: missing */
    bool    has_light;
} WeatherHour;

typedef struct Weather {
    const char  *file, *city;
    SkyPlace     place;
    double       zone_h;
    WeatherHour *hour;
    int          count;
} Weather;

bool weather_read(const char *file, Arena *arena, Weather *out, Error *err);

/* The hour that holds a moment, whatever the row's year: by month, day and hour in the file's
 * own zone. NULL: the file has no such hour. */
const WeatherHour *weather_at(const Weather *weather, const SkyTime *time);

/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/sun_beam.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/curve.h"
#include "spectrum/photometry.h"

/* Chapman's grazing incidence function for a zenith angle up to 90 degrees, x radii of the
 * sphere a scale height: sqrt(pi x / 2) exp(y^2) erfc(y), y = sqrt(x / 2) cos z (Smith and
 * Smith 1972, their first term). */
static double grazing(double x, double cosine) {
    double y = sqrt(x / 2) * cosine;
    if (y > 8) return 1 / cosine;
    return sqrt(PI * x / 2) * exp_d(y * y) * erfc_d(y);
}

/* Water along the ray over that straight above sea level. */
static double water_column(const SunBeamPath *path) {
    double r = AIR_EARTH_M + path->observer_m, sine = sin_d(path->elevation);
    double here = exp_d(-path->observer_m / SUN_BEAM_WATER_SCALE_M);
    double up = grazing(r / SUN_BEAM_WATER_SCALE_M, fabs(sine));
    if (sine >= 0) return here * up;
    double lowest = r * cos_d(path->elevation);
    double at_lowest = exp_d(-(lowest - AIR_EARTH_M) / SUN_BEAM_WATER_SCALE_M);
    return 2 * at_lowest * grazing(lowest / SUN_BEAM_WATER_SCALE_M, 0) - here * up;
}

/* SPECTRL2 straight up through as much of everything as lies along the ray. */
SunBeam sun_beam(const Air *air, const SunBeamPath *path, double distance_au) {
    AirOptics optics = air_optics(air);
    Air along = *air;
    double column[AIR_PARTS], above[AIR_PARTS];
    Curve visible;
    air_column(&optics, path->observer_m, sin_d(path->elevation), path->floor_m - 1, column);
    air_vertical(&optics, path->observer_m, AIR_TOP_M, above);
    along.pressure_mbar *= column[AIR_MOLECULES];
    along.aerosol_depth *= column[AIR_AEROSOL];
    along.ozone_atm_cm *= column[AIR_OZONE];
    along.water_cm *= water_column(path);
    Spectrl2 beam = spectrl2(&along, 0, 1 / (distance_au * distance_au));
    for (int i = 0; i < CURVE_COUNT; i++)
        visible.value[i] = (float)spectrl2_read(beam.direct, CURVE_FIRST_NM + i);
    return (SunBeam){column[AIR_MOLECULES] / above[AIR_MOLECULES],
                     luminance_cd_m2(visible.value, CURVE_COUNT, CURVE_FIRST_NM, 1),
                     spectrl2_total(beam.direct)};
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/hdri_warning.h"

#include "base/units.h"
#include "light/sky_picture_doubt.h"

#define WAY_OUT                                                                                \
    " — give its horizontal illuminance with --hdri-lux LX (clear noon 100000, overcast "      \
    "10000, sunset 400, a lit room 500, a street at night 10), or with "                       \
    "\"horizontal_illuminance_lx\" or \"scale\" in the scene"

static void warn_of_unit_range(const Environment *environment, const HdriLook *look,
                               Problems *problems)
{
    problems_add(problems, SEVERITY_WARNING, environment->hdri_path, "",
                 "its largest value is %.4g: these seem to be values of a picture for a "
                 "display, not cd/m2; it lights a horizontal plane with %.3g lx" WAY_OUT,
                 look->largest_stored, look->illuminance_lx);
}

static void warn_of_sun(const Environment *environment, const HdriLook *look,
                        Problems *problems)
{
    problems_add(problems, SEVERITY_WARNING, environment->hdri_path, "",
                 "it shows a sun %.2g degrees high but lights a horizontal plane with %.3g lx "
                 "only: the picture seems to have no absolute scale" WAY_OUT,
                 degrees_from_radians(look->peak_elevation), look->illuminance_lx);
}

static void warn_of_sky(const Environment *environment, const HdriLook *look,
                        Problems *problems)
{
    problems_add(problems, SEVERITY_WARNING, environment->hdri_path, "",
                 "it shows a sky by day but lights a horizontal plane with %.3g lx only: the "
                 "picture seems to have no absolute scale" WAY_OUT,
                 look->illuminance_lx);
}

void hdri_warn(const Environment *environment, Problems *problems)
{
    bool is_scaled = environment->hdri_scale != 1 || environment->horizontal_illuminance_lx > 0;
    if (environment->kind != ENVIRONMENT_HDRI || is_scaled || !environment->hdri.pixels) return;
    if (environment->hdri.format != IMAGE_RGBA32F) return;
    HdriLook look = hdri_look(environment);
    switch (hdri_doubt(&look)) {
    case HDRI_PLAUSIBLE: break;
    case HDRI_UNIT_RANGE: warn_of_unit_range(environment, &look, problems); break;
    case HDRI_DIM_SUN: warn_of_sun(environment, &look, problems); break;
    case HDRI_DIM_SKY: warn_of_sky(environment, &look, problems); break;
    }
}

/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/scene_warnings.h"

#include "base/units.h"
#include "light/sky_picture_doubt.h"
#include "panel/query/panel_stated.h"
#include "scene/load/material_data.h"

#define WAY_OUT \
    " — give its horizontal illuminance with --hdri-lux LX (clear noon 100000, overcast " \
    "10000, sunset 400, a lit room 500, a street at night 10), or with " \
    "\"horizontal_illuminance_lx\" or \"scale\" in the scene"

void hdri_warn(const Environment *environment, Problems *problems) {
    bool is_scaled = environment->hdri_scale != 1 || environment->horizontal_illuminance_lx > 0;
    if (environment->kind != ENVIRONMENT_HDRI || is_scaled || !environment->hdri.pixels) return;
    if (environment->hdri.format != IMAGE_RGBA32F) return;
    HdriLook look = hdri_look(environment);
    const char *path = environment->hdri_path;
    switch (hdri_doubt(&look)) {
    case HDRI_PLAUSIBLE: break;
    case HDRI_UNIT_RANGE:
        problems_add(problems, SEVERITY_WARNING, path, "",
                     "its largest value is %.4g: these seem to be values of a picture for a "
                     "display, not cd/m2; it lights a horizontal plane with %.3g lx" WAY_OUT,
                     look.largest_stored, look.illuminance_lx);
        break;
    case HDRI_DIM_SUN:
        problems_add(problems, SEVERITY_WARNING, path, "",
                     "it shows a sun %.2g degrees high but lights a horizontal plane with %.3g "
                     "lx only: the picture seems to have no absolute scale" WAY_OUT,
                     degrees_from_radians(look.peak_elevation), look.illuminance_lx);
        break;
    case HDRI_DIM_SKY:
        problems_add(problems, SEVERITY_WARNING, path, "",
                     "it shows a sky by day but lights a horizontal plane with %.3g lx only: "
                     "the picture seems to have no absolute scale" WAY_OUT,
                     look.illuminance_lx);
        break;
    }
}

void data_warn(const Scene *scene, Severity severity, Problems *problems) {
    int count;
    Arena scratch = *problems->arena;
    const int *list = scene_without_data(scene, &count, &scratch);
    const char *names = scene_names_of(scene, list, count, &scratch);
    if (!count) return;
    Arena own = arena_reserve((size_t)1 << 16); /* problems grow where the names lie */
    names = arena_format(&own, "%s", names);
    problems_add(problems, severity, scene->input_count ? scene->inputs[0] : "", "",
                 "%d of %d materials carr%s no optical data and %s taken as perfectly white: "
                 "%.900s — give each a base colour, a texture or a measured spectrum",
                 count, scene->material_count, count == 1 ? "ies" : "y", count == 1 ? "is" : "are",
                 names);
    arena_release(&own);
}

/* Displays of one file share its panel: the first of them is named. */
static bool is_first_of_panel(const Scene *scene, int display_id) {
    for (int i = 0; i < display_id; i++)
        if (scene->displays[i].panel == scene->displays[display_id].panel) return false;
    return true;
}

void panels_warn(const Scene *scene, Severity severity, Problems *problems) {
    Arena own = arena_reserve((size_t)1 << 24); /* problems grow in theirs */
    for (int i = 0; i < scene->display_count; i++) {
        const Display *display = &scene->displays[i];
        if (!display->panel || !is_first_of_panel(scene, i)) continue;
        PanelStated stated = panel_stated(display->panel, &own);
        if (stated.is_unusable)
            problems_add(problems, severity, display->panel_path, "",
                         "the panel of display '%.100s' says of itself that it is not usable: "
                         "%.700s",
                         display->name, stated.reason ? stated.reason : "its file gives no reason");
    }
    arena_release(&own);
}

/* SPDX-License-Identifier: Apache-2.0 */
/* sky_plot.h -- a picture of a sky: the dome as a chart, the panorama, the sun's way, a scale.
 *
 * The chart is a plan: north on top, east on the right, the zenith in the middle, the rim the
 * horizontal; both views show luminance in false colours on a logarithmic scale.
 *
 * Units    cd m^-2; radians; azimuth from north over east.
 * Memory   the arena's. Threads: one picture at a time per arena. Fails: with cairo's reason.
 */
#pragma once
#include "base/error.h"
#include "plot/draw/picture.h"
#include "table/table.h"

typedef struct SkyPlotSun {
    double azimuth, elevation;
    const char *label; /* NULL: none */
} SkyPlotSun;

typedef struct SkyPlot {
    const float *luminance; /* height x width, equirectangular: zenith on top, north left */
    int width, height;
    double horizon; /* elevation, at most 0 */
    bool has_sun;
    SkyPlotSun sun;
    bool has_moon;
    SkyPlotSun moon;
    const SkyPlotSun *path; /* of the day, in order */
    int path_count;
    bool has_heading;
    double heading;
    const char *title, *subtitle;
    const TableLine *line; /* figures */
    int line_count;
} SkyPlot;

/* ending: ".svg" or ".png"; width in pixels, 0: chosen. */
bool sky_plot_draw(const SkyPlot *plot, bool is_svg, int width, Arena *arena, PlotBytes *out,
                   Error *err);

/* plot.h -- pictures of a measured panel, as display engineers draw them.
 *
 * Output   SVG or PNG from the same drawing; the same bytes for the same input and library.
 * Memory   the arena's; the picture appears under its name only when it is whole.
 * Threads  one call at a time per arena; `threads` of the options sample the panel.
 * Fails    with the file and what cannot be drawn or written.
 */
#pragma once
#include <jansson.h>

#include "panel/set/measurement.h"
#include "panel/query/panel.h"

typedef enum PlotKind {
    PLOT_ALL, PLOT_LUMINANCE, PLOT_CONTRAST, PLOT_COLOUR_SHIFT, PLOT_GREY_LEVELS, PLOT_SECTIONS,
    PLOT_CHROMATICITY, PLOT_SPECTRA, PLOT_BRDF, PLOT_BRDF_SPECTRUM, PLOT_BRDF_MAP, PLOT_MIRROR,
    PLOT_FIT, PLOT_KIND_COUNT
} PlotKind;

/* The names of the kinds in their order, as one types them: "all|luminance|...". */
#define PLOT_KINDS                                                                             \
    "all|luminance|contrast|colour-shift|grey-levels|sections|chromaticity|spectra|brdf|"      \
    "brdf-spectrum|brdf-map|mirror|fit"

const char *plot_kind_name(PlotKind kind);

typedef struct PlotOptions {
    PlotKind kind;
    int      width, height; /* of the picture, pixels (SVG: its units); 0: chosen */
    bool     is_dark;
    double   incidence_phi; /* azimuth of the light, radians; PI: from the left */
    int      threads;       /* at least 1 */
} PlotOptions;

typedef struct PlotInput {
    const Panel       *panel;
    const char        *file;     /* the panel's, as the user named it */
    const Measurement *measured; /* NULL: none */
} PlotInput;

/* By the ending of path: .svg or .png. *figures: how many it shows. */
bool plot_write(const PlotInput *input, const PlotOptions *options, const char *path,
                Arena *arena, int *figures, Error *err);

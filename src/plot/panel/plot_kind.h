/* SPDX-License-Identifier: Apache-2.0 */
/* plot_kind.h -- what can be drawn of a panel.
 *
 * Threads  constants.
 */
#pragma once

typedef enum PlotKind {
    PLOT_ALL, PLOT_LUMINANCE, PLOT_CONTRAST, PLOT_COLOUR_SHIFT, PLOT_GREY_LEVELS, PLOT_SECTIONS,
    PLOT_CHROMATICITY, PLOT_SPECTRA, PLOT_BRDF, PLOT_BRDF_SPECTRUM, PLOT_BRDF_MAP, PLOT_MIRROR,
    PLOT_FIT, PLOT_UNIFORMITY, PLOT_KIND_COUNT
} PlotKind;

/* The names of the kinds in their order, as one types them: "all|luminance|...". */
#define PLOT_KINDS                                                                             \
    "all|luminance|contrast|colour-shift|grey-levels|sections|chromaticity|spectra|brdf|"      \
    "brdf-spectrum|brdf-map|mirror|fit|uniformity"

const char *plot_kind_name(PlotKind kind);

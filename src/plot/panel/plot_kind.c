/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_kind.h"

const char *plot_kind_name(PlotKind kind)
{
    static const char *const NAMES[] = {"all", "luminance", "contrast", "colour-shift",
        "grey-levels", "sections", "chromaticity", "spectra", "brdf", "brdf-spectrum",
        "brdf-map", "mirror", "fit", "uniformity"};
    return NAMES[kind];
}

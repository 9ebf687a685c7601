/* SPDX-License-Identifier: Apache-2.0 */
#include "text/removed.h"

#include <stddef.h>
#include <string.h>

const RemovedWord removed_words[] = {
    {"render", "--tev",
     "write --live FILE.exr and open it by `tev --watch FILE.exr`, which "
     "reads it again by itself"},
    {"road", "twilight_steps",
     "write a condition an hour, and name them in 'conditions' of "
     "the road"},
    {"road", "sky_cd_m2_per_lx", "add the sky's part to 'luminance_cd_m2' of the road"},
    {"help", "--man",
     "the build makes the pages: man parhelion-COMMAND; help --json has all that "
     "they say"},
    {"help", "--completion",
     "an installation has it for bash; help --json lists options and "
     "their values"},
    {"review", "glare", "measure --glare of a fisheye frame of the eye has UGR, DGP and DGI"},
    {"condition", "route",
     "write its points as conditions with 'when', 'where' and "
     "'heading_deg'; `parhelion help glare-review` has a script for GPX"},
    {"condition", "when", "state it in 'environment'"},
    {"condition", "weather", "state it in 'sweep' of a year"},
    {"condition", "weather_lux", "state it in 'sweep' of a year"},
    {"review", "--decide", "lower \"contrast\" and raise \"paths\" of the request's \"precision\""},
    {"review", "--decide-times", "raise \"paths\" of the request's \"precision\""},
    {"review", "--watch", "run the same command again: responses of its sweeps are kept"},
    {"parhelion", "part", "`render --part K/N` makes part K of N, and `merge` the frame"},
    {"parhelion", "status", "`merge` names the parts that are missing, `squeue` the tasks"},
    {"render", "--slurm",
     "let each task of an array `render --part K/N`, then `merge`: "
     "assets/slurm/render.sbatch"},
    {"render", "--split", "--part K/N deals samples, --crop X0,Y0,X1,Y1 takes a rectangle"},
    {"render", "--job", "name each part by -o, and `merge` the files"},
    {"render", "--submit", "hand assets/slurm/render.sbatch to sbatch"},
    {"review", "--slurm",
     "give each task conditions of its own (--only CONDITION) and `merge` "
     "the reviews"},
    {"review", "--job", "name each review by -o DIR, and `merge` them"},
    {"review", "--submit", "hand a script to sbatch: assets/slurm"},
    {"parhelion", "probe", "explain SCENE --pixel X,Y gives the same"},
    {"explain", "-o",
     "--json has the rays as lists of points; a review's page draws them over "
     "the frame"},
    {"explain", "--gltf", "--json has the rays as lists of points"},
    {"explain", "--outlook",
     "render --projection fisheye --eye X,Y,Z --look-at X,Y,Z shows what "
     "is seen from there"},
    {"review", "--mend",
     "find the value by bisection over reviews: the script in parhelion help "
     "glare-review, What would mend it?"},
    {"panel fit", "--lobe-is-mirror", "state the peak's width by --instrument-fwhm DEG"},
    {"panel fit", "--wavelet", "spectra are always a few principal ones"},
    {"panel fit", "--frame", "the fit chooses it by the peak's width"},
    {"panel fit", "--incidence", "between incidences it is always cubic"},
    {"review", "sensitivity",
     "name the values as variants, which a script can write: parhelion "
     "help glare-review, What would mend it?"},
    {"render", "--display-state", "name the state's panel file by --panel MATERIAL=FILE.panel"},
    {"explain", "--display-state", "name the state's panel file by --panel MATERIAL=FILE.panel"},
    {"measure", "--display-state", "name the state's panel file by --panel MATERIAL=FILE.panel"},
    {"PARHELION_display", "state", "name the panel file of the state as 'panel'"},
    {"variant", "states", "name the panel file of the state in 'panels'"},
    {"panel", "join",
     "keep a panel file of each state, and choose one by --panel "
     "MATERIAL=FILE.panel"},
    {"panel", "export",
     "panel eval --grid T0:T1:DT,P0:P1:DP --csv writes a table of any code or incidence"},
    {"panel", "wavelets",
     "panel fit --basis haar makes a panel, panel info --levels says how far "
     "each level is off"},
    {"panel import", "--state", "import the files of each state as a set of its own"},
    {"import_declaration", "states", "import the files of each state as a set of its own"},
    {"measurement_set", "states", "write a manifest of each state, and fit a panel of each"},
    {"--kind", "states", "plot the panel file of each state"},
    {"--kind", "grey-inversion", "panel report has a table of it"},
    {"--kind", "spectra", "the set has them in its table of primaries"},
    {"--kind", "brdf-spectrum", "panel eval --brdf has a row for each wavelength"},
    {"--kind", "brdf-map",
     "--kind brdf draws the plane of incidence, panel eval --brdf --grid has any other direction"},
    {"--kind", "mirror", "--kind reflectance has the mirror part"},
    {"--kind", "halo", "panel info has the halo of a white square"},
    {"panel plot", "--contour", "panel report has the angles at which limits are crossed"},
    {"panel plot", "--ambient", "panel report --ambient LUX has the contrast in that light"},
    {"panel plot", "--directed", "panel report --directed LUX has the contrast in that light"},
    {"panel plot", "--size", "an SVG has any size"},
    {"panel plot", "--dark", "figures are drawn for paper"},
    {"panel report", "--contour", "the page has the angles at which limits are crossed"},
    {"panel report", "--dark", "the page is light or dark as its reader has it"},
    {"sky", "--dark", "figures are drawn for paper"},
    {"PARHELION_display", "subpixels", "leave it out: a display's light is even over a pixel"},
    {"measurement_set", "subpixels", "leave it out: a display's light is even over a pixel"},
    {"spot", "position_mm", "divide it by size_mm: 'position' has the shares"},
    {"recipe", "subpixels", "leave it out: a display's light is even over a pixel"},
    {"--layer", "display.weber", "display.contrast less one"},
    {"--layer", "display.michelson", "by display.contrast C: (C - 1) / (C + 1)"},
    {"--layer", "display.luminance_error", "display.reflected over display.emitted"},
    {"--layer", "display.colour_error",
     "a review judges whether symbols can be read; in "
     "numbers display.emitted beside display.reflected"},
    {"--format", "ssdd", "export it as text, which is read (help measuring-a-panel)"},
    {"--format", "window", "export it as text, which is read (help measuring-a-panel)"},
    {"--format", "pbsdf", "export it as text, which is read (help measuring-a-panel)"},
    {"--format", "lighttools", "export it as text, which is read (help measuring-a-panel)"},
    {"--format", "fred", "export it as text, which is read (help measuring-a-panel)"},
    {"--format", "mountain", "export it as text, which is read (help measuring-a-panel)"},
    {NULL, NULL, NULL},
};

const char *removed_instead(const char *where, const char *word) {
    for (const RemovedWord *row = removed_words; row->word; row++)
        if (!strcmp(row->where, where) && !strcmp(row->word, word)) return row->instead;
    return NULL;
}

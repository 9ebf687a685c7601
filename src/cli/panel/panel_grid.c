/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/answer.h"
#include "cli/panel/panel_grid.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/options/cli.h"

#define POINTS_MAX 20000000

static int range_count(const PanelRange *range)
{
    return 1 + (int)floor((range->last - range->first) / range->step + 1e-9);
}

static double range_at(const PanelRange *range, int i)
{
    return range->first + i * range->step;
}

/* ---- the option ------------------------------------------------------------------------ */

static bool parse_range(const char **text, PanelRange *out)
{
    double *const to[3] = {&out->first, &out->last, &out->step};
    for (int i = 0; i < 3; i++) {
        char *after;
        *to[i] = strtod(*text, &after);
        if (after == *text || !isfinite(*to[i])) return false;
        *text = after;
        if (i < 2 && *(*text)++ != ':') return false;
    }
    return out->step > 0 && out->last >= out->first && out->last - out->first <= 720 &&
           (out->last - out->first) / out->step < POINTS_MAX;
}

bool panel_grid_parse(const char *text, PanelGrid *out, Error *err)
{
    const char *at = text;
    bool ok = parse_range(&at, &out->theta) && *at++ == ',' && parse_range(&at, &out->phi) &&
              !*at && out->theta.first >= 0 && out->theta.last <= 90 &&
              out->phi.first >= -360 && out->phi.last <= 360;
    if (ok && (double)range_count(&out->theta) * range_count(&out->phi) > POINTS_MAX)
        return error_set(err, ERROR_USAGE, "--grid %s has more than %d directions", text,
                         POINTS_MAX);
    return ok || error_set(err, ERROR_USAGE,
                           "--grid is '%s', wanted THETA0:THETA1:STEP,PHI0:PHI1:STEP in "
                           "degrees, theta within 0 to 90, steps above 0", text);
}

/* ---- CSV ------------------------------------------------------------------------------- */

/* Describes the numbers below it. */
static void print_comment(const PanelQuestion *q)
{
    if (q->is_brdf)
        printf("# reflection in sr^-1, the cosine not included, mirror part left out; light "
               "at theta %g, phi %g; angles in degrees, columns in nm\n", q->incidence,
               q->incidence_phi);
    else
        printf("# emission at codes %g,%g,%g: CIE 1931 XYZ, Y in cd/m2; angles in degrees\n",
               q->rgb[0], q->rgb[1], q->rgb[2]);
}

static void print_list_names(const Panel *panel, const PanelQuestion *q)
{
    PanelReflected r;
    print_comment(q);
    if (!q->is_brdf) {
        printf("theta,phi,X,Y,Z\n");
        return;
    }
    panel_ask_reflection(panel, q, &r);
    printf("theta,phi");
    for (int i = 0; i < r.count; i++) printf(",%.9g", (double)r.nm[i]);
    printf("\n");
}

static void print_list_row(const Panel *panel, const PanelQuestion *q)
{
    printf("%.10g,%.10g", q->theta, q->phi);
    if (q->is_brdf) {
        PanelReflected r;
        panel_ask_reflection(panel, q, &r);
        for (int i = 0; i < r.count; i++) printf(",%.9g", (double)r.brdf[i]);
    } else {
        float xyz[3];
        panel_ask_emission(panel, q, xyz);
        for (int j = 0; j < 3; j++) printf(",%.9g", (double)xyz[j]);
    }
    printf("\n");
}

static void print_list(const Panel *panel, const PanelQuestion *question, const PanelGrid *grid)
{
    PanelQuestion q = *question;
    print_list_names(panel, &q);
    for (int t = 0; t < range_count(&grid->theta); t++)
        for (int p = 0; p < range_count(&grid->phi); p++) {
            q.theta = range_at(&grid->theta, t);
            q.phi = range_at(&grid->phi, p);
            print_list_row(panel, &q);
        }
}

typedef enum Quantity {
    QUANTITY_X, QUANTITY_Y, QUANTITY_Z, QUANTITY_U, QUANTITY_V, QUANTITY_BRDF
} Quantity;

static double quantity_at(const Panel *panel, const PanelQuestion *q, Quantity quantity)
{
    PanelReflected r;
    float xyz[3];
    if (q->is_brdf) {
        panel_ask_reflection(panel, q, &r);
        return (double)r.brdf[0];
    }
    panel_ask_emission(panel, q, xyz);
    double d = (double)xyz[0] + 15 * (double)xyz[1] + 3 * (double)xyz[2];
    switch (quantity) {
    case QUANTITY_U: return d > 0 ? 4 * (double)xyz[0] / d : 0;
    case QUANTITY_V: return d > 0 ? 9 * (double)xyz[1] / d : 0;
    case QUANTITY_X: return (double)xyz[0];
    case QUANTITY_Z: return (double)xyz[2];
    default: return (double)xyz[1];
    }
}

static void print_matrix(const Panel *panel, const PanelQuestion *question,
                         const PanelGrid *grid, Quantity quantity)
{
    static const char *const names[] = {"X, cd/m2 as Y", "Y, cd/m2", "Z, cd/m2 as Y",
                                        "u' (CIE 1976)", "v' (CIE 1976)", "BRDF, sr^-1"};
    PanelQuestion q = *question;
    print_comment(&q);
    printf("# %s", names[q.is_brdf ? QUANTITY_BRDF : quantity]);
    if (q.is_brdf) printf(" at %g nm", q.wavelength_nm);
    printf("; theta down, phi across\ntheta\\phi");
    for (int p = 0; p < range_count(&grid->phi); p++)
        printf(",%.10g", range_at(&grid->phi, p));
    for (int t = 0; t < range_count(&grid->theta); t++) {
        q.theta = range_at(&grid->theta, t);
        printf("\n%.10g", q.theta);
        for (int p = 0; p < range_count(&grid->phi); p++) {
            q.phi = range_at(&grid->phi, p);
            printf(",%.9g", quantity_at(panel, &q, quantity));
        }
    }
    printf("\n");
}

/* ---- JSON ------------------------------------------------------------------------------ */

static json_t *range_json(const PanelRange *range)
{
    json_t *list = json_array();
    for (int i = 0; i < range_count(range); i++)
        json_array_append_new(list, json_real(range_at(range, i)));
    return list;
}

/* Channels of one direction; returns whether it is measured. */
static bool channels_at(const Panel *panel, const PanelQuestion *q, float *out)
{
    PanelReflected r;
    if (!q->is_brdf) return panel_ask_emission(panel, q, out);
    panel_ask_reflection(panel, q, &r);
    memcpy(out, r.brdf, sizeof *out * (size_t)r.count);
    return r.is_measured;
}

/* Fills one theta x phi table a channel, and which thetas are extrapolated. */
static void fill_tables(const Panel *panel, const PanelQuestion *question,
                        const PanelGrid *grid, int channels, json_t **table, json_t *far)
{
    PanelQuestion q = *question;
    float         value[PANEL_INFO_WAVELENGTHS_MAX];
    for (int t = 0; t < range_count(&grid->theta); t++) {
        bool is_measured = true;
        q.theta = range_at(&grid->theta, t);
        for (int c = 0; c < channels; c++) json_array_append_new(table[c], json_array());
        for (int p = 0; p < range_count(&grid->phi); p++) {
            q.phi = range_at(&grid->phi, p);
            is_measured = channels_at(panel, &q, value);
            for (int c = 0; c < channels; c++)
                json_array_append_new(json_array_get(table[c], (size_t)t),
                                      json_real((double)value[c]));
        }
        json_array_append_new(far, json_boolean(!is_measured));
    }
}

static json_t *reflection_grid_json(const Panel *panel, const PanelQuestion *q,
                                    const PanelGrid *grid)
{
    json_t *table[PANEL_INFO_WAVELENGTHS_MAX], *far = json_array(), *nm = json_array();
    json_t *brdf = json_array(), *mirror = json_array();
    PanelReflected r;
    panel_ask_reflection(panel, q, &r);
    for (int i = 0; i < r.count; i++) {
        table[i] = json_array();
        json_array_append_new(brdf, table[i]);
        json_array_append_new(nm, json_real((double)r.nm[i]));
        json_array_append_new(mirror, json_real((double)r.mirror[i]));
    }
    fill_tables(panel, q, grid, r.count, table, far);
    return json_pack("{s:f, s:f, s:o, s:o, s:o, s:o, s:o, s:o}", "incidence_deg", q->incidence,
                     "incidence_phi_deg", q->incidence_phi, "theta_deg",
                     range_json(&grid->theta), "phi_deg", range_json(&grid->phi),
                     "wavelengths_nm", nm, "brdf_sr", brdf, "mirror", mirror, "extrapolated",
                     far);
}

static json_t *emission_grid_json(const Panel *panel, const PanelQuestion *q,
                                  const PanelGrid *grid)
{
    json_t *table[3] = {json_array(), json_array(), json_array()}, *far = json_array();
    fill_tables(panel, q, grid, 3, table, far);
    return json_pack("{s:[f,f,f], s:o, s:o, s:o, s:o, s:o, s:o}", "rgb", q->rgb[0], q->rgb[1],
                     q->rgb[2], "theta_deg", range_json(&grid->theta), "phi_deg",
                     range_json(&grid->phi), "X", table[0], "Y", table[1], "Z", table[2],
                     "extrapolated", far);
}

bool panel_grid_print(const Panel *panel, const PanelQuestion *q, const PanelGrid *grid,
                      PanelGridFormat format, int quantity, Error *err)
{
    if (format == PANEL_GRID_JSON)
        return cli_print_json(q->is_brdf ? reflection_grid_json(panel, q, grid)
                                         : emission_grid_json(panel, q, grid), err);
    if (format == PANEL_GRID_MATRIX)
        print_matrix(panel, q, grid, (Quantity)quantity);
    else
        print_list(panel, q, grid);
    if (fflush(stdout) || ferror(stdout))
        return error_set(err, ERROR_OUTPUT, "stdout cannot be written: %s", strerror(errno));
    return true;
}

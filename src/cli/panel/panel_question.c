/* SPDX-License-Identifier: Apache-2.0 */
#include "base/count.h"
#include "print/print.h"
#include "cli/panel/panel_question.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"

static Vec3 panel_direction(double theta_deg, double phi_deg) {
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg);
    return vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
}

double *panel_question_member(PanelQuestion *q, const char *name) {
    struct {
        const char *name;
        double *to;
    } members[] = {{"theta", &q->theta},
                   {"phi", &q->phi},
                   {"r", &q->rgb[0]},
                   {"g", &q->rgb[1]},
                   {"b", &q->rgb[2]},
                   {"incidence", &q->incidence},
                   {"incidence_phi", &q->incidence_phi},
                   {"wavelength", &q->wavelength_nm},
                   {"u", &q->at[0]},
                   {"v", &q->at[1]}};
    for (int i = 0; i < COUNT_OF(members); i++)
        if (!strcmp(members[i].name, name)) return members[i].to;
    return NULL;
}

static bool is_among(const char *name, const char *const *list) {
    while (*list && strcmp(*list, name)) list++;
    return *list != NULL;
}

bool panel_question_is_of_brdf(const char *name) {
    static const char *const names[] = {"incidence", "incidence_phi", "wavelength", NULL};
    return is_among(name, names);
}

bool panel_question_is_of_emission(const char *name) {
    static const char *const names[] = {"r", "g", "b", NULL};
    return is_among(name, names);
}

static bool is_anywhere(const PanelQuestion *q) {
    return isnan(q->at[0]) && isnan(q->at[1]);
}

bool panel_question_check(const PanelQuestion *q, Error *err) {
    if (q->is_brdf && !(q->incidence >= 0 && q->incidence <= 90))
        return error_set(err, ERROR_USAGE, "incidence is %g, required: 0 to 90 degrees",
                         q->incidence);
    if (!(q->theta >= 0 && q->theta <= 90))
        return error_set(err, ERROR_USAGE, "theta is %g, required: 0 to 90 degrees", q->theta);
    for (int i = 0; i < 3; i++)
        if (!(q->rgb[i] >= 0 && q->rgb[i] <= 255))
            return error_set(err, ERROR_USAGE, "a code is %g, required: 0 to 255", q->rgb[i]);
    if (is_anywhere(q)) return true;
    for (int k = 0; k < 2; k++)
        if (!(q->at[k] >= 0 && q->at[k] <= 1))
            return error_set(err, ERROR_USAGE, "%s is %g, required: 0 to 1, with the other one",
                             k ? "v" : "u", q->at[k]);
    return true;
}

bool panel_query_emission(const Panel *panel, const PanelQuestion *q, float xyz[3]) {
    float rgb[3] = {(float)q->rgb[0], (float)q->rgb[1], (float)q->rgb[2]};
    float at[2] = {(float)q->at[0], (float)q->at[1]};
    Vec3 direction = panel_direction(q->theta, q->phi);
    return is_anywhere(q) ? panel_emission_xyz(panel, direction, rgb, xyz)
                          : panel_place_emission_xyz(panel, at, direction, rgb, xyz);
}

/* At the place that is requested. */
static PanelMix panel_asked(const Panel *panel, const PanelQuestion *q) {
    float at[2] = {(float)q->at[0], (float)q->at[1]};
    if (!is_anywhere(q)) return panel_place_reflection(panel, at);
    return (PanelMix){.count = 1, .panel = {panel}, .weight = {1}};
}

void panel_query_reflection(const Panel *panel, const PanelQuestion *q, PanelReflected *out) {
    Vec3 wo = panel_direction(q->theta, q->phi);
    Vec3 wi = panel_direction(q->incidence, q->incidence_phi);
    PanelMix mix = panel_asked(panel, q);
    out->count = panel_info_wavelengths(panel, out->nm);
    if (q->wavelength_nm > 0) {
        out->nm[0] = (float)q->wavelength_nm;
        out->count = 1;
    }
    for (int first = 0; first < out->count; first += SPECTRUM_LANES) {
        Wavelengths wavelengths = {0};
        int last = out->count - 1;
        for (int i = 0; i < SPECTRUM_LANES; i++)
            wavelengths.nm[i] = out->nm[first + i < last ? first + i : last];
        Spectrum f = panel_mix_brdf(&mix, wo, wi, &wavelengths);
        Spectrum l = panel_mix_lambertian(&mix, f, wi, &wavelengths);
        Spectrum r = panel_mix_mirror(&mix, wi.z, &wavelengths);
        for (int i = 0; i < SPECTRUM_LANES && first + i <= last; i++) {
            out->brdf[first + i] = f[i];
            out->lambertian[first + i] = l[i];
            out->mirror[first + i] = r[i];
        }
    }
    out->is_measured = true;
    for (int i = 0; i < mix.count; i++)
        out->is_measured &= panel_brdf_is_measured(mix.panel[i], wo, wi);
}

/* ---- JSON ------------------------------------------------------------------------------ */

static json_t *emission_json(const Panel *panel, const PanelQuestion *q) {
    float xyz[3];
    bool measured = panel_query_emission(panel, q, xyz);
    double x = (double)xyz[0], y = (double)xyz[1], z = (double)xyz[2], d = x + 15 * y + 3 * z;
    return json_pack("{s:f, s:f, s:[f,f,f], s:[f,f,f], s:f, s:[f,f], s:b}", "theta_deg", q->theta,
                     "phi_deg", q->phi, "rgb", q->rgb[0], q->rgb[1], q->rgb[2], "XYZ", x, y, z,
                     "luminance_cd_m2", y, "uv", d > 0 ? 4 * x / d : 0, d > 0 ? 9 * y / d : 0,
                     "extrapolated", (int)!measured);
}

static json_t *reflection_json(const Panel *panel, const PanelQuestion *q) {
    json_t *nm = json_array(), *brdf = json_array(), *mirror = json_array();
    json_t *lambertian = json_array();
    PanelReflected r;
    panel_query_reflection(panel, q, &r);
    for (int i = 0; i < r.count; i++) {
        json_array_append_new(nm, json_real((double)r.nm[i]));
        json_array_append_new(brdf, json_real((double)r.brdf[i]));
        json_array_append_new(lambertian, json_real((double)r.lambertian[i]));
        json_array_append_new(mirror, json_real((double)r.mirror[i]));
    }
    return json_pack("{s:f, s:f, s:f, s:f, s:o, s:o, s:o, s:o, s:b}", "incidence_deg", q->incidence,
                     "incidence_phi_deg", q->incidence_phi, "theta_deg", q->theta, "phi_deg",
                     q->phi, "wavelengths_nm", nm, "brdf_sr", brdf, "lambertian_sr", lambertian,
                     "mirror", mirror, "extrapolated", (int)!r.is_measured);
}

json_t *panel_answer_json(const Panel *panel, const PanelQuestion *q) {
    json_t *out = q->is_brdf ? reflection_json(panel, q) : emission_json(panel, q);
    if (!is_anywhere(q))
        json_object_set_new(out, "position", json_pack("[f, f]", q->at[0], q->at[1]));
    return out;
}

/* ---- CSV ------------------------------------------------------------------------------- */

void panel_answer_csv_header(const PanelQuestion *q, FILE *out) {
    print_to(out, q->is_brdf ? "theta,phi,incidence,incidence_phi,wavelength,brdf,mirror,"
                               "measured\n"
                             : "theta,phi,r,g,b,X,Y,Z,measured\n");
}

static void csv_reflection(const Panel *panel, const PanelQuestion *q, FILE *out) {
    PanelReflected r;
    panel_query_reflection(panel, q, &r);
    for (int i = 0; i < r.count; i++)
        print_to(out, "%.10g,%.10g,%.10g,%.10g,%.9g,%.9g,%.9g,%d\n", q->theta, q->phi, q->incidence,
                 q->incidence_phi, (double)r.nm[i], (double)r.brdf[i], (double)r.mirror[i],
                 (int)r.is_measured);
}

void panel_answer_csv(const Panel *panel, const PanelQuestion *q, FILE *out) {
    float xyz[3];
    if (q->is_brdf) {
        csv_reflection(panel, q, out);
        return;
    }
    bool measured = panel_query_emission(panel, q, xyz);
    print_to(out, "%.10g,%.10g,%g,%g,%g,%.9g,%.9g,%.9g,%d\n", q->theta, q->phi, q->rgb[0],
             q->rgb[1], q->rgb[2], (double)xyz[0], (double)xyz[1], (double)xyz[2], (int)measured);
}

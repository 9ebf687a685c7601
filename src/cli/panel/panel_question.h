/* SPDX-License-Identifier: Apache-2.0 */
/* panel_question.h -- one question to a panel, and its answer as JSON or a row of CSV.
 *
 * Units    degrees; codes 0 to 255; XYZ with Y in cd m^-2; BRDF in sr^-1 without the cosine;
 *          mirror reflectance without unit; nm.
 * Fails    with the member's name, what was found and what was required.
 */
#pragma once
#include <jansson.h>
#include <stdio.h>

#include "base/error.h"
#include "base/vec.h"
#include "panel/query/panel_info.h"

typedef struct PanelQuestion {
    double theta, phi, rgb[3];
    double incidence, incidence_phi;
    bool is_brdf;
    double wavelength_nm; /* 0: all measured ones */
    double at[2];         /* place (panel_place.h); NaN: the file's own panel, wherever */
} PanelQuestion;

/* A reflection's answer. */
typedef struct PanelReflected {
    int count;
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    float brdf[PANEL_INFO_WAVELENGTHS_MAX], mirror[PANEL_INFO_WAVELENGTHS_MAX];
    float lambertian[PANEL_INFO_WAVELENGTHS_MAX]; /* of brdf */
    bool is_measured;
} PanelReflected;

/* Members that one kind of question takes. */
bool panel_question_is_of_brdf(const char *name);
bool panel_question_is_of_emission(const char *name);

/* The member that an option or a column of that name fills; NULL: there is none. */
double *panel_question_member(PanelQuestion *question, const char *name);

bool panel_question_check(const PanelQuestion *question, Error *err);

/* True where the value is measured. */
bool panel_query_emission(const Panel *panel, const PanelQuestion *question, float xyz[3]);
void panel_query_reflection(const Panel *panel, const PanelQuestion *question, PanelReflected *out);

/* A new document (cli.md: panel eval --json). */
json_t *panel_answer_json(const Panel *panel, const PanelQuestion *question);

/* A header line, and then rows, of the question and its answer: one of an emission, one for
 * each wavelength of a reflection. */
void panel_answer_csv_header(const PanelQuestion *question, FILE *out);
void panel_answer_csv(const Panel *panel, const PanelQuestion *question, FILE *out);

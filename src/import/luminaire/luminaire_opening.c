/* SPDX-License-Identifier: Apache-2.0 */
#include "import/luminaire/luminaire_opening.h"

#include <math.h>

enum { X, Y, Z };

static LuminousOpening opening(OpeningShape shape, int axis, double x, double y, double z) {
    LuminousOpening out = {
        .shape = shape, .axis = axis, .half = {(float)(x / 2), (float)(y / 2), (float)(z / 2)}};
    for (int i = X; i <= Z; i++) {
        if (out.half[i] != 0) continue;
        out.is_flat = true;
        if (shape == OPENING_BOX) out.axis = i;
    }
    if (x == 0 && y == 0 && z == 0) out.shape = OPENING_POINT;
    return out;
}

/* LM-63-1995: round by one negative size, the other one 0. */
static bool round_by_one(int year, const double size[3], LuminousOpening *out) {
    double w = size[0], l = size[1], h = size[2], dw = fabs(w), dh = fabs(h);
    if (w < 0 && l == 0 && h >= 0) *out = opening(OPENING_CYLINDER, Z, dw, dw, h);
    else if (w < 0 && l == 0 && year >= 2002) *out = opening(OPENING_CYLINDER, X, 0, dw, dh);
    else if (w < 0 && l == 0) *out = opening(OPENING_ELLIPSOID, Z, dw, dw, dh);
    else if (w == 0 && l > 0 && h < 0) *out = opening(OPENING_CYLINDER, X, l, dh, dh);
    else if (w > 0 && l == 0 && h < 0) *out = opening(OPENING_CYLINDER, Y, dh, w, dh);
    else return false;
    return true;
}

static bool by_signs(int year, const double size[3], LuminousOpening *out) {
    double w = size[0], l = size[1], h = size[2], dw = fabs(w), dl = fabs(l), dh = fabs(h);
    bool is_across = w != 0 && l != 0 && (w < 0 || l < 0);
    if (w >= 0 && l >= 0 && h >= 0) *out = opening(OPENING_BOX, Z, l, w, h);
    else if (!is_across) return round_by_one(year, size, out);
    else if (h >= 0) *out = opening(OPENING_CYLINDER, Z, dl, dw, h);
    else if ((w < 0 && l < 0) || year < 2002) *out = opening(OPENING_ELLIPSOID, Z, dl, dw, dh);
    else *out = opening(OPENING_CYLINDER, w < 0 ? X : Y, dl, dw, dh);
    return true;
}

/* From LM-63's axes, X the photometric horizontal and Z up, to those of the web in type A. */
static void tip(LuminousOpening *o) {
    float x = o->half[X];
    o->half[X] = o->half[Z];
    o->half[Z] = x;
    o->axis = Z - o->axis;
}

const char *opening_of_ies(int year, WebType type, const double size_m[3], LuminousOpening *out) {
    *out = (LuminousOpening){.shape = OPENING_POINT};
    if (!by_signs(year, size_m, out)) return "LM-63 has no such shape";
    if (type != WEB_A || out->shape == OPENING_POINT) return NULL;
    tip(out);
    if (!out->is_flat || out->axis == Z) return NULL;
    *out = (LuminousOpening){.shape = OPENING_POINT};
    return "in type A it would be seen from its edge";
}

LuminousOpening opening_of_eulumdat(double length_m, double width_m, double height_m) {
    if (width_m > 0) return opening(OPENING_BOX, Z, width_m, length_m, height_m);
    return opening(length_m > 0 ? OPENING_CYLINDER : OPENING_BOX, Z, length_m, length_m,
                   length_m > 0 ? height_m : 0);
}

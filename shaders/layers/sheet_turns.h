/* SPDX-License-Identifier: Apache-2.0 */
/* sheet_turns.h -- a thin sheet between two like layers that throw its light back at it.
 *
 * Light that leaves the sheet on either side meets a layer, which holds back the share `held`
 * of it; so it meets the sheet again, and so on. With M = [front through; through rear] what
 * the sheet does to light from its two sides, all of these turns are M + held M M + held^2 M M
 * M + ... = M (1 - held M)^-1. Shares of light, per lane; those of one side are at most 1
 * together. No phases: the light of unlike turns does not interfere.
 */
#pragma once
#include "spectrum/spectrum.h"

/* A sheet's reflectance on the side of the eye and on the other one, and what passes. */
typedef struct SheetFaces {
    Spectrum front, rear, through;
} SheetFaces;

/* Shares of the light that came on the eye's side: sent back there, and to the other side. */
typedef struct SheetLight {
    Spectrum back, through;
} SheetLight;

/* held in [0, 1). What leaves the sheet for good is (1 - held) of this. */
static inline SheetLight sheet_turns(const SheetFaces *sheet, float held)
{
    Spectrum one = spectrum_all(1), h = spectrum_all(held), through = h * sheet->through;
    Spectrum rest = (one - h * sheet->front) * (one - h * sheet->rear) - through * through;
    Spectrum determinant = sheet->front * sheet->rear - sheet->through * sheet->through;
    rest = spectrum_max(rest, spectrum_all(1e-12f));
    return (SheetLight){(sheet->front - h * determinant) / rest, sheet->through / rest};
}

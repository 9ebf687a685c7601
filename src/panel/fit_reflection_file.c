/* The reflection's sections of a panel file. */
#include "panel/fit_parts.h"

void fit_write_reflection(FitWriter *writer, const FitReflection *r)
{
    size_t   padded = r->head.padded_wavelengths, f = sizeof(float);
    FitPiece pieces[] = {{&r->head, sizeof r->head},
                         {r->basis, r->head.coefficients * padded * f},
                         {r->mirror, PANEL_ANGLES * padded * f},
                         {r->profile, PANEL_ANGLES * r->head.slices * r->head.coefficients *
                                         (1 + r->head.harmonics) * f}};
    FitPiece tree = {r->tree, tree_size(r->tree)};
    fit_write_section(writer, PANEL_REFLECTION, 0, pieces, 4);
    fit_write_section(writer, PANEL_REFLECTION_TREE, 0, &tree, 1);
    FitPiece sampling = {r->sampling, r->sampling_size};
    if (r->sampling) fit_write_section(writer, PANEL_SAMPLING, 0, &sampling, 1);
}

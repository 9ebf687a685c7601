/* Sampling: a section of the file, or the promise that opening makes it. */
#include "panel/fit/fit_parts.h"
#include "panel/query/sampling_make.h"

bool fit_sampling(const Panel *panel, Arena *arena, FitReflection *reflection, Error *err)
{
    SamplingSection made;
    reflection->sampling = "";
    reflection->sampling_size = 0;
    if (panel_makes_sampling(panel->reflection)) return true;
    if (!sampling_make(panel, arena, &made, err)) return false;
    reflection->sampling = made.bytes;
    reflection->sampling_size = made.size;
    return true;
}

/* Sampling: a section of the file, or the promise that opening makes it. */
#include "panel/fit_parts.h"
#include "panel/sampling_make.h"

bool fit_sampling(const Panel *panel, Arena *arena, FitNotes *notes, FitReflection *reflection,
                  Error *err)
{
    SamplingSection made;
    reflection->sampling = "";
    reflection->sampling_size = 0;
    if (panel_makes_sampling(panel->reflection)) return true;
    if (!sampling_make(panel, arena, &made, err)) return false;
    reflection->sampling = made.bytes;
    reflection->sampling_size = made.size;
    if (made.azimuths == 1)
        fit_note(notes, "samples of the reflection are drawn at %d incidences from %.1f kB",
                 made.incidences, (double)made.size / 1e3);
    else
        fit_note(notes, "samples of the reflection are drawn at %d incidences and %d azimuths "
                 "from %.1f kB", made.incidences, made.azimuths, (double)made.size / 1e3);
    return true;
}

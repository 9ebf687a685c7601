/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_spectra.h"

#include <math.h>
#include <string.h>

#include "panel/query/panel_file.h"
#include "panel/shape/spectral_warp.h"

#define STEPS 6

static float most_of(const float *spectrum)
{
    float most = 0;
    for (int i = 0; i < SPECTRAL_COUNT; i++) most = fmaxf(most, spectrum[i]);
    return most;
}

/* Range of whole nm that hold light in any primary. */
static void lit_range(const Measurement *set, int *first, int *last)
{
    *first = SPECTRAL_COUNT;
    *last = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            if (set->spectrum[p][i] > 0) {
                if (i < *first) *first = i;
                if (i > *last) *last = i;
            }
}

/* Do samples every `step` nm from `first` on determine everything in between? */
static bool is_told_by(const Measurement *set, int first, int last, int step)
{
    for (int p = 0; p < 3; p++) {
        const float *s = set->spectrum[p];
        float small = 1e-5f * most_of(s);
        for (int i = first; i <= last; i++) {
            int   a = first + (i - first) / step * step, b = a + step;
            float t = (float)(i - a) / (float)step;
            if (b > last && i > a) return false;
            if (b > last) continue;
            if (fabsf(s[a] + (s[b] - s[a]) * t - s[i]) > small) return false;
        }
    }
    return true;
}

static int choose_step(const Measurement *set, int first, int last)
{
    static const int steps[STEPS] = {20, 10, 5, 4, 2, 1};
    for (int k = 0; k < STEPS; k++)
        if ((last - first) % steps[k] == 0 && is_told_by(set, first, last, steps[k]))
            return steps[k];
    return 1;
}

/* A spectrum that is 0 at its ends may have begun and ended one step outside of the light. */
static int widen(const Measurement *set, int *first, int *last)
{
    int best = choose_step(set, *first, *last), low = *first, high = *last;
    for (int before = 0; before < 20 && low - before >= 0; before++)
        for (int after = 0; after < 20 && high + after < SPECTRAL_COUNT; after++) {
            int step = choose_step(set, low - before, high + after);
            if (step <= best) continue;
            best = step;
            *first = low - before;
            *last = high + after;
        }
    return best;
}

const void *emission_spectra_write(const Measurement *set, FitNotes *notes, Arena *arena,
                                   size_t *size)
{
    PanelPrimariesHead head = {.kind = PANEL_SPECTRA_STORED};
    int first = 0, last = -1, step = 1;
    if (set->has_spectra) {
        lit_range(set, &first, &last);
        step = widen(set, &first, &last);
        if (last == first) last++;
        head.first_nm = (float)(SPECTRAL_FIRST_NM + first);
        head.step_nm = (float)step;
        head.count = (uint16_t)((last - first) / step + 1);
    } else {
        head.kind = set->is_white_only ? PANEL_SPECTRA_REC709 : PANEL_SPECTRA_TYPICAL;
        fit_note(notes, "no spectra of the primaries: %s, bent to the measured colours",
                 set->is_white_only ? "the Rec.709 primaries' smooth spectra under D65"
                                    : "typical ones (peaks at 625, 535 and 455 nm)");
    }
    *size = sizeof head + 6 * (size_t)head.count;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, *size), *at = bytes + sizeof head;
    for (int p = 0; p < 3; p++) {
        head.scale[p] = fmaxf(most_of(set->spectrum[p]), 1e-30f) / 65535;
        for (int i = first; i <= last && head.count; i += step) {
            uint16_t value = (uint16_t)rintf(set->spectrum[p][i] / head.scale[p]);
            memcpy(at, &value, sizeof value);
            at += sizeof value;
        }
    }
    memcpy(bytes, &head, sizeof head);
    return bytes;
}

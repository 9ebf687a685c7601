/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/pane.h"

/* A coated face for one polarisation. */
typedef struct PaneFace {
    Spectrum front, back, through;
} PaneFace;

static void face_at(const CoatingTables *tables, const PaneMeeting *meeting, PaneFace *out) {
    const Wavelengths *w = meeting->wavelengths;
    float cosine = meeting->cosine;
    *out = (PaneFace){coating_at(tables->front, w, cosine), coating_at(tables->back, w, cosine),
                      coating_at(tables->through, w, cosine)};
}

static void face_mean(const CoatingTables *tables, const PaneMeeting *meeting, PaneFace *out) {
    const Wavelengths *w = meeting->wavelengths;
    *out = (PaneFace){curve_lookup(&tables->front_mean, w), curve_lookup(&tables->back_mean, w),
                      curve_lookup(&tables->through_mean, w)};
}

/* Returns what is reflected in all. Between two perfect mirrors nothing gets in: 0, and not
 * 0 / 0. */
static Spectrum images_of(const PaneFace *near, const PaneFace *far, Spectrum t, PaneImages *out) {
    out->first = near->front;
    out->ghost = near->through * near->through * t * t * far->back;
    out->next = near->back * far->back * t * t;
    Spectrum once =
        spectrum_all(1) / spectrum_max(spectrum_all(1) - out->next, spectrum_all(1e-6f));
    out->passed = near->through * far->through * t * once;
    return out->first + out->ghost * once;
}

Spectrum pane_coated_images(const PaneMeeting *meeting, bool is_p, PaneImages *out) {
    PaneFace near, far;
    face_at(meeting->coating->face[!meeting->is_front][is_p], meeting, &near);
    face_at(meeting->coating->face[meeting->is_front][is_p], meeting, &far);
    return images_of(&near, &far, meeting->through, out);
}

PaneLight pane_coated(const PaneMeeting *meeting) {
    PaneImages s, p;
    Spectrum half = spectrum_all(0.5f), reflected = pane_coated_images(meeting, false, &s);
    reflected = half * (reflected + pane_coated_images(meeting, true, &p));
    return (PaneLight){reflected, half * (s.passed + p.passed)};
}

PaneLight pane_coated_mean(const PaneMeeting *meeting) {
    PaneLight sum = {spectrum_all(0), spectrum_all(0)};
    PaneImages images;
    for (int is_p = 0; is_p < 2; is_p++) {
        PaneFace near, far;
        face_mean(meeting->coating->face[!meeting->is_front][is_p], meeting, &near);
        face_mean(meeting->coating->face[meeting->is_front][is_p], meeting, &far);
        sum.reflected += spectrum_all(0.5f) * images_of(&near, &far, meeting->through, &images);
        sum.passed += spectrum_all(0.5f) * images.passed;
    }
    return sum;
}

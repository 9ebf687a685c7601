/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_section.h -- the reflection's section of a panel file: integrals and energy are
 * settled on the numbers as the file will hold them. */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

typedef struct ReflectionSection {
    const void *bytes; /* PanelReflectionStored and what follows it */
    size_t size;
    double lambertian_y[MEASUREMENT_INCIDENCES_MAX]; /* luminous, of the first azimuth */
    double largest_albedo;                           /* before it was held at 1 */
} ReflectionSection;

/* Means and lobe of the model change. */
bool reflection_section_write(ReflectionModel *model, FitNotes *notes, ReflectionSection *out,
                              Error *err);

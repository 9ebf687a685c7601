/* SPDX-License-Identifier: Apache-2.0 */
/* solid_loss.h -- what rough facets of a solid pass to one another, coming out at last.
 *
 * For dielectric.c, by the tables of facets/solid_energy.h, which d->energy must hold (where
 * facets are brushed its `brushed` as well): both sides get lost(wo) lost(wi) / mean of it.
 * Coated and filmed facets as well, and dispersive glass. Threads: pure functions.
 */
#pragma once
#include "shaders/solid_facet.h"

/* Adds this light to what single facets send, and to the density. */
void solid_loss_add(const Dielectric *d, const SolidRay *s, Spectrum *value, float *pdf);

/* Chooses s->wi for it if u[2] falls on its share; else false, and u[2] is uniform again. */
bool solid_loss_sample(const Dielectric *d, SolidRay *s, float u[3]);

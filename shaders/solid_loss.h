/* SPDX-License-Identifier: Apache-2.0 */
/* solid_loss.h -- what rough facets of a solid pass to one another, coming out at last.
 *
 * For dielectric.c, by the tables of facets/solid_energy.h, which d->energy must hold (where
 * facets are brushed its `brushed` as well): both sides get lost(wo) lost(wi) / mean of it.
 * Coated and filmed facets as well, and glass that parts light. Threads: pure functions.
 */
#pragma once
#include "shaders/solid_facet.h"

/* Adds to what single facets do, and to its density. */
void solid_loss_add(const Dielectric *d, const SolidRay *s, Spectrum *value, float *pdf);

/* A direction s->wi of what is lost, if u[2] falls on its share; else u[2] becomes what is
 * left. */
bool solid_loss_sample(const Dielectric *d, SolidRay *s, float u[3]);

/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_covered.h -- a coat over brushed, filmed, coated and woven bases.
 *
 * What facets/coat.h's tables do not know is integrated where it is met (covered_lobe.h).
 * Values are sr^-1 or shares of light.
 *
 * Threads  covered_set fills its own view; else pure functions.  Fails  never.
 */
#pragma once
#include "shaders/metallic/metallic_view.h"

/* The light along w that the covered lobe leaves. */
CoveredRest covered_rest(const MetallicView *view, Vec3 w);

/* Sets the view's `covered`, once its coat is known. */
void covered_set(MetallicView *view);

/* The Lambert base through the coat, in: of wi; albedo: of one side. */
Spectrum covered_lambert(const MetallicView *view, Spectrum albedo,
                         const CoveredRest *in);

/* The rebound's lobe, sr^-1, likewise. */
float covered_rebound_lobe(const MetallicView *view, const CoveredRest *in);

/* All of the rebound on the eye's side. */
Spectrum covered_rebound(const MetallicView *view, const CoveredRest *in);

/* SPDX-License-Identifier: Apache-2.0 */
/* dielectric.h -- clear glass and plastic: the boundary of a solid.
 *
 * The user page is on top of dielectric.c, the parameters in solid_facet.h. Frame: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/solid_facet.h"

extern const BsdfModel dielectric_model; /* of a Dielectric */

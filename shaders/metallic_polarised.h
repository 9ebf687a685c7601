/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_polarised.h -- what metallic_roughness does to polarised light.
 *
 * BsdfModel's polarise; matrices as of polarisation.h.
 *
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "shaders/bsdf_model.h"

/* False: no matrix is known for that way. */
bool metallic_polarised(const void *parameters, Vec3 wo, const BsdfSample *way,
                        BsdfPolarisation *out);

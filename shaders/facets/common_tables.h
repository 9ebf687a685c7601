/* SPDX-License-Identifier: Apache-2.0 */
/* common_tables.h -- the tables of glTF's default index of refraction, made with the program.
 *
 * Nearly every material has the index 1.5, a lacquer always. Their tables (energy.h, coat.h)
 * are computed when the program is built (tables/make_tables.c), with the bits that a run would
 * give them, and stand in it as constants.
 */
#pragma once
#include "shaders/facets/coat.h"

extern const EnergyTable common_energy_table; /* of CLEARCOAT_IOR */
extern const CoatTable   common_coat_table;   /* of a lacquer on a base of that index */

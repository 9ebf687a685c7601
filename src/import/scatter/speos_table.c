/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/speos_table.h"

#include "import/scatter/scatter.h"

bool speos_table_fill(const char *file, SpeosTable *table, const double *rows, Arena *arena,
                      Error *err)
{
    const double theta[] = {0, 90}, phi[] = {0, 360};
    table->value = ARENA_NEW(arena, double, (size_t)table->thetas * (size_t)table->phis);
    for (int i = 0; i < table->thetas; i++)
        for (int j = 0; j < table->phis; j++)
            table->value[j * table->thetas + i] = rows[i * table->phis + j];
    return angles_check(file, "theta", table->theta_deg, table->thetas, theta, err) &&
           angles_check(file, "phi", table->phi_deg, table->phis, phi, err);
}

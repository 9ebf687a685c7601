/* SPDX-License-Identifier: Apache-2.0 */
#include "import/scatter/speos_table.h"

#include "import/scatter/scatter.h"

void speos_table_turn(SpeosTable *table, const double *rows)
{
    for (int i = 0; i < table->thetas; i++)
        for (int j = 0; j < table->phis; j++)
            table->value[j * table->thetas + i] = rows[i * table->phis + j];
}

bool speos_table_check(const char *file, const SpeosTable *table, Error *err)
{
    const double theta[] = {0, 90}, phi[] = {0, 360};
    return angles_check(file, "theta", table->theta_deg, table->thetas, theta, err) &&
           angles_check(file, "phi", table->phi_deg, table->phis, phi, err);
}

double speos_table_integral(const SpeosTable *table, Arena scratch)
{
    ScatterGrid grid = {table->thetas, table->phis, table->theta_deg, table->phi_deg,
                      table->value, 0, false};
    return scatter_grid_integral(&grid, scratch);
}

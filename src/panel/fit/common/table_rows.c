/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/common/table_rows.h"

#include "base/mathd.h"
#include "base/units.h"

#define NEIGHBOUR_DEG 13.0 /* azimuths further apart than this do not show noise */

Vec3 table_direction(double theta, double phi)
{
    return vec3((float)(sin_d(theta) * cos_d(phi)), (float)(sin_d(theta) * sin_d(phi)),
                (float)cos_d(theta));
}

Vec3 table_row_direction(const AngleTable *table, int row)
{
    return table_direction((double)table->theta[row], (double)table->phi[row]);
}

double table_row_weight(const AngleTable *table, int row)
{
    double t = (double)table->theta[row];
    return sin_d(t > 1e-3 ? t : 1e-3) * cos_d(t);
}

int table_ring_end(const AngleTable *table, int begin)
{
    int end = begin;
    while (end < table->rows && table->theta[end] == table->theta[begin]) end++;
    return end;
}

TableNeighbours table_neighbours(const AngleTable *table, Arena *arena)
{
    int   *ring = ARENA_NEW(arena, int, table->rows);
    int   *inner = ARENA_NEW(arena, int, table->rows);
    float  most = (float)radians_from_degrees(NEIGHBOUR_DEG);
    int    begin = 0, before = -1; /* rings: this one and the one inside it */
    for (int i = 0; i < table->rows; i++) {
        if (table->theta[i] != table->theta[begin]) {
            before = begin;
            begin = i;
        }
        bool is_near = i > begin && table->phi[i] - table->phi[i - 1] < most;
        ring[i] = is_near ? i - 1 : -1;
        inner[i] = -1;
        if (before < 0) continue;
        int from = i > begin && inner[i - 1] >= 0 ? inner[i - 1] : before;
        while (from < begin && table->phi[from] < table->phi[i]) from++;
        if (from < begin && table->phi[from] == table->phi[i]) inner[i] = from;
        else if (begin - before == 1 && table->theta[before] == 0) inner[i] = before;
    }
    return (TableNeighbours){ring, inner};
}

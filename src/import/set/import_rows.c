/* SPDX-License-Identifier: Apache-2.0 */
#include "import/set/import_rows.h"

#include <string.h>

ImportRows import_rows(Arena *arena, int capacity, int masked, int channels) {
    size_t values = (size_t)capacity * (size_t)channels;
    return (ImportRows){.channels = channels,
                        .theta_deg = ARENA_NEW(arena, double, capacity),
                        .phi_deg = ARENA_NEW(arena, double, capacity),
                        .value = ARENA_NEW(arena, double, values),
                        .masked_theta_deg = ARENA_NEW(arena, double, masked),
                        .masked_phi_deg = ARENA_NEW(arena, double, masked)};
}

void import_rows_put(ImportRows *rows, double theta_deg, double phi_deg, const double *value) {
    memcpy(import_rows_next(rows), value, sizeof *value * (size_t)rows->channels);
    import_rows_end(rows, theta_deg, phi_deg);
}

void import_rows_mask(ImportRows *rows, double theta_deg, double phi_deg) {
    rows->masked_theta_deg[rows->masked] = theta_deg;
    rows->masked_phi_deg[rows->masked++] = phi_deg;
}

void import_rows_append(ImportRows *rows, const ImportTable *table) {
    size_t size = (size_t)table->channels;
    for (int i = 0; i < table->rows; i++)
        import_rows_put(rows, table->theta_deg[i], table->phi_deg[i],
                        table->value + (size_t)i * size);
    bool is_masked = table->masked_theta_deg != NULL;
    for (int i = 0; i < table->masked; i++)
        import_rows_mask(rows, is_masked ? table->masked_theta_deg[i] : 0,
                         is_masked ? table->masked_phi_deg[i] : 0);
}

void import_rows_give_measured(const ImportRows *rows, ImportTable *table) {
    table->rows = rows->rows;
    table->channels = rows->channels;
    table->theta_deg = rows->theta_deg;
    table->phi_deg = rows->phi_deg;
    table->value = rows->value;
}

void import_rows_give(const ImportRows *rows, ImportTable *table) {
    import_rows_give_measured(rows, table);
    table->masked = rows->masked;
    table->masked_theta_deg = rows->masked_theta_deg;
    table->masked_phi_deg = rows->masked_phi_deg;
}

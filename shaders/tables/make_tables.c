/* SPDX-License-Identifier: Apache-2.0 */
/* make_tables FILE -- writes, as C, the tables that common_tables.h, index_tables.h,
 * lobe_facets.h and sheen.h promise. The build runs it once; each number is written exactly. */
#include <stdio.h>

#include "shaders/facets/common_tables.h"
#include "shaders/facets/index_tables.h"
#include "shaders/tables/lobe_facets_build.h"
#include "shaders/metallic_roughness.h"
#include "shaders/tables/sheen_build.h"

/* The program's usual ones stand here themselves: water 1.333, paint and lining 1.45, glTF's
 * default 1.5, window glass 1.52. */
static const float NODES[INDEX_NODES] = {1.3f,  1.333f, 1.4f,  1.45f, 1.5f, 1.52f, 1.57f, 1.63f,
                                         1.7f,  1.78f,  1.87f, 1.98f, 2.1f, 2.25f, 2.4f};

/* All members of the tables are floats. */
static void write_floats(FILE *file, const void *table, size_t size)
{
    const float *values = table;
    fprintf(file, "{");
    for (size_t i = 0; i < size / sizeof *values; i++)
        fprintf(file, "%s%af,", i % 8 ? "" : "\n", (double)values[i]);
    fprintf(file, "\n}");
}

static void write_table(FILE *file, const char *head, const void *table, size_t size)
{
    fprintf(file, "\nconst %s = ", head);
    write_floats(file, table, size);
    fprintf(file, ";\n");
}

static void take_shapes(const EnergyTable *table, IndexShapes *shapes)
{
    for (int a = 0; a < ENERGY_ALPHAS; a++) {
        shapes->average[a] = table->average[a].shape;
        for (int c = 0; c < ENERGY_COSINES; c++)
            shapes->directional[a][c] = table->directional[a][c].shape;
    }
}

static void write_shapes(FILE *file, Arena *arena)
{
    IndexShapes *shapes = ARENA_NEW(arena, IndexShapes, 1);
    write_table(file, "float index_nodes[INDEX_NODES]", NODES, sizeof NODES);
    fprintf(file, "\nconst IndexShapes common_index_shapes[INDEX_NODES] = {\n");
    for (int i = 0; i < INDEX_NODES; i++) {
        take_shapes(energy_table_build(NODES[i], arena), shapes);
        write_floats(file, shapes, sizeof *shapes);
        fprintf(file, ",\n");
    }
    fprintf(file, "};\n");
}

int main(int count, char **names)
{
    FILE *file = count == 2 ? fopen(names[1], "w") : NULL;
    if (!file) return 1;
    Arena              arena = arena_reserve((size_t)1 << 28);
    const EnergyTable *energy = energy_table_build(CLEARCOAT_IOR, &arena);
    const CoatTable   *coat = coat_table_build(energy, energy, &arena);
    fprintf(file, "#include \"shaders/facets/common_tables.h\"\n"
                  "#include \"shaders/facets/index_tables.h\"\n"
                  "#include \"shaders/facets/lobe_facets.h\"\n"
                  "#include \"shaders/layers/sheen.h\"\n");
    write_table(file, "EnergyTable common_energy_table", energy, sizeof *energy);
    write_table(file, "CoatTable common_coat_table", coat, sizeof *coat);
    write_table(file, "FacetTable common_facet_table", facet_table_build(&arena),
                sizeof(FacetTable));
    write_table(file, "SheenTable common_sheen_table", sheen_table_build(energy, &arena),
                sizeof(SheenTable));
    write_shapes(file, &arena);
    arena_release(&arena);
    return fclose(file) == 0 ? 0 : 1;
}

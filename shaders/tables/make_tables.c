/* make_tables FILE -- writes, as C, the tables that common_tables.h promises. The build runs it
 * once; every number is written exactly. */
#include <stdio.h>

#include "shaders/common_tables.h"
#include "shaders/metallic_roughness.h"

/* All members of both tables are floats. */
static void write_floats(FILE *file, const void *table, size_t size)
{
    const float *values = table;
    fprintf(file, " = {");
    for (size_t i = 0; i < size / sizeof *values; i++)
        fprintf(file, "%s%af,", i % 8 ? "" : "\n", (double)values[i]);
    fprintf(file, "\n};\n");
}

int main(int count, char **names)
{
    FILE *file = count == 2 ? fopen(names[1], "w") : NULL;
    if (!file) return 1;
    Arena              arena = arena_reserve((size_t)1 << 28);
    const EnergyTable *energy = energy_table_build(CLEARCOAT_IOR, &arena);
    const CoatTable   *coat = coat_table_build(energy, energy, &arena);
    fprintf(file, "#include \"shaders/common_tables.h\"\n\n"
                  "const EnergyTable common_energy_table");
    write_floats(file, energy, sizeof *energy);
    fprintf(file, "\nconst CoatTable common_coat_table");
    write_floats(file, coat, sizeof *coat);
    arena_release(&arena);
    return fclose(file) == 0 ? 0 : 1;
}

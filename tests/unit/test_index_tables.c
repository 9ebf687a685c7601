/* SPDX-License-Identifier: Apache-2.0 */
/* Tables of any index of refraction against those that are computed in full. */
#include "fixture.h"

#include "shaders/facets/coat.h"
#include "shaders/facets/index_tables.h"

static double farthest(const Energy *a, const Energy *b, int count) {
    double most = 0;
    for (int i = 0; i < count; i++) {
        assert_float_equal(a[i].all, b[i].all, 0);
        double off = fabs((double)(a[i].shape - b[i].shape));
        most = off > most ? off : most;
    }
    return most;
}

TEST(a_nodes_table_has_the_bits_of_the_whole_computation) {
    for (int i = 0; i < INDEX_NODES; i += 4) {
        const EnergyTable *whole = energy_table_build(index_nodes[i], test_memory());
        const EnergyTable *node = energy_table_of(index_nodes[i], test_memory());
        assert_memory_equal(node, whole, sizeof *whole);
    }
    assert_memory_equal(energy_table_of(1.52f, test_memory()),
                        energy_table_build(1.52f, test_memory()), sizeof(EnergyTable));
    assert_ptr_equal(energy_table_of(1.5f, test_memory()), &common_energy_table);
}

TEST(outside_the_nodes_tables_are_computed) {
    const float outside[3] = {0, 1.1f, 3};
    for (int i = 0; i < 3; i++)
        assert_memory_equal(energy_table_of(outside[i], test_memory()),
                            energy_table_build(outside[i], test_memory()), sizeof(EnergyTable));
}

TEST(between_the_nodes_no_shape_is_off_by_more_than_is_said) {
    for (int i = 0; i + 1 < INDEX_NODES; i++) {
        float ior = 0.5f * (index_nodes[i] + index_nodes[i + 1]);
        const EnergyTable *whole = energy_table_build(ior, test_memory());
        const EnergyTable *mixed = energy_table_of(ior, test_memory());
        assert_float_equal(mixed->ior, ior, 0);
        double average = farthest(mixed->average, whole->average, ENERGY_ALPHAS);
        double row =
            farthest(mixed->directional[0], whole->directional[0], ENERGY_ALPHAS * ENERGY_COSINES);
        print_message("%g: average %.2g, directional %.2g\n", (double)ior, average, row);
        assert_near(average, 0, 2e-5);
        assert_near(row, 0, 2e-5);
    }
}

TEST_PROGRAM(make_arena, drop_arena)

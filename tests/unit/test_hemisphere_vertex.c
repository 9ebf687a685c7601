/* The vertex basis: its lattice, the fit of values to samples, trees and their queries. */
#include "hemisphere_fixture.h"

#include "hemisphere/vertex.h"
#include "hemisphere/vertex_tree.h"

static const VertexLattice LATTICES[] = {{0, 4}, {1, 2}, {3, 4}, {4, 2}, {6, 4}, {7, 2}};
#define LATTICE_COUNT ((int)(sizeof LATTICES / sizeof *LATTICES))

/* ---- the lattice ------------------------------------------------------------------------- */

static void indices_are_one_to_one(void **state)
{
    Fixture *f = *state;
    for (int i = 0; i < LATTICE_COUNT; i++) {
        VertexLattice l = LATTICES[i];
        Arena         scratch = f->arena;
        int           n = 1 << l.level;
        uint32_t      next = 0;
        for (int y = l.octants == 2 ? 0 : -n; y <= n; y++)
            for (int x = abs(y) - n; x <= n - abs(y); x++)
                assert_int_equal(vertex_index(l, x, y), next++);
        assert_int_equal(next, vertex_count(l));
        Vec3 *d = ARENA_NEW(&scratch, Vec3, next);
        vertex_directions(l, d);
        for (uint32_t v = 0; v < next; v++) {
            VertexPoint p = vertex_find(f->geodesic, l, d[v]);
            float       own = 0;
            for (int k = 0; k < 3; k++) own += p.vertex[k] == v ? p.weight[k] : 0;
            assert_near(own, 1, 1e-4);
            assert_near(vec3_length(d[v]), 1, 1e-6);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(indices_are_one_to_one, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

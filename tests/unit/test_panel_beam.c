/* SPDX-License-Identifier: Apache-2.0 */
/* Narrow beams of an emission, which no tree of triangles resolves: every sample, directions
 * between them, the light over the hemisphere, and what a damaged beam is refused for.
 *
 * PARHELION_BEAMS in the environment: all of them; tests/long.sh does that. */
#include "panel_fixture.h"

#include "panel/shape/panel_beam.h"
#include "panel/query/panel_components.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_file.h"
#include "panel/query/panel_opened.h"

#define WIDTH 0.5  /* degrees, full width at half maximum */
#define BOUND 0.02 /* relative, at every sample */
#define MEAN_BOUND 0.001
#define BYTES_MOST 3000

/* A beam over a background, in cd m^-2. */
typedef struct Beam {
    double theta, phi, height;
    double (*profile)(double half_widths);
    double (*background)(double theta);
    double longer;  /* along phi as along theta */
    double between; /* error between samples a tenth of a degree apart */
} Beam;

static double gaussian(double r) {
    return exp(-log(2) * r * r);
}

static double super_gaussian(double r) {
    return exp(-log(2) * r * r * r * r);
}

static double lorentzian(double r) {
    return 1 / (1 + r * r);
}

static double abc(double r) {
    return pow(1 + 0.5874 * r * r, -1.5);
}

static double lambert(double theta) {
    return 100 * cos(theta);
}

static double steep(double theta) {
    return 100 * exp(-2.7 * theta * theta) + 2 * cos(theta);
}

static double nearly_none(double theta) {
    return cos(theta);
}

/* The last one ends in an edge between two rings, where ln E falls by 3: no grid shows its
 * place. The first two are what a short run fits. */
static const Beam beams[] = {
    {30, 0, 900, gaussian, lambert, 1.6, 0.01}, {0, 0, 900, lorentzian, steep, 1, 0.02},
    {30, 0, 900, gaussian, lambert, 1, 0.01},   {30.03, 0.05, 900, super_gaussian, steep, 1, 0.02},
    {30, 0, 90000, abc, lambert, 1, 0.02},      {0, 0, 2000, super_gaussian, nearly_none, 1, 0.5},
};
#define SHORT_COUNT 2
#define BEAM_COUNT ((int)(sizeof beams / sizeof *beams))

/* The truth at a direction in degrees; directions near the beam are told apart in double. */
static double luminance(const Beam *b, double theta, double phi) {
    double t = radians_from_degrees(theta), p = radians_from_degrees(phi);
    double u = radians_from_degrees(b->theta), q = radians_from_degrees(b->phi);
    double x = sin(t) * cos(p), y = sin(t) * sin(p), z = cos(t);
    double a = (x * cos(q) + y * sin(q)) * cos(u) - z * sin(u), c = y * cos(q) - x * sin(q);
    double toward = (x * cos(q) + y * sin(q)) * sin(u) + z * cos(u);
    double across = hypot(a, c), angle = degrees_from_radians(atan2(across, toward));
    double stretch = across > 0 ? hypot(a, c / b->longer) / across : 1;
    return b->background(t) + b->height * b->profile(angle * stretch / (0.5 * WIDTH));
}

/* The rows' angles in degrees: a tenth of a degree apart around the beam. */
typedef struct Grid {
    double theta[200], phi[200];
    int thetas, phis;
} Grid;

static void add_steps(double *to, int *count, double first, double last, double step) {
    for (int i = 0; first + i * step < last - 1e-9; i++) to[(*count)++] = first + i * step;
}

static Grid grid_of(const Beam *b) {
    Grid g = {.thetas = 0};
    if (b->theta > 1) {
        add_steps(g.theta, &g.thetas, 0, 28, 4);
        add_steps(g.theta, &g.thetas, 28, 32, 0.1);
        add_steps(g.theta, &g.thetas, 32, 81, 4);
        add_steps(g.phi, &g.phis, 0, 4, 0.2);
        add_steps(g.phi, &g.phis, 4, 356, 8);
        add_steps(g.phi, &g.phis, 356, 360, 0.2);
    } else {
        add_steps(g.theta, &g.thetas, 0, 2, 0.1);
        add_steps(g.theta, &g.thetas, 2, 81, 2);
        add_steps(g.phi, &g.phis, 0, 360, 7.5);
    }
    return g;
}

static void write_table(const Beam *b, const Grid *g, const char *path) {
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "theta,phi,X,Y,Z\n");
    for (int i = 0; i < g->thetas; i++)
        for (int j = 0; j < (i ? g->phis : 1); j++) {
            double y = luminance(b, g->theta[i], g->phi[j]);
            fprintf(file, "%.6g,%.6g,%.7g,%.7g,%.7g\n", g->theta[i], g->phi[j], 0.95 * y, y,
                    1.09 * y);
        }
    assert_int_equal(fclose(file), 0);
}

static void fit_beam(Fixture *f, const Beam *b) {
    Grid grid = grid_of(b);
    FitOptions options = fit_options_default();
    options.bound = BOUND;
    fixture_folder(f);
    const char *path = fixture_path(f, "beam.csv");
    write_table(b, &grid, path);
    fixture_read(f, path);
    fixture_fit(f, &options);
}

static double miss(const Fixture *f, const Beam *b, double theta, double phi) {
    static const float white[3] = {255, 255, 255};
    float xyz[3];
    panel_emission_xyz(f->panel, direction_deg(theta, phi), white, xyz);
    return fabs((double)xyz[1] / luminance(b, theta, phi) - 1);
}

static double worst_sample(const Fixture *f, const Beam *b) {
    Grid g = grid_of(b);
    double worst = 0;
    for (int i = 0; i < g.thetas; i++)
        for (int j = 0; j < (i ? g.phis : 1); j++)
            worst = fmax(worst, miss(f, b, g.theta[i], g.phi[j]));
    return worst;
}

/* Within a degree and a half of the beam's centre, at random. */
static double worst_between(const Fixture *f, const Beam *b) {
    uint32_t random = 5;
    double worst = 0;
    for (int i = 0; i < 4000; i++) {
        double t = b->theta + 1.5 * (2 * steady_random(&random) - 1);
        double p = b->theta > 1 ? b->phi + 3 * (2 * steady_random(&random) - 1)
                                : 360 * steady_random(&random);
        worst = fmax(worst, miss(f, b, fabs(t), p));
    }
    return worst;
}

/* Midpoints, even in ln of the distance from the beam and then over the rest. */
static double true_mean(const Beam *b) {
    double sum = 0;
    Frame frame = frame_from_z(direction_deg(b->theta, b->phi));
    for (int i = 0; i < 400; i++)
        for (int j = 0; j < 200; j++) {
            double low = PI * pow((double)i / 400, 3), high = PI * pow((i + 1.0) / 400, 3);
            double r = 0.5 * (low + high), turn = 2 * PI * (j + 0.5) / 200;
            Vec3 d = frame_to_world(&frame, vec3((float)(sin(r) * cos(turn)),
                                                 (float)(sin(r) * sin(turn)), (float)cos(r)));
            if (d.z <= 0) continue;
            double t = acos(fmin(1, (double)d.z));
            double shape = hypot(cos(turn), sin(turn) / b->longer);
            double y = b->background(t) +
                       b->height * b->profile(degrees_from_radians(r) * shape / (0.5 * WIDTH));
            sum += y * (double)d.z * (cos(low) - cos(high)) * 2 * PI / 200;
        }
    return sum / PI;
}

TEST(beams_keep_the_bound) {
    const char *all = getenv("PARHELION_BEAMS");
    for (int i = 0; i < (all ? BEAM_COUNT : SHORT_COUNT); i++) {
        ENDS_BY(fixture_end) Fixture f;
        const Beam *b = &beams[i];
        fit_beam(&f, b);
        assert_int_equal(f.panel->emission->beams, 1);
        double sample = worst_sample(&f, b), between = worst_between(&f, b);
        static const float white[3] = {255, 255, 255};
        double mean = (double)panel_mean_luminance(f.panel, white) / true_mean(b) - 1;
        print_message("beam %d: samples %.3f %%, between %.3f %%, mean %.3f %%, %zu bytes\n", i,
                      100 * sample, 100 * between, 100 * mean, f.panel->size);
        assert_true(sample <= BOUND);
        assert_true(between <= b->between);
        assert_true(fabs(mean) < MEAN_BOUND);
        assert_true(f.panel->size < BYTES_MOST);
        Vec3 off = vec3_sub(f.panel->emission->beam[0].centre, direction_deg(b->theta, b->phi));
        assert_true(degrees_from_radians(sqrt((double)vec3_dot(off, off))) < 0.01 * WIDTH);
    }
}

/* ---- the stored form -------------------------------------------------------------------- */

#define KNOTS 12
#define COMPONENTS 3

static size_t pack(Arena *arena, const PanelBeamHead *head, const void **bytes) {
    static const float step[COMPONENTS] = {1e-3f, 1e-3f, 1e-4f};
    float coefficient[COMPONENTS * KNOTS] = {0};
    for (int i = 0; i < KNOTS; i++) {
        coefficient[i] = 2.0f / (float)(i + 1);
        coefficient[2 * KNOTS + i] = 30.0f - (float)i; /* more than 16 bits of its step */
    }
    return panel_beam_pack(head, coefficient, step, COMPONENTS, arena, bytes);
}

static const PanelBeamHead round_beam = {{0.6f, 0, 0.8f}, {0, 0, 0}, 0.01f, KNOTS, {0}};

TEST(a_stored_beam_comes_back) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 20);
    const void *bytes;
    size_t used, size = pack(&arena, &round_beam, &bytes);
    PanelBeam beam;
    assert_true(panel_beam_open(bytes, size, COMPONENTS, &arena, &beam, &used));
    assert_int_equal(used, size);
    for (int i = 0; i < KNOTS; i++) {
        const float *row = beam.coefficient + i * beam.stride;
        assert_true(fabsf(row[0] - 2.0f / (float)(i + 1)) <= 0.51e-3f);
        assert_true(row[1] == 0);
        assert_true(fabsf(row[2] - (30.0f - (float)i)) <= 0.51f * 30.0f / 32766);
    }
    float out[4] = {0, 0, 0, 0};
    panel_components_add_beam(&beam, vec3(0, 0, 1), out);
    assert_true(out[0] == 0 && out[2] == 0); /* far behind the reach */
    panel_components_add_beam(&beam, beam.centre, out);
    const float *row = beam.coefficient;
    assert_true(fabsf(out[0] - (row[0] + 4 * row[4] + row[8]) / 6) < 1e-5f);
}

TEST(damaged_beams_are_refused) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 20);
    const void *bytes;
    PanelBeam beam;
    PanelBeamHead bad[9];
    size_t used, size = pack(&arena, &round_beam, &bytes);
    for (size_t cut = 0; cut < size; cut++)
        assert_false(panel_beam_open(bytes, cut, COMPONENTS, &arena, &beam, &used));
    for (int i = 0; i < 9; i++) bad[i] = round_beam;
    bad[0].centre[0] = NAN;
    bad[1].centre[2] = -0.8f;
    bad[2].centre[1] = 0.1f;
    bad[3].narrow[0] = INFINITY;
    bad[4].narrow[2] = 101;
    bad[5].core = 0;
    bad[6].core = NAN;
    bad[7].knots = 3;
    bad[8].knots = 129;
    unsigned char *copy = arena_alloc(&arena, 1, 8, size + 1024);
    for (int i = 0; i < 9; i++) {
        memcpy(copy, bytes, size);
        memcpy(copy, &bad[i], sizeof bad[i]);
        assert_false(panel_beam_open(copy, size + 1024, COMPONENTS, &arena, &beam, &used));
    }
    static const float step[] = {-1e-3f, NAN, 1e4f};
    for (int i = 0; i < 3; i++) {
        memcpy(copy, bytes, size);
        memcpy(copy + sizeof(PanelBeamHead), &step[i], sizeof step[i]);
        assert_false(panel_beam_open(copy, size, COMPONENTS, &arena, &beam, &used));
    }
}

TEST_PROGRAM(NULL, NULL)

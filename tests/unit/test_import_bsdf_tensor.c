/* SPDX-License-Identifier: Apache-2.0 */
/* Scatter in binary files: RGL tensor files, MERL. */
#include "import/scatter/half_angle.h"
#include "import_fixture.h"

#define PI 3.14159265358979323846
#define RAD (PI / 180)

/* ---- a tensor file is put together ------------------------------------------------------- */

typedef struct Builder {
    unsigned char bytes[1 << 17];
    size_t header, data; /* ends of the list of fields and of the data */
    uint32_t fields;
} Builder;

#define HEADER_ROOM 1024

static void put(unsigned char *at, uint64_t value, int size) {
    for (int i = 0; i < size; i++) at[i] = (unsigned char)(value >> (8 * i));
}

static void builder_start(Builder *b) {
    memset(b, 0, sizeof *b);
    memcpy(b->bytes, "tensor_file", 12);
    b->bytes[12] = 1;
    b->header = 18;
    b->data = HEADER_ROOM;
}

/* shape ends with 0. type 10: floats, 3: uint16, 1: uint8. */
static void builder_add(Builder *b, const char *name, int type, const size_t *shape,
                        const double *value) {
    static const int sizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    size_t count = 1, length = strlen(name);
    int rank = 0;
    unsigned char *at = b->bytes + b->header;
    for (; shape[rank]; rank++) count *= shape[rank];
    put(at, length, 2);
    memcpy(at + 2, name, length);
    at += 2 + length;
    put(at, (uint64_t)rank, 2);
    put(at + 2, (uint64_t)type, 1);
    put(at + 3, b->data, 8);
    at += 11;
    for (int d = 0; d < rank; d++, at += 8) put(at, shape[d], 8);
    b->header = (size_t)(at - b->bytes);
    assert_true(b->header <= HEADER_ROOM && b->data + count * 4 <= sizeof b->bytes);
    for (size_t i = 0; i < count; i++, b->data += (size_t)sizes[type]) {
        float number = (float)value[i];
        uint32_t bits;
        memcpy(&bits, &number, 4);
        put(b->bytes + b->data, type == 10 ? bits : (uint64_t)value[i], sizes[type]);
    }
    put(b->bytes + 14, ++b->fields, 4);
}

#define SHAPE(...) ((const size_t[]){__VA_ARGS__, 0})
#define LIST(...) ((const double[]){__VA_ARGS__})

/* ---- RGL --------------------------------------------------------------------------------- */

#define NODES 5
#define SIGMA 0.8
#define NDF 1.5

/* Density 2 x along the first coordinate, so that s is mapped to (sqrt(s.x), s.y). */
static void half_of_node(int j, int i, double *theta_m, double *phi_m) {
    double x = sqrt((double)i / (NODES - 1));
    *theta_m = x * x * 90;
    *phi_m = (2.0 * j / (NODES - 1) - 1) * 180;
}

/* Fields of an isotropic file with light at 0 and 30 degrees; value(theta_o, c) is the BRDF,
 * which the file holds times cosine and 4 sigma / ndf. */
static void build_rgl(Builder *b, double (*value)(double theta_o, int channel), const char *kind) {
    static double spectra[2 * 3 * NODES * NODES];
    double lean[2] = {0, 30};
    for (int t = 0; t < 2; t++)
        for (int c = 0; c < 3; c++)
            for (int j = 0; j < NODES; j++)
                for (int i = 0; i < NODES; i++) {
                    double theta_m, phi_m, theta_o, phi_o;
                    half_of_node(j, i, &theta_m, &phi_m);
                    direction_to_degrees(half_angle_mirror(direction_from_degrees(lean[t], 0),
                                                           direction_from_degrees(theta_m, phi_m)),
                                         &theta_o, &phi_o);
                    spectra[((t * 3 + c) * NODES + j) * NODES + i] =
                        value(theta_o, c) * cos(theta_o * RAD) * 4 * SIGMA / NDF;
                }
    builder_start(b);
    builder_add(b, "description", 1, SHAPE(4), LIST('t', 'e', 's', 't'));
    builder_add(b, "theta_i", 10, SHAPE(2), LIST(0, 30 * RAD));
    builder_add(b, "phi_i", 10, SHAPE(1), LIST(0));
    builder_add(b, "ndf", 10, SHAPE(2, 2), LIST(NDF, NDF, NDF, NDF));
    builder_add(b, "sigma", 10, SHAPE(2, 2), LIST(SIGMA, SIGMA, SIGMA, SIGMA));
    builder_add(b, "vndf", 10, SHAPE(1, 2, 2, 2), LIST(0, 2, 0, 2, 0, 2, 0, 2));
    builder_add(b, "jacobian", 1, SHAPE(1), LIST(1));
    builder_add(b, kind, 10, SHAPE(1, 2, 3, NODES, NODES), spectra);
    if (!strcmp(kind, "spectra")) builder_add(b, "wavelengths", 10, SHAPE(3), LIST(450, 550, 650));
}

static double lambertian(double theta_o, int channel) {
    (void)theta_o;
    return 0.3 * (channel + 1) / PI;
}

static double leaning(double theta_o, int channel) {
    return 1 + theta_o + 100 * channel;
}

FIXTURE_TEST(rgl_values_lose_their_cosine) {
    Builder *b = ARENA_NEW(&f->arena, Builder, 1);
    build_rgl(b, lambertian, "spectra");
    assert_true(fixture_read(f, b->bytes, b->data, "rgl"));
    assert_int_equal(f->set.count, 2);
    const ImportTable *t = table_at(f, 30, 180);
    assert_true(t->rows > 8);
    for (int r = 0; r < t->rows; r++)
        for (int c = 0; c < 3; c++) assert_close(t->value[r * 3 + c], 0.3 * (c + 1) / PI, 1e-5);
    assert_close(t->wavelength_nm[2], 650, 1e-7);
}

/* Node i = 1 lies at s.x = 1/4, u.x = 1/2: theta_m = 22.5 degrees. With light at 30 degrees and
 * the half vector on its side the light leaves at 15 degrees, towards the light. */
FIXTURE_TEST(rgl_samples_are_warped_to_half_vectors) {
    Builder *b = ARENA_NEW(&f->arena, Builder, 1);
    build_rgl(b, leaning, "rgb");
    assert_true(fixture_read(f, b->bytes, b->data, "rgl"));
    const ImportTable *t = table_at(f, 30, 180);
    assert_close(value_at(t, 15, 180, 2), 1 + 15, 1e-5); /* red is the last band */
    assert_close(value_at(t, 15, 180, 0), 1 + 15 + 200, 1e-5);
    assert_close(value_at(t, 30, 0, 2), 1 + 30, 1e-5); /* i = 0: the mirror direction */
    assert_close(value_at(t, 75, 0, 2), 1 + 75, 1e-5); /* 22.5 away from the light */
    assert_close(value_at(table_at(f, 0, 180), 45, 90, 2), 1 + 45, 1e-5);
    assert_noted(f, "three bands");
}

FIXTURE_TEST(rgl_errors_name_the_field) {
    const Importer *i = &importer_rgl;
    Builder *b = ARENA_NEW(&f->arena, Builder, 1);
    build_rgl(b, lambertian, "spectra");
    assert_prefixes_refused(f, b->bytes, b->data, 7, i);
    builder_start(b);
    builder_add(b, "theta_i", 10, SHAPE(2), LIST(0, 1));
    assert_bytes_refused(f, b->bytes, b->data, i, "this field is missing");
    assert_string_equal(f->err.path, "phi_i");
    /* A field that is larger than the file. */
    put(b->bytes + 18 + 2 + 7 + 11, (uint64_t)1 << 62, 8);
    assert_bytes_refused(f, b->bytes, b->data, i, "field 'theta_i' is larger than the file");
}

/* A small sound file, but for one field. */
typedef struct Field {
    const char *name;
    int type;
    const size_t *shape;
    const double *value;
} Field;

static void build_but(Builder *b, Field other) {
    static const double ones[64] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    const Field field[] = {
        {"theta_i", 10, SHAPE(2), LIST(0, 1)},    {"phi_i", 10, SHAPE(1), LIST(0)},
        {"ndf", 10, SHAPE(2, 2), ones},           {"sigma", 10, SHAPE(2, 2), ones},
        {"vndf", 10, SHAPE(1, 2, 2, 2), ones},    {"jacobian", 1, SHAPE(1), ones},
        {"wavelengths", 10, SHAPE(1), LIST(500)}, {"spectra", 10, SHAPE(1, 2, 1, 2, 2), ones}};
    builder_start(b);
    for (size_t i = 0; i < sizeof field / sizeof *field; i++) {
        Field one = strcmp(field[i].name, other.name) ? field[i] : other;
        builder_add(b, one.name, one.type, one.shape, one.value);
    }
}

FIXTURE_TEST(rgl_refusals) {
    const struct {
        Field field;
        const char *words;
    } row[] = {
        {{"theta_i", 10, SHAPE(2), LIST(0, 2)}, "has 2, required: 0 to pi / 2"},
        {{"theta_i", 10, SHAPE(1, 2), LIST(0, 1)}, "has 2 dimensions, required: 1"},
        {{"theta_i", 2, SHAPE(2), LIST(0, 1)}, "has numbers of type 2, required: floats"},
        {{"theta_i", 10, SHAPE(2), LIST(0, INFINITY)}, "number 2 is not finite"},
        {{"phi_i", 10, SHAPE(3), LIST(0, 1, 2)},
         "has the wrong shape, required: phi_i x "
         "theta_i"},
        {{"ndf", 10, SHAPE(1, 4), LIST(1, 1, 1, 1)}, "wrong shape, required: at least 2 x 2"},
        {{"sigma", 10, SHAPE(2, 2), LIST(0, 0, 0, 0)}, "is 0 at theta_i 0, required: above 0"},
        {{"vndf", 10, SHAPE(1, 2, 2, 2), LIST(1, 1, 1, -1, 1, 1, 1, 1)}, "has a density below 0"},
        {{"vndf", 10, SHAPE(1, 2, 2, 2), LIST(0, 0, 0, 0, 1, 1, 1, 1)},
         "has a density of 0 everywhere"},
        {{"jacobian", 1, SHAPE(2), LIST(1, 1)}, "has the wrong shape, required: one number"},
        {{"wavelengths", 10, SHAPE(2), LIST(500, 600)},
         "has the wrong shape, required: phi_i "
         "x"},
        {{"wavelengths", 10, SHAPE(1), LIST(-5)}, "has -5 nm, required: rising wavelengths"},
        {{"spectra", 10, SHAPE(1, 2, 1, 1, 2), LIST(1, 1, 1, 1)}, "has the wrong shape"},
        {{"", 0, NULL, NULL}, NULL},
    };
    Builder *b = ARENA_NEW(&f->arena, Builder, 1);
    for (int i = 0; row[i].words; i++) {
        build_but(b, row[i].field);
        assert_false(fixture_read(f, b->bytes, b->data, "rgl"));
        if (!strstr(f->err.text, row[i].words))
            fail_msg("%s: %s, required: %s", row[i].field.name, f->err.text, row[i].words);
    }
    build_but(b, row[13].field);
    assert_true(fixture_read(f, b->bytes, b->data, "rgl"));
}

/* Half a turn of azimuths is a symmetry that is not read. */
FIXTURE_TEST(rgl_of_a_symmetric_material_is_refused) {
    static double ones[3 * 2 * 4] = {0};
    Builder *b = ARENA_NEW(&f->arena, Builder, 1);
    for (int i = 0; i < 24; i++) ones[i] = 1;
    for (int is_whole = 0; is_whole < 2; is_whole++) {
        double last = is_whole ? PI : 0;
        builder_start(b);
        builder_add(b, "theta_i", 10, SHAPE(2), LIST(0.5, 1));
        builder_add(b, "phi_i", 10, SHAPE(3), LIST(-PI, (last - PI) / 2, last));
        builder_add(b, "ndf", 10, SHAPE(2, 2), ones);
        builder_add(b, "sigma", 10, SHAPE(2, 2), ones);
        builder_add(b, "vndf", 10, SHAPE(3, 2, 2, 2), ones);
        builder_add(b, "jacobian", 1, SHAPE(1), LIST(0));
        builder_add(b, "wavelengths", 10, SHAPE(1), LIST(500));
        builder_add(b, "spectra", 10, SHAPE(3, 2, 1, 2, 2), ones);
        assert_true(fixture_read(f, b->bytes, b->data, "rgl") == is_whole);
    }
    assert_true(f->set.is_anisotropic); /* -180 and 0; 180 is -180 again */
    assert_int_equal(f->set.count, 4);
}

FIXTURE_TEST(tensor_files_that_are_not_sound_are_refused) {
    static const struct {
        size_t at; /* byte */
        int value;
        const char *words;
    } row[] = {
        {0, 'T', "is no tensor file: it does not begin with 'tensor_file'"},
        {12, 2, "the version is 2.0, required: 1.0"},
        {14, 200, "there are 200 fields, required: at most 64"},
        {27, 9, "field 'theta_i' has 9 dimensions, required: at most 8"},
        {29, 12, "field 'theta_i' has a type of number 12, required: 1 to 11"},
        {36, 1, "field 'theta_i' begins behind the file's end"},
    };
    Builder *b = ARENA_NEW(&f->arena, Builder, 1);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        build_but(b, (Field){"", 0, NULL, NULL});
        b->bytes[row[i].at] = (unsigned char)row[i].value;
        assert_bytes_refused(f, b->bytes, b->data, &importer_rgl, row[i].words);
    }
}

/* ---- MERL -------------------------------------------------------------------------------- */

/* Red, green, blue from the numbers of the cell. */
static unsigned char *build_merl(const int side[3], bool is_constant, size_t *size, Arena *arena) {
    size_t cells = (size_t)side[0] * (size_t)side[1] * (size_t)side[2];
    *size = 12 + 24 * cells;
    unsigned char *bytes = ARENA_NEW(arena, unsigned char, *size);
    double *value = ARENA_NEW(arena, double, 3 * cells);
    for (int i = 0; i < 3; i++) put(bytes + 4 * i, (uint64_t)side[i], 4);
    for (int h = 0, at = 0; h < side[0]; h++)
        for (int d = 0; d < side[1]; d++)
            for (int p = 0; p < side[2]; p++, at++) {
                value[at] = 1500 * (is_constant ? 0.5 / PI : 1 + h);
                value[cells + (size_t)at] = 1500 / 1.15 * (is_constant ? 0.5 / PI : 1 + d);
                value[2 * cells + (size_t)at] = 1500 / 1.66 * (is_constant ? 0.5 / PI : 1 + p);
            }
    memcpy(bytes + 12, value, 24 * cells);
    return bytes;
}

/* Is x well inside its cell? Rounding must not decide. */
static bool inside(double x) {
    double part = x - floor(x);
    return part > 1e-6 && part < 1 - 1e-6;
}

FIXTURE_TEST(merl_cells_are_found_by_half_and_difference_angles) {
    const int side[3] = {30, 30, 60};
    size_t size;
    unsigned char *bytes = build_merl(side, false, &size, &f->arena);
    strcat(f->file, ".binary");
    assert_true(fixture_read(f, bytes, size, "merl"));
    assert_int_equal(f->set.count, 9);
    int checked = 0;
    const ImportTable *t = table_at(f, 40, 180);
    for (int r = 0; r < t->rows; r++) {
        HalfAngles h = half_angles(direction_from_degrees(40, 180),
                                   direction_from_degrees(t->theta_deg[r], t->phi_deg[r]));
        double cell_h = 30 * sqrt(h.half_theta / 90), cell_d = 30 * h.diff_theta / 90;
        double cell_p = 60 * fmod(h.diff_phi + 360, 180) / 180;
        if (!inside(cell_h) || !inside(cell_d) || !inside(cell_p)) continue;
        assert_close(t->value[r * 3], 1 + floor(cell_p), 1e-9);
        assert_close(t->value[r * 3 + 1], 1 + floor(cell_d), 1e-9);
        assert_close(t->value[r * 3 + 2], 1 + floor(cell_h), 1e-9);
        checked++;
    }
    assert_true(checked > 500);
    assert_noted(f, "three bands at 465, 550 and 612 nm");
    assert_prefixes_refused(f, bytes, size, 10007, &importer_merl);
}

/* The narrowest cell of theta_h is 0.011 degrees: the rows near the mirror direction follow. */
FIXTURE_TEST(merl_of_full_size_and_its_unmeasured_cells) {
    const int side[3] = {90, 90, 180};
    size_t size;
    unsigned char *bytes = build_merl(side, true, &size, &f->arena);
    double unmeasured = -1;
    /* theta_h cell 0 of the difference angle 40: the mirror direction of light at 40. */
    for (int p = 0; p < 180; p++)
        memcpy(bytes + 12 + 8 * ((size_t)40 * 180 + (size_t)p), &unmeasured, 8);
    assert_true(fixture_read(f, bytes, size, "merl"));
    for (int i = 0; i < f->set.count; i++) {
        const ImportTable *t = &f->set.table[i];
        assert_true(t->rows > 2000);
        for (int r = 0; r < t->rows * 3; r++) assert_close(t->value[r], 0.5 / PI, 1e-12);
        assert_true((t->masked > 0) == (t->incidence_deg == 40));
    }
    row_at(table_at(f, 30, 180), 30, 0, 0.02);
}

FIXTURE_TEST(merl_errors_name_the_byte) {
    assert_refused(f, "abc", &importer_merl, "byte 0: the file ends inside its header");
    unsigned char bytes[12 + 24] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double infinite = INFINITY, unmeasured = -1;
    assert_bytes_refused(f, bytes, 20, &importer_merl,
                         "8 bytes follow, required: 24 for 1 x 1 x 1 cells of three colours");
    memcpy(bytes + 12, &infinite, 8);
    assert_bytes_refused(f, bytes, 36, &importer_merl, "number 1 is not finite");
    memcpy(bytes + 12, &unmeasured, 8);
    assert_bytes_refused(f, bytes, 36, &importer_merl, "has no value of reflection");
    bytes[1] = 255;
    assert_bytes_refused(f, bytes, 36, &importer_merl,
                         "a side is 65281 cells, required: 1 to 4096 (MERL: 90, 90, 180)");
}

TEST_PROGRAM(NULL, NULL)

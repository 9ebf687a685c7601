/* SPDX-License-Identifier: Apache-2.0 */
/* Scatter as tables: ASTM, Speos in text and binary; half and difference angles. */
#include "import/scatter/half_angle.h"
#include "import_fixture.h"

#define PI 3.14159265358979323846
#define RAD (PI / 180)

/* ---- ASTM -------------------------------------------------------------------------------- */

#define ASTM \
    "LAB_NAME \"none\"\nSAMPLE_NAME \"grey\"\nNUM_POINTS 4\n" \
    "VARS theta_i,phi_i,theta_s,phi_s,650nm,450nm\n" \
    "0.5,0,0.5,3.141592653589793,7,1\n0.5,0,0.25,1.5707963267948966,8,2\n" \
    "0.5,0,0,0,9,3\n1.0,0,1.0,-3.141592653589793,10,4\n"

FIXTURE_TEST(astm_mirror_lies_opposite_the_light) {
    assert_reads(f, ASTM, "astm");
    assert_int_equal(f->set.count, 2);
    const ImportTable *t = table_at(f, 0.5 / RAD, 0);
    assert_close(t->wavelength_nm[0], 450, 1e-7);
    assert_close(t->wavelength_nm[1], 650, 1e-7);
    assert_near(value_at(t, 0.5 / RAD, 0, 0), 1, 0);
    assert_near(value_at(t, 0.5 / RAD, 0, 1), 7, 0);
    assert_near(value_at(t, 0.25 / RAD, 270, 1), 8, 0);
    assert_near(value_at(t, 0, 0, 0), 3, 0);
    assert_near(value_at(table_at(f, 1 / RAD, 0), 1 / RAD, 0, 1), 10, 0);
    assert_noted(f, "angles are taken as radians");
    assert_false(f->set.is_anisotropic);
}

FIXTURE_TEST(astm_in_plane_lists_and_degrees) {
    assert_reads(f, "VARS theta_i,theta_s,brdf\n30,30,5\n30,-60,6\n", "astm");
    const ImportTable *t = table_at(f, 30, 180);
    assert_near(value_at(t, 30, 0, 0), 5, 0);
    assert_near(value_at(t, 60, 180, 0), 6, 0);
    assert_reads(f, "VARS theta_i,phi_i,theta_s,phi_s,R,G,B\n30,90,30,270,1,2,3\n", "astm");
    t = table_at(f, 30, 90);
    assert_near(value_at(t, 30, 0, 0), 3, 0);
    assert_near(value_at(t, 30, 0, 2), 1, 0);
    assert_noted(f, "blue, green and red stand as three bands at 465, 550 and 612 nm");
}

FIXTURE_TEST(astm_errors_name_the_line) {
    const Importer *i = &importer_astm;
    assert_refused(f, "NUM_POINTS 2\nVARS theta_i,theta_s,brdf\n30,30,5\n", i,
                   "line 3: there are 1 rows, and NUM_POINTS is 2");
    assert_refused(f, "VARS theta_i,theta_s,brdf\n30,30\n40,40,4\n", i,
                   "line 3: the row before has fewer than 3 numbers");
    assert_refused(f, "VARS theta_i,theta_s,brdf\n30,30,five\n", i,
                   "line 2: a number of the row is 'five', required: a number");
    assert_refused(f, "VARS theta_i,theta_s,nice,nasty\n30,30,5,6\n", i,
                   "line 2: VARS names "
                   "'nice', required: a wavelength like 550nm, or R,G,B or X,Y,Z, or one "
                   "column");
    assert_refused(f, "VARS theta_i,phi_s,brdf\n30,30,5\n", i, "line 2: VARS names no theta_s");
    f->options.wavelength_nm = 0;
    assert_refused(f, "VARS theta_i,theta_s,brdf\n30,30,5\n", i,
                   "does not say the wavelength of its values — give it as --wavelength NM");
    assert_prefixes_refused(f, ASTM, strlen(ASTM), 1, i);
}

/* ---- half and difference angles ----------------------------------------------------------- */

/* The light in the half vector's frame, turned by theta_h about y, then by phi_h about z. */
TEST(half_and_difference_angles_come_back) {
    for (int half_phi = -150; half_phi <= 180; half_phi += 30)
        for (int diff_phi = -140; diff_phi < 180; diff_phi += 40) {
            double h = 20 * RAD, p = half_phi * RAD, d = 35 * RAD, q = diff_phi * RAD;
            double x = sin(d) * cos(q), y = sin(d) * sin(q), z = cos(d);
            double down = x * cos(h) + z * sin(h);
            Direction half = {sin(h) * cos(p), sin(h) * sin(p), cos(h)};
            Direction light = {down * cos(p) - y * sin(p), down * sin(p) + y * cos(p),
                               z * cos(h) - x * sin(h)};
            HalfAngles found = half_angles(light, half_angle_mirror(light, half));
            assert_near(found.half_theta, 20, 1e-9);
            assert_near(found.half_phi, half_phi, 1e-9);
            assert_near(found.diff_theta, 35, 1e-9);
            assert_near(found.diff_phi, diff_phi, 1e-9);
        }
}

/* ---- Speos ------------------------------------------------------------------------------- */

/* Values in proportion to 3 at phi 0 and 1 at phi 180, Lambertian otherwise (2), as intensity:
 * times the cosine. The spectrum says 50% and 30%. */
static char *speos_text(Arena *arena, bool is_bsdf) {
    char *text = arena_format(arena,
                              "OPTIS - Anisotropic BSDF surface file v8.0\n0\nComment\n"
                              "11\nDescription\n0 1 0\n1 0\n%d\n2\n0 90\n2\n0 40\n2\n0 40\n"
                              "0 0\n\n2\n300 70\n700 30\n",
                              is_bsdf);
    for (int table = 0; table < 4; table++) {
        text = arena_format(arena, "%s19 5\n0 90 180 270 360\n", text);
        for (int i = 0; i <= 18; i++) {
            double cosine = is_bsdf ? 1 : cos(i * 5 * RAD);
            double front = (table == 1 ? 3 : 2) * cosine, back = (table == 1 ? 1 : 2) * cosine;
            text = arena_format(arena, "%s%d %.9g %.9g %.9g %.9g %.9g\n", text, i * 5, front,
                                2 * cosine, back, 2 * cosine, front);
        }
    }
    return arena_format(arena, "%sEnd of file\n", text);
}

FIXTURE_TEST(speos_values_are_scaled_to_the_stated_reflectance) {
    for (int is_bsdf = 0; is_bsdf < 2; is_bsdf++) {
        assert_reads(f, speos_text(&f->arena, is_bsdf), "speos");
        assert_int_equal(f->set.count, 4);
        assert_true(f->set.is_anisotropic);
        /* At normal incidence the value 2 has the integral 2 pi, so brdf = R / pi. */
        const ImportTable *t = table_at(f, 40, 180);
        assert_close(t->wavelength_nm[0], 360, 1e-7);
        assert_close(t->wavelength_nm[1], 700, 1e-7);
        assert_close(value_at(table_at(f, 0, 180), 30, 90, 1), 0.3 / PI, 2e-3);
        assert_close(value_at(t, 40, 90, 0), (0.7 - 0.4 * 60 / 400) / PI, 2e-3);
        assert_close(value_at(t, 40, 0, 1), 1.5 * 0.3 / PI, 2e-3);
        assert_close(value_at(t, 40, 180, 1), 0.5 * 0.3 / PI, 2e-3);
        /* Anisotropy angle 90: the mirror direction is at -90, the light at 90. */
        assert_close(value_at(table_at(f, 40, 90), 40, 0, 1), 0.3 / PI, 2e-3);
    }
}

FIXTURE_TEST(speos_spectral_tables_have_their_own_reflectance) {
    assert_reads(f,
                 "OPTIS - BRDF surface file v8.0\n0\nComment\n0\n\n1 0\n1\n1 2\n30\n"
                 "450 650\n40\n3 2\n0 180\n0 2 2\n45 2 2\n90 2 2\n"
                 "20\n3 2\n0 180\n0 5 5\n45 5 5\n90 5 5\n",
                 "speos");
    assert_int_equal(f->set.count, 2);
    assert_close(f->set.table[0].wavelength_nm[0], 450, 1e-7);
    assert_close(value_at(&f->set.table[0], 45, 0, 0), 0.4 / PI, 1e-4);
    assert_close(f->set.table[1].wavelength_nm[0], 650, 1e-7);
    assert_close(value_at(&f->set.table[1], 45, 180, 0), 0.2 / PI, 1e-4);
}

FIXTURE_TEST(speos_errors_name_the_line) {
    const Importer *i = &importer_speos;
    assert_refused(f, "OPTIS - Anisotropic BSDF surface file v7.0\n0\n", i,
                   "line 2: the version is 'v7.0', required: v8.0 or later");
    assert_refused(f,
                   "OPTIS - Anisotropic BSDF surface file v8.0\n0\nC\n0\n\n0 1 0\n0 1\n"
                   "1\n",
                   i,
                   "line 8: there is transmission only: a display panel is "
                   "opaque");
    assert_refused(f,
                   "OPTIS - BRDF surface file v8.0\n0\nC\n0\n\n1 0\n1\n1 1\n30\n450\n40\n"
                   "2 1\n0\n0 1\n95 1\n",
                   i, "theta is 95, required: 0 to 90 degrees");
    assert_refused(f,
                   "OPTIS - Simple scattering surface file v2.0\nC\nReflection\n"
                   "10 50 0 5\n",
                   i,
                   "line 4: the shares are 10, 50 and 0%; only a "
                   "Lambertian surface (0, above 0, 0) is known here");
    const char *text = speos_text(&f->arena, true);
    assert_prefixes_refused(f, text, strlen(text) - 12, 61, i); /* without "End of file" */
}

/* One block of literals: a token of 15 and the rest of the length, then the bytes. */
static void put_block(unsigned char **at, const double *number, size_t count) {
    size_t size = count * sizeof *number, rest = size - 15;
    unsigned char packed[4096], *p = packed;
    assert_true(size >= 15 && size < 4000);
    *p++ = 0xF0;
    for (; rest >= 255; rest -= 255) *p++ = 255;
    *p++ = (unsigned char)rest;
    memcpy(p, number, size);
    p += size;
    uint64_t bytes = size;
    uint32_t again = (uint32_t)size, length = (uint32_t)(p - packed);
    memcpy(*at, &bytes, 8);
    memcpy(*at + 8, &again, 4);
    memcpy(*at + 12, &length, 4);
    memcpy(*at + 16, packed, length);
    *at += 16 + length;
}

static void put_u32(unsigned char **at, uint32_t value) {
    memcpy(*at, &value, 4);
    *at += 4;
}

static void put_doubles(unsigned char **at, const double *list, size_t count) {
    memcpy(*at, list, count * sizeof *list);
    *at += count * sizeof *list;
}

/* One light at 30 degrees, BSDF values 2 everywhere but 6 at (45, 0); reflectance 0.25. */
static size_t speos_binary(unsigned char *bytes) {
    unsigned char *at = bytes;
    double anisotropy[2] = {0, 90}, incidence[2] = {30, 50}, theta[3] = {0, 45, 90};
    double phi[3] = {0, 120, 240}, flags[2] = {1, 1}, vector[3] = {0, 1, 0};
    double where[2] = {30, 0}, spectrum[4] = {400, 700, 25, 25};
    double settings[16] = {0}, tail = 632;
    memcpy(at, "OPTIS - Anisotropic BSDF surface file v9.0\n1", 44);
    at += 44;
    put_u32(&at, 3);
    put_u32(&at, 1);
    *at++ = 0;
    put_doubles(&at, vector, 3);
    put_u32(&at, 4);
    memcpy(at, "note", 4);
    at += 4;
    put_u32(&at, 0);
    *at++ = 1;
    *at++ = 0;
    put_doubles(&at, flags, 2);
    *at++ = 1;
    *at++ = 0;
    put_u32(&at, 2);
    put_block(&at, anisotropy, 2);
    for (int i = 0; i < 2; i++) {
        put_u32(&at, 2);
        put_block(&at, incidence, 2);
    }
    put_doubles(&at, where, 2);
    put_u32(&at, 0);
    put_u32(&at, 2);
    put_doubles(&at, spectrum, 4);
    for (int i = 0; i < 4; i++) {
        double value[9] = {2, 2, 2, i ? 2 : 6, 2, 2, 2, 2, 2}; /* rows of theta */
        put_u32(&at, 3);
        put_u32(&at, 3);
        put_block(&at, theta, 3);
        put_block(&at, phi, 3);
        put_block(&at, value, 9);
    }
    put_doubles(&at, settings, 16);
    *at++ = 0;
    put_doubles(&at, &tail, 1);
    return (size_t)(at - bytes);
}

FIXTURE_TEST(speos_binary_holds_what_its_text_would) {
    unsigned char bytes[4096];
    size_t size = speos_binary(bytes);
    assert_true(fixture_read(f, bytes, size, "speos"));
    assert_int_equal(f->set.count, 4);
    const ImportTable *t = table_at(f, 30, 180);
    assert_close(value_at(t, 45, 0, 0) / value_at(t, 45, 120, 0), 3, 1e-12);
    assert_close(value_at(t, 45, 120, 0), value_at(t, 0, 0, 1), 1e-12);
    table_at(f, 50, 90);
    assert_prefixes_refused(f, bytes, size, 1, &importer_speos);
    bytes[44] = 4;
    assert_false(fixture_read(f, bytes, size, "speos"));
    assert_string_equal(f->err.text, "a field of the header is 4, and only 3 is known here — "
                                     "save the file as text");
}

FIXTURE_TEST(speos_binary_refusals) {
    static const struct {
        int at; /* byte */
        int value;
        const char *words;
    } row[] = {
        {40, '8', "is binary and not of version 9.0"},
        {52, 1, "a field of the header is 1, and only 0 is known here"},
        {89, 0, "there is no reflection"},
        {89, 7, "a flag is 7, required: 0 or 1"},
        {90, 1, "the file has transmission, whose binary layout is not known here"},
        {98, 0x40, "a field of the header is 65536, and only 1 is known here"},
        {109, 0, "the number of anisotropy angles is 0, required: 1 to 4096"},
        {113, 17, "a block has 17 bytes, required: 16"},
        {129, 0x20, "a packed block is not sound"},
        {77, 0xFF, ""},
    };
    unsigned char bytes[4096];
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        size_t size = speos_binary(bytes);
        bytes[row[i].at] = (unsigned char)row[i].value;
        bool ok = fixture_import(f, bytes, size, &importer_speos);
        if (*row[i].words && (ok || !strstr(f->err.text, row[i].words)))
            fail_msg("byte %d: %s, required: %s", row[i].at, ok ? "taken" : f->err.text,
                     row[i].words);
    }
    size_t size = speos_binary(bytes);
    assert_bytes_refused(f, bytes, size + 1, &importer_speos,
                         "138 bytes follow the tables, required: 137");
}

/* Worked out from the file by an independent reading: the table at 5 degrees has 0.172308 at
 * (30, 0), times cosine; H(5) = 0.61736, H(10) = 0.62309 and R(6) = 62.27%. */
FIXTURE_TEST(a_real_measurement_of_speos_has_its_values) {
    const char *file = shared_bsdf(f, "speos/R_test.anisotropicbsdf");
    assert_true(fixture_read_file(f, file, "speos"));
    assert_int_equal(f->set.count, 19);
    const ImportTable *t = table_at(f, 5, 180);
    assert_int_equal(t->channels, 2);
    assert_close(value_at(t, 30, 0, 0), 0.200317, 1e-3);
    assert_close(value_at(table_at(f, 60, 180), 60, 180, 1), 0.487850, 1e-3);
    assert_noted(f, "brighter towards the light");
    file = shared_bsdf(f, "speos/L100_2.simplescattering");
    assert_true(fixture_read_file(f, file, "speos"));
    assert_close(value_at(table_at(f, 40, 180), 45, 90, 0), 1 / PI, 1e-12);
}

/* The anisotropy angles 0 and 90 as a block with a match (thirteen zeros), its bytes written
 * over the plain block of speos_binary. */
static bool reads_packed(Fixture *f, const unsigned char *block, size_t packed) {
    enum { BLOCK = 125, PLAIN = 18 }; /* u32 packed bytes, then so many of them */
    unsigned char bytes[4096], *at = bytes + BLOCK;
    size_t size = speos_binary(bytes);
    memmove(at + 4 + packed, at + 4 + PLAIN, size - BLOCK - 4 - PLAIN);
    put_u32(&at, (unsigned)packed);
    memcpy(at, block, packed);
    return fixture_read(f, bytes, size - PLAIN + packed, "speos");
}

FIXTURE_TEST(packed_blocks_that_are_not_sound_are_refused) {
    enum { MATCH = 0, OFFSET = 2 };
    const unsigned char good[] = {0x16, 0, 1, 0, 0x50, 0, 0, 0x80, 0x56, 0x40};
    assert_true(reads_packed(f, good, sizeof good));
    assert_int_equal(f->set.count, 4);
    table_at(f, 50, 90);
    for (size_t n = 0; n < sizeof good; n++) assert_false(reads_packed(f, good, n));
    static const struct {
        int at;
        unsigned char value;
    } wrong[] = {{MATCH, 0x15}, {MATCH, 0x17}, {MATCH, 0x1F}, {OFFSET, 2}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        unsigned char block[sizeof good];
        memcpy(block, good, sizeof good);
        block[wrong[i].at] = wrong[i].value;
        assert_false(reads_packed(f, block, sizeof block));
        assert_string_equal(f->err.text, "a packed block is not sound");
    }
}

TEST_PROGRAM(NULL, NULL)

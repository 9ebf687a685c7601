/* SPDX-License-Identifier: Apache-2.0 */
/* Hostile panel files: every prefix and thousands of mutations, with and without a checksum
 * that fits, of panels of both bases, with and without emission and reflection, isotropic and
 * not. They are refused with a text, or queried without a read outside their bytes (they lie in
 * a block of exactly their size, which the address sanitizer watches).
 *
 * PARHELION_MUTATIONS in the environment: how many mutations, PARHELION_MUTATIONS_SEED: which;
 * tests/long.sh runs 100,000.
 */
#include "panel_fixture.h"
#include "panel_bytes.h"

#include <sys/stat.h>
#include <sys/wait.h>

#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_sampling.h"

#define MUTATIONS 2400
#define FORGED_SHARE 4 /* one in so many has a checksum that fits: it is opened, at some ms */

static Fixture folder; /* files and what is made of them */

/* ---- the panels ------------------------------------------------------------------------- */

#define EMISSION \
    "\"emission\": {" FIXTURE_SPECTRA "\"black_cd_m2\": 0.5, \"leak\": 2," \
    " \"levels\": [127, 255]}"
#define REFLECTION \
    "\"reflection\": {\"haze_share\": 0.7, \"haze_width\": 0.2, \"incidence_deg\": [20, 50]," \
    "\"wavelengths_nm\": [450, 550, 650]}"
#define INSTRUMENT \
    "\"instrument\": {\"theta_step_deg\": 10, \"phi_step_deg\": 30, \"fwhm_deg\": 10}"
#define SMALL_RECIPE "{\"panel\": \"small\", " EMISSION ", " REFLECTION ", " INSTRUMENT "}"

#define ONLY_REFLECTION \
    "{\"panel\": \"dark\", \"reflection\": {\"wavelengths_nm\": [450, 550, 650]," \
    "\"incidence_deg\": [20, 50], \"files\": \"brdf/i{incidence}.csv\"}}"
#define ONE_TABLE \
    "{\"panel\": \"one table\", \"reflection\": {\"wavelengths_nm\": [450, 550, 650]," \
    "\"incidence_deg\": [20], \"files\": \"brdf/i{incidence}.csv\"}}"
#define ANISOTROPIC \
    "{\"panel\": \"brushed\", \"emission\": {\"white\": \"emission/black.csv\"}," \
    "\"reflection\": {\"wavelengths_nm\": [450, 550, 650], \"incidence_deg\": [20, 50]," \
    "\"incidence_phi_deg\": [0, 90, 180, 270]," \
    "\"files\": \"brdf/i{incidence}_a{azimuth}.csv\"}}"

#define POLARISED \
    "{\"emission\": {\"white\": \"emission/black.csv\"}," \
    "\"polarisation\": {\"degree\": 0.9, \"azimuth_deg\": 45}}"

#define ZONED \
    "{\"emission\": {\"white\": \"emission/black.csv\"}, \"size_mm\": [30, 20]," \
    "\"local_dimming\": {\"zones\": [9, 5], \"spread\": {\"sigma_mm\": 5}}}"
#define SPOTS \
    "{\"emission\": {\"white\": \"emission/black.csv\"}, \"reflection\": {" \
    "\"wavelengths_nm\": [450, 550, 650], \"incidence_deg\": [20]," \
    "\"files\": \"brdf/i{incidence}.csv\"}, \"spots\": [" \
    "{\"position\": [0, 0.5], \"emission\": {\"white\": \"emission/red_255.csv\"}}," \
    "{\"position\": [0.9, 0.2], \"reflection\": {\"wavelengths_nm\": [450, 550, 650]," \
    "\"incidence_deg\": [50], \"files\": \"brdf/i{incidence}.csv\"}}," \
    "{\"position\": [0.4, 1], \"emission\": {\"white\": \"emission/blue_255.csv\"}}]}"
#define MAPPED \
    "{\"emission\": {\"white\": \"emission/black.csv\"}, \"uniformity\": {" \
    "\"file\": \"map.csv\"}}"

#define STEPS "{\"emission\": {\"white\": \"emission/steps.csv\"}}"
#define HULLS \
    "{\"panel\": \"rings\", \"reflection\": {\"wavelengths_nm\": [550]," \
    "\"incidence_deg\": [20, 50], \"files\": \"rings/i{incidence}.csv\"}}"

/* One kind of file: from a manifest's text, NULL: the simulated one. */
typedef struct Kind {
    const char *name, *manifest;
    FitBasis basis;
    size_t size;
    unsigned char *bytes; /* as fitted */
} Kind;

static Kind kinds[] = {
    {"vertex", NULL, FIT_VERTEX, 0, NULL},
    {"haar", NULL, FIT_HAAR, 0, NULL},
    {"white only", "{\"emission\": {\"white\": \"emission/black.csv\"}}", FIT_VERTEX, 0, NULL},
    {"polarised", POLARISED, FIT_VERTEX, 0, NULL},
    {"zoned", ZONED, FIT_VERTEX, 0, NULL},
    {"spots", SPOTS, FIT_VERTEX, 0, NULL},
    {"map", MAPPED, FIT_VERTEX, 0, NULL},
    {"reflection only", ONLY_REFLECTION, FIT_VERTEX, 0, NULL},
    {"one table", ONE_TABLE, FIT_VERTEX, 0, NULL},
    {"beam", "{\"emission\": {\"white\": \"emission/beam.csv\"}}", FIT_VERTEX, 0, NULL},
    {"anisotropic", ANISOTROPIC, FIT_VERTEX, 0, NULL},
    {"anisotropic haar", ANISOTROPIC, FIT_HAAR, 0, NULL},
    {"steps", STEPS, FIT_VERTEX, 0, NULL}, /* light that ends between its samples */
    {"hulls", HULLS, FIT_VERTEX, 0, NULL}, /* of samples that leave much out */
};
#define KIND_COUNT ((int)(sizeof kinds / sizeof *kinds))

/* The pattern's tables, one a quarter turn of the light: the same one under four names. */
static void copy_azimuths(void) {
    static const int incidences[] = {20, 50};
    for (int i = 0; i < 2; i++) {
        FileBytes bytes;
        const char *from =
            arena_format(&folder.arena, "%s/brdf/i%d.csv", folder.folder, incidences[i]);
        assert_done(file_read(from, (size_t)1 << 24, &folder.arena, &bytes, &err));
        for (int a = 0; a < 360; a += 90)
            fixture_file(&folder, arena_format(&folder.arena, "brdf/i%d_a%d.csv", incidences[i], a),
                         (const char *)bytes.data);
    }
}

/* A narrow beam at 20 degrees, a thousand times as bright as what it stands on. */
static void write_beam(void) {
    FILE *file = fopen(fixture_path(&folder, "emission/beam.csv"), "w");
    assert_non_null(file);
    fprintf(file, "theta,phi,X,Y,Z\n");
    for (double t = 0; t <= 80; t += t > 17.9 && t < 22 ? 0.25 : 2)
        for (double p = 0; p < 360; p += t == 0 ? 360 : p < 4 || p > 355.9 ? 0.5 : 8) {
            Vec3 v = vec3_sub(direction_deg(t, p), direction_deg(20, 0));
            double r = degrees_from_radians(sqrt((double)vec3_dot(v, v)));
            double y = 1 + 1000 * exp(-2.77 * r * r);
            fprintf(file, "%g,%g,%.6g,%.6g,%.6g\n", t, p, 0.95 * y, y, 1.09 * y);
        }
    assert_int_equal(fclose(file), 0);
}

/* Light that ends between rings, at another theta each azimuth. */
static void write_steps(void) {
    char text[4096];
    size_t n = (size_t)snprintf(text, sizeof text, "theta,phi,X,Y,Z\n");
    for (int t = 0; t <= 70; t += 10)
        for (int p = 0; p < (t ? 360 : 1); p += 45) {
            double y = t < 30 + p / 12 ? 500 - t : 2 + 0.01 * p;
            n += (size_t)snprintf(text + n, sizeof text - n, "%d,%d,%g,%g,%g\n", t, p, 0.9 * y, y,
                                  (1.1 + 0.002 * t) * y);
        }
    fixture_file(&folder, "emission/steps.csv", text);
}

/* Samples up to 30 degrees about the mirror direction alone. */
static void write_rings(void) {
    for (int i = 20; i <= 50; i += 30) {
        char text[4096];
        size_t n = (size_t)snprintf(text, sizeof text, "theta,phi,550\n");
        Vec3 x = direction_deg(90 - i, 180), z = direction_deg(i, 0);
        for (int r = 0; r <= 30; r += 10)
            for (int p = 0; p < (r ? 360 : 1); p += 30) {
                Vec3 at = direction_deg(r, p);
                Vec3 d = vec3_add(vec3_scale(x, at.x), vec3_scale(z, at.z));
                d.y += at.y;
                n += (size_t)snprintf(
                    text + n, sizeof text - n, "%.4f,%.4f,%.5g\n",
                    degrees_from_radians(acos(fmin(1, (double)d.z))),
                    fmod(360 + degrees_from_radians(atan2((double)d.y, (double)d.x)), 360),
                    0.01 + 0.2 * exp(-r / 8.0));
            }
        fixture_file(&folder, arena_format(&folder.arena, "rings/i%d.csv", i), text);
    }
}

static void write_map(void) {
    char text[4096];
    size_t n = (size_t)snprintf(text, sizeof text, "column,row,X,Y,Z,black_Y\n");
    for (int i = 0; i < 12; i++)
        n += (size_t)snprintf(text + n, sizeof text - n, "%d,%d,%d,%d,%d,%g\n", i % 4, i / 4, 9 + i,
                              11 + i, 30 - i, 0.1 * (i + 1));
    fixture_file(&folder, "map.csv", text);
}

static const char *manifest_of(const Kind *kind) {
    if (kind->manifest) return fixture_file(&folder, "OTHER.json", kind->manifest);
    return fixture_path(&folder, "MANIFEST.json");
}

static FitOptions small_options(FitBasis basis) {
    FitOptions options = fit_options_default();
    options.level = 2;
    options.basis = basis;
    options.bound = 0.2f; /* the coder has little to search */
    options.force = true; /* so coarse a panel is nothing to use */
    return options;
}

static void fit_kind(Kind *kind) {
    FileBytes bytes;
    FitOptions options = small_options(kind->basis);
    if (!fixture_try(&folder, manifest_of(kind), &options, folder.panel_path, &bytes, NULL, why()))
        fail_told(kind->name, why());
    kind->size = bytes.size;
    kind->bytes = arena_alloc(&folder.arena, 1, 64, bytes.size);
    memcpy(kind->bytes, bytes.data, bytes.size);
}

static int start(void **state) {
    *state = &folder;
    fixture_simulate(&folder, SMALL_RECIPE);
    copy_azimuths();
    write_beam();
    assert_int_equal(mkdir(fixture_path(&folder, "grain"), 0700), 0);
    assert_int_equal(mkdir(fixture_path(&folder, "rings"), 0700), 0);
    write_rings();
    write_steps();
    write_map();
    for (int i = 0; i < KIND_COUNT; i++) fit_kind(&kinds[i]);
    return 0;
}

/* ---- queries ---------------------------------------------------------------------------- */

/* Everything that a renderer or a command evaluates; no answer is checked, it must only not go
 * astray. */
static void ask_everything(const Panel *panel) {
    Wavelengths w = even_wavelengths(370, 30);
    double number[PANEL_INFO_LEVELS_MAX], phi[PANEL_INFO_AZIMUTHS_MAX];
    float rgb[3] = {255, 90.5f, 3}, u[3] = {0.3f, 0.7f, 0.9f}, xyz[3], pdf;
    float nm[PANEL_INFO_WAVELENGTHS_MAX];
    for (int i = 0; i < 4; i++) {
        Vec3 wo = direction_deg(29.0 * i, 100.0 * i);
        Vec3 wi = direction_deg(80 - 25.0 * i, 60.0 * i);
        panel_emission_xyz(panel, wo, rgb, xyz);
        panel_emission_spectrum(panel, wi, rgb, &w);
        panel_mean_luminance(panel, rgb);
        PanelPolarisation p = panel_polarisation(panel);
        assert_true(p.degree >= 0 && p.degree <= 1 && p.azimuth >= 0 && p.azimuth < PI_F);
        panel_brdf(panel, wo, wi, &w);
        panel_mirror(panel, wo.z, &w);
        panel_haze_albedo(panel, wi.z);
        panel_pdf(panel, wo, wi);
        panel_sample(panel, wo, u, &wi, &pdf);
        float place[2] = {0.4f * (float)i, 1 - 0.3f * (float)i};
        PanelMix mix = panel_place_reflection(panel, place);
        panel_place_emission_xyz(panel, place, wo, rgb, xyz);
        panel_place_emission_spectrum(panel, place, wi, rgb, &w);
        panel_mix_brdf(&mix, wo, wi, &w);
        panel_mix_sample(&mix, wo, u, &wi, &pdf);
        if (i < 3) panel_info_levels(panel, i, number);
    }
    panel_info_wavelengths(panel, nm);
    panel_info_incidences(panel, number);
    panel_info_azimuths(panel, phi);
}

/* Opens and evaluates; true when it was accepted. Refusals must have a text and the file's
 * name. */
static bool try_bytes(const unsigned char *bytes, size_t size, const Kind *kind) {
    Arena scratch = folder.arena;
    Panel *panel = NULL;
    if (panel_from_bytes(bytes, size, "x.panel", &scratch, &panel, why())) {
        ask_everything(panel);
        return true;
    }
    if (why()->code != ERROR_INPUT || strcmp(why()->file, "x.panel") != 0 || !why()->text[0])
        fail_msg("%s: refused without saying why: '%s' '%s'", kind->name, why()->file, why()->text);
    return false;
}

/* NULL: there is none. */
static const unsigned char *section_of(const char *name, PanelSectionKind kind) {
    for (int k = 0; k < KIND_COUNT; k++) {
        PanelHeader header;
        if (strcmp(kinds[k].name, name) != 0) continue;
        memcpy(&header, kinds[k].bytes, sizeof header);
        for (uint32_t i = 0; i < header.section_count; i++) {
            PanelSection section;
            memcpy(&section, kinds[k].bytes + sizeof header + i * sizeof section, sizeof section);
            if (section.kind == kind) return kinds[k].bytes + section.offset;
        }
    }
    return NULL;
}

/* What the tests below are to meet. */
TEST(some_panels_keep_hulls) {
    assert_non_null(section_of("hulls", PANEL_REACH));
    assert_null(section_of("vertex", PANEL_REACH));
}

/* The checksum stands behind the version. */
TEST(files_of_other_versions_are_refused_with_what_to_do) {
    for (uint32_t version = 0; version < 2 * PANEL_VERSION; version++) {
        unsigned char *copy = malloc(kinds[0].size);
        memcpy(copy, kinds[0].bytes, kinds[0].size);
        memcpy(copy + offsetof(PanelHeader, version), &version, sizeof version);
        assert_true(try_bytes(copy, kinds[0].size, &kinds[0]) == (version == PANEL_VERSION));
        free(copy);
        if (version != PANEL_VERSION)
            assert_non_null(strstr(why()->text, ", required: 7: fit its measurement set or recipe "
                                                "again (`panel fit` of this program)"));
    }
}

/* ---- prefixes and mutations ------------------------------------------------------------ */

TEST(every_prefix_of_a_panel_is_refused) {
    for (int k = 0; k < KIND_COUNT; k++) {
        size_t step = 1 + kinds[k].size / 4000; /* of a long file: its head, then samples */
        for (size_t n = 0; n < kinds[k].size; n += n < 3000 ? 1 : step) {
            unsigned char *copy = malloc(n + 1);
            memcpy(copy, kinds[k].bytes, n);
            if (try_bytes(copy, n, &kinds[k]))
                fail_msg("%s: %zu of %zu bytes were accepted", kinds[k].name, n, kinds[k].size);
            free(copy);
        }
    }
}

/* As if the rest had never been written: size and checksum fit. */
TEST(every_shortened_panel_is_refused_or_read_within_its_bytes) {
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t n = sizeof(PanelHeader); n < kinds[k].size; n += 1 + kinds[k].size / 300) {
            unsigned char *copy = malloc(n);
            uint64_t size = n;
            memcpy(copy, kinds[k].bytes, n);
            memcpy(copy + offsetof(PanelHeader, size), &size, sizeof size);
            repair_checksum(copy, n);
            try_bytes(copy, n, &kinds[k]);
            free(copy);
        }
}

/* A number above 0 of the environment. */
static int asked_for(const char *name, int otherwise) {
    const char *wanted = getenv(name);
    int number = wanted ? atoi(wanted) : 0;
    return number > 0 ? number : otherwise;
}

static int mutation_count(void) {
    return asked_for("PARHELION_MUTATIONS", MUTATIONS) / KIND_COUNT + 1;
}

static uint32_t mutation_seed(void) {
    return (uint32_t)asked_for("PARHELION_MUTATIONS_SEED", 11);
}

/* A place: half of them in headers, counts and offsets. */
static size_t place_in(size_t size, uint32_t *random) {
    size_t range = steady_random(random) < 0.5 && size > 1500 ? 1500 : size;
    return (size_t)(steady_random(random) * (double)range);
}

/* A few bytes at random; or numbers as they stand in headers: extremes, off by one. */
static void mutate(unsigned char *bytes, size_t size, uint32_t *random) {
    static const uint32_t extremes[] = {0,          1,          0x7f,       0xff,       0x7fff,
                                        0xffff,     0x7fffffff, 0xffffffff, 0x80000000, 0x7f800000,
                                        0x7fc00000, 0xff800000, 0x00000001, 0x5f000000};
    int changes = 1 + (int)(steady_random(random) * 4);
    for (int i = 0; i < changes; i++) {
        size_t at = place_in(size, random);
        double mode = steady_random(random);
        uint32_t word;
        if (mode < 0.5 || at / 4 * 4 + 4 > size) {
            bytes[at] = (unsigned char)(steady_random(random) * 256);
            continue;
        }
        at = at / 4 * 4;
        memcpy(&word, bytes + at, 4);
        if (mode < 0.8) word = extremes[(int)(steady_random(random) * 14)];
        else if (mode < 0.9) word += steady_random(random) < 0.5 ? 1u : 0xffffffffu;
        else memcpy(&word, bytes + place_in(size - 4, random), 4);
        memcpy(bytes + at, &word, mode < 0.7 ? 4 : 2);
    }
}

TEST(every_mutation_is_refused) {
    uint32_t random = mutation_seed();
    for (int k = 0; k < KIND_COUNT; k++) {
        const Kind *kind = &kinds[k];
        unsigned char *copy = malloc(kind->size);
        for (int i = 0; i < mutation_count(); i++) {
            memcpy(copy, kind->bytes, kind->size);
            mutate(copy, kind->size, &random);
            if (!memcmp(copy, kind->bytes, kind->size)) continue;
            if (try_bytes(copy, kind->size, kind))
                fail_msg("%s: mutation %d was accepted", kind->name, i);
        }
        free(copy);
    }
}

/* As if somebody had written the file with ill intent: the checksum fits. */
TEST(a_forged_checksum_leads_nobody_astray) {
    uint32_t random = mutation_seed() + 5;
    for (int k = 0; k < KIND_COUNT; k++) {
        const Kind *kind = &kinds[k];
        unsigned char *copy = malloc(kind->size);
        int opened = 0, count = mutation_count() / FORGED_SHARE;
        for (int i = 0; i < count; i++) {
            memcpy(copy, kind->bytes, kind->size);
            mutate(copy, kind->size, &random);
            repair_checksum(copy, kind->size);
            opened += try_bytes(copy, kind->size, kind);
        }
        free(copy);
        /* else the test would test nothing */
        if (opened < count / 50)
            fail_msg("%s: only %d of %d were accepted", kind->name, opened, count);
    }
}

/* Two files spliced: the head of one kind, the rest of another. */
TEST(spliced_panels_lead_nobody_astray) {
    uint32_t random = 3;
    for (int i = 0; i < 300; i++) {
        const Kind *a = &kinds[(int)(steady_random(&random) * KIND_COUNT)];
        const Kind *b = &kinds[(int)(steady_random(&random) * KIND_COUNT)];
        size_t least = a->size < b->size ? a->size : b->size;
        size_t cut = (size_t)(steady_random(&random) * (double)least) / 8 * 8;
        uint64_t size = b->size;
        unsigned char *copy = malloc(b->size);
        memcpy(copy, b->bytes, b->size);
        memcpy(copy, a->bytes, cut);
        memcpy(copy + offsetof(PanelHeader, size), &size, sizeof size);
        repair_checksum(copy, b->size);
        try_bytes(copy, b->size, b);
        free(copy);
    }
}

/* ---- other files ------------------------------------------------------------------------- */

static void expect_no_panel(const char *path, const char *part, const char *other) {
    Panel *panel;
    assert_false(panel_open(path, &folder.arena, &panel, why()));
    assert_line_has(why(), (const char *[]){part, other}, 2);
}

TEST(other_files_are_no_panels) {
    expect_no_panel("/no/such.panel", "/no/such.panel", "cannot be opened");
    expect_no_panel(folder.folder, "is a folder, a file is required", "");
    expect_no_panel(fixture_file(&folder, "x.panel", ""), "x.panel",
                    "is no panel file, required: one that `panel fit` wrote");
    expect_no_panel(fixture_file(&folder, "x.panel",
                                 "PHPANEL\nxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"
                                 "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx"),
                    "x.panel: header: has version", "fit its measurement set or recipe again");
    panel_close(NULL);
}

TEST(an_unwritable_output_is_named) {
    json_t *report = NULL;
    FitOptions options = small_options(FIT_VERTEX);
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    assert_done(measurement_read(manifest_of(&kinds[0]), &folder.arena, set, &err));
    assert_false(
        panel_fit(set, &options, "/no/such/folder/x.panel", &folder.arena, &report, why()));
    assert_int_equal(why()->code, ERROR_OUTPUT);
    assert_non_null(strstr(why()->file, "/no/such/folder/x.panel"));
}

/* ---- memory ------------------------------------------------------------------------------ */

/* Opens, evaluates and (if requested) fits with an arena of so many bytes, as a process of its
 * own: running out is an exit, as in the program, or an error that says so of a file. */
static int status_with(size_t bytes, bool fits, const char *output) {
    pid_t child = fork();
    if (child == 0) {
        Arena arena = arena_reserve(bytes);
        Panel *panel = NULL;
        json_t *report = NULL;
        FitOptions options = small_options(FIT_VERTEX);
        arena.on_full = leave_when_full;
        bool is_done = !fits && panel_open(folder.panel_path, &arena, &panel, why());
        Measurement *set = fits ? ARENA_NEW(&arena, Measurement, 1) : NULL;
        if (fits)
            is_done = measurement_read(manifest_of(&kinds[0]), &arena, set, why()) &&
                      panel_fit(set, &options, output, &arena, &report, why());
        _exit(is_done ? 0 : why()->code == ERROR_MEMORY ? FULL_STATUS : 3);
    }
    return status_of(child);
}

/* Whatever the memory, it is a clean end: done, or out of memory and nothing written. */
TEST(running_out_of_memory_is_a_clean_end) {
    const char *output = fixture_path(&folder, "memory.panel");
    for (int fits = 0; fits < 2; fits++) {
        int full = 0, status = FULL_STATUS;
        for (size_t bytes = 1u << 16; status == FULL_STATUS && bytes < (size_t)8 << 30;
             bytes += bytes / (fits ? 1 : 4)) {
            status = status_with(bytes, fits, output);
            if (status != 0 && status != FULL_STATUS)
                fail_msg("%zu bytes: status %d", bytes, status);
            full += status == FULL_STATUS;
            if (fits) assert_int_equal(file_exists(output), status == 0);
        }
        assert_int_equal(status, 0);
        assert_true(full > 1); /* else the test would test nothing */
    }
}

TEST_PROGRAM(start, fixture_group_end)

/* SPDX-License-Identifier: Apache-2.0 */
/* Local dimming in files: manifests, recipes and panel files, whole and damaged. */
#include "panel_fixture.h"
#include "panel_bytes.h"

#include "panel/query/panel_emission.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_zones.h"
#include "panel/set/dimming_keys.h"

static Fixture folder; /* a folder for files */

static int start(void **state) {
    *state = &folder;
    fixture_folder(&folder);
    fixture_file(&folder, "good.csv", "theta,phi,X,Y,Z\n0,0,95,100,108\n50,0,60,70,75\n");
    return 0;
}

#define ZONED_OF(size, text) \
    "{\"emission\": {\"white\": \"good.csv\"}, " size "\"local_dimming\": " text "}"
#define ZONED(text) ZONED_OF("\"size_mm\": [320, 180], ", text)
#define PLAIN "{\"emission\": {\"white\": \"good.csv\"}, \"size_mm\": [320, 180]}"
#define GAUSS "{\"zones\": [32, 18], \"spread\": {\"sigma_mm\": 7.5}}"
#define ALL_OF_IT \
    "{\"zones\": [8, 3], \"spread\": {\"radius_mm\": [0, 20, 90], \"value\": [5, 2.5, 0]}, " \
    "\"drive\": {\"rule\": \"mean\", \"codes\": [0, 64, 255], \"drives\": [0.01, 0.4, 1], " \
    "\"least\": 0.02}, \"compensates\": false}"

/* The panel of a manifest, and the bytes of its file. */
static Panel *fitted(const char *manifest, FileBytes *bytes) {
    Panel *panel = NULL;
    FitOptions options = fit_options_default();
    const char *path = fixture_file(&folder, "MANIFEST.json", manifest);
    options.level = 2; /* quickly */
    options.bound = 0.2f;
    options.force = true;
    assert_done(fixture_try(&folder, path, &options, folder.panel_path, bytes, &panel, &err));
    return panel;
}

/* ---- whole ------------------------------------------------------------------------------- */

TEST(zones_are_kept_and_cost_nothing_where_there_are_none) {
    FileBytes none, some;
    Panel *plain = fitted(PLAIN, &none), *zoned = fitted(ZONED(GAUSS), &some);
    assert_null(panel_zones(plain));
    const DimmingZones *zones = panel_zones(zoned);
    assert_true(zones->count[0] == 32 && zones->count[1] == 18 && zones->compensates);
    assert_true(zones->sigma_mm == 7.5 && zones->size_mm[0] == 320 && zones->size_mm[1] == 180);
    assert_true(zones->rule == ZONES_MAXIMUM && zones->least == 0 && !zones->drive.rows);
    assert_in(some.size, none.size + 1, none.size + 64); /* place and section */
}

TEST(tables_and_rules_come_back) {
    FileBytes bytes;
    const DimmingZones *zones = panel_zones(fitted(ZONED(ALL_OF_IT), &bytes));
    assert_true(zones->sigma_mm == 0 && zones->spread.rows == 3 && zones->drive.rows == 3);
    assert_true(zones->rule == ZONES_MEAN && !zones->compensates);
    assert_close(zones->least, 0.02, 1e-6);
    assert_close(dimming_zones_spread(zones, 10), 3.75, 1e-6);
    assert_close(dimming_zones_spread(zones, 55), 1.25, 1e-6);
    assert_near(dimming_zones_spread(zones, 90.01), 0, 0);
    assert_close(zone_table_at(&zones->drive, 32), 0.205, 1e-6);
    json_t *json = dimming_keys_json(zones);
    char *words = json_dumps(json, JSON_COMPACT);
    const char *again = arena_format(&folder.arena,
                                     "{\"emission\": {\"white\": \"good.csv\"}, "
                                     "\"size_mm\": [320, 180], \"local_dimming\": %s}",
                                     words);
    FileBytes second;
    fitted(again, &second);
    assert_int_equal(second.size, bytes.size);
    const DimmingZones *found = panel_zones(fitted(again, &second));
    assert_memory_equal(found, zones, sizeof *found);
    free(words);
    json_decref(json);
}

TEST(levels_are_the_panels_along_the_normal) {
    FileBytes bytes;
    LevelShares levels;
    Panel *panel = fitted(ZONED(GAUSS), &bytes);
    panel_level_shares(panel, &levels);
    for (int code = 1; code < 256; code += 2) {
        const float rgb[2][3] = {{0, (float)code, 0}, {0, 255, 0}};
        float xyz[2][3];
        for (int k = 0; k < 2; k++) panel_emission_xyz(panel, vec3(0, 0, 1), rgb[k], xyz[k]);
        assert_close(levels.share[1][code], xyz[0][1] / xyz[1][1], 1e-4); /* no black */
        assert_close(level_share_at(&levels, 1, code), pow(code / 255.0, 2.2), 1e-3);
    }
    assert_true(levels.share[2][0] == 0 && levels.share[2][255] == 1);
}

/* ---- what is wrong ----------------------------------------------------------------------- */

TEST(manifests_name_the_key) {
    static const struct {
        const char *text, *parts[3];
    } cases[] = {
        {ZONED("3"), {"/local_dimming", "is a number", "required: an object"}},
        {ZONED("{\"spread\": {\"sigma_mm\": 7}}"), {"/local_dimming", "'zones' is missing"}},
        {ZONED("{\"zones\": [32, 18]}"), {"/local_dimming", "'spread' is missing", ""}},
        {ZONED("{\"zones\": [32], \"spread\": {\"sigma_mm\": 7}}"),
         {"/local_dimming/zones", "has 1 values", "required: 2"}},
        {ZONED("{\"zones\": [32, 0], \"spread\": {\"sigma_mm\": 7}}"),
         {"/local_dimming/zones", "0", "1 to 512"}},
        {ZONED("{\"zones\": [512, 129], \"spread\": {\"sigma_mm\": 7}}"),
         {"/local_dimming/zones", "too many", "65536"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {}}"),
         {"/local_dimming/spread", "no spread", "'sigma_mm'"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"sigma_mm\": 1}}"),
         {"/local_dimming/spread", "dark between zones", "an eighth"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"sigma_mm\": 9, \"radius_mm\": [0, 9], "
               "\"value\": [1, 0]}}"),
         {"/local_dimming/spread", "both", "one of them"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"radius_mm\": [0, 9], \"value\": [1]}}"),
         {"/local_dimming/spread", "no spread", "as many radii"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"radius_mm\": [0, 5], \"value\": [1, 0]}}"),
         {"/local_dimming/spread", "dark between zones", "diagonal"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"sigma_mm\": 7}, \"drive\": {\"rule\": "
               "\"median\"}}"),
         {"/local_dimming/drive/rule", "median", "maximum, mean"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"sigma_mm\": 7}, \"drive\": {\"codes\": "
               "[0, 9]}}"),
         {"/local_dimming/drive", "wrong table", "as many codes"}},
        {ZONED("{\"zones\": [32, 18], \"spread\": {\"sigma_mm\": 7}, \"compensate\": true}"),
         {"/local_dimming/compensate", "unknown key", "'compensates'"}},
        {ZONED_OF("", GAUSS), {"/local_dimming", "not 'size_mm'", "millimetres"}},
        {"{\"size_mm\": [9, 9], \"local_dimming\": " GAUSS ", \"reflection\": {"
         "\"wavelengths_nm\": [500], \"incidence_deg\": [0], \"files\": \"{incidence}.csv\"}}",
         {"/local_dimming", "no 'emission'", ""}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error err = {0};
        Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
        const char *path = fixture_file(&folder, "MANIFEST.json", cases[i].text);
        if (measurement_read(path, &folder.arena, set, &err))
            fail_msg("was accepted: %s", cases[i].text);
        assert_line_has(&err, cases[i].parts, cases[i].parts[2] ? 3 : 2);
    }
}

/* A copy of a file, and where its table of contents names a kind. */
static unsigned char *copy_of(const FileBytes *bytes, PanelSectionKind kind, PanelSection **found) {
    unsigned char *copy = malloc(bytes->size);
    memcpy(copy, bytes->data, bytes->size);
    *found = (PanelSection *)(copy + sizeof(PanelHeader));
    while ((*found)->kind != kind) ++*found;
    return copy;
}

/* Why such a copy, its checksum made to fit, is refused, in one line; NULL: it is not, and its
 * zones are some. Releases it. */
static const char *refusal_of(unsigned char *copy, size_t size) {
    static Error err;
    Arena scratch = folder.arena;
    const char *key;
    Panel *panel;
    err = (Error){0};
    repair_checksum(copy, size);
    bool is_opened = panel_from_bytes(copy, size, "x.panel", &scratch, &panel, &err);
    if (is_opened) assert_null(dimming_zones_fault(panel_zones(panel), &key));
    free(copy);
    if (is_opened) return NULL;
    assert_non_null(strstr(err.text, "required: "));
    assert_null(strchr(err.text, '\n'));
    return err.text;
}

/* The same of the section alone, without opening all that stands beside it: a thousand
 * times. */
static const char *section_refusal(unsigned char *copy, size_t size) {
    static Error err;
    Arena scratch = folder.arena;
    const char *key;
    Panel panel = {.emission = ARENA_NEW(&scratch, PanelEmission, 1)};
    PanelBytes bytes = {copy, size, "x.panel", &err};
    err = (Error){0};
    bool is_opened = panel_open_zones(&bytes, &scratch, &panel);
    free(copy);
    if (is_opened) assert_null(dimming_zones_fault(panel.zones, &key));
    else assert_non_null(strstr(err.text, "required: "));
    return is_opened ? NULL : err.text;
}

/* Every byte of the section, at values that matter. */
TEST(damaged_bytes_are_refused_or_zones) {
    static const unsigned char values[] = {0, 1, 2, 3, 0x3c, 0x41, 0x7f, 0x80, 0xbf, 0xff};
    static const char *const manifests[] = {ZONED(GAUSS), ZONED(ALL_OF_IT)};
    PanelSection *toc;
    FileBytes bytes;
    for (int kind = 0; kind < 2; kind++) {
        int accepted = 0;
        fitted(manifests[kind], &bytes);
        unsigned char *first = copy_of(&bytes, PANEL_ZONES, &toc);
        uint32_t size = toc->size;
        free(first);
        for (uint32_t i = 0; i < size * sizeof values; i++) {
            unsigned char *copy = copy_of(&bytes, PANEL_ZONES, &toc);
            copy[toc->offset + i / sizeof values] = values[i % sizeof values];
            accepted += section_refusal(copy, bytes.size) == NULL;
        }
        assert_in(accepted, size, 9 * size);        /* low bytes of numbers say little */
        for (uint32_t cut = 0; cut < size; cut++) { /* every prefix of the section */
            unsigned char *copy = copy_of(&bytes, PANEL_ZONES, &toc);
            toc->size = cut;
            assert_non_null(strstr(section_refusal(copy, bytes.size), "wrong number of bytes"));
        }
    }
}

/* Every prefix of a whole file with zones, as it is and with a head that says it is whole: one
 * line that says what is wrong. */
TEST(every_prefix_is_one_clear_error) {
    FileBytes bytes;
    PanelHeader head;
    fitted(ZONED(ALL_OF_IT), &bytes);
    for (size_t cut = 0; cut < bytes.size; cut++)
        for (int is_mended = 0; is_mended < 2; is_mended++) {
            Error err = {0};
            Arena scratch = folder.arena;
            Panel *panel;
            unsigned char *copy = malloc(cut + 1);
            memcpy(copy, bytes.data, cut);
            if (is_mended && cut > sizeof head) {
                memcpy(&head, copy, sizeof head);
                head.size = cut;
                memcpy(copy, &head, sizeof head);
                repair_checksum(copy, cut);
            }
            if (panel_from_bytes(copy, cut, "x.panel", &scratch, &panel, &err))
                fail_msg("%zu of %zu bytes are taken", cut, bytes.size);
            free(copy);
            assert_true(!strcmp(err.file, "x.panel") && err.text[0]);
            assert_null(strchr(err.text, '\n'));
        }
}

TEST(versions_fit_what_is_there) {
    PanelSection *toc;
    FileBytes bytes;
    fitted(ZONED(GAUSS), &bytes);
    unsigned char *copy = copy_of(&bytes, PANEL_ZONES, &toc);
    copy[toc->offset] = 2;
    assert_non_null(strstr(refusal_of(copy, bytes.size), "version 2, known: 1"));
    copy = copy_of(&bytes, PANEL_EMISSION, &toc);
    toc->kind = 999;
    assert_non_null(strstr(refusal_of(copy, bytes.size), "stand without an emission"));
}

TEST_PROGRAM(start, fixture_group_end)

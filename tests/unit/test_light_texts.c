/* SPDX-License-Identifier: Apache-2.0 */
/* Texts that hold light, each field with each fault: left over, missing, negative, huge, NaN, a
 * decimal comma. What is right stands beside the field. */
#include "fixture.h"
#include "import/luminaire/eulumdat.h"
#include "import/luminaire/ies.h"
#include "panel/set/level_table.h"
#include "panel/set/primary_spectra.h"
#include "sky/weather_clock.h"
#include "spectrum/curve.h"

typedef enum Fault { LEFT_OVER, MISSING, NEGATIVE, HUGE_ONE, NOT_A_NUMBER, COMMA, FAULTS } Fault;

/* A field of a text: what it is called in messages, and which faults are none. */
typedef struct Field {
    const char *name, *value;
    unsigned allowed; /* bits of faults that are read */
} Field;

#define ALLOW(fault) (1u << (fault))

/* The field's text under a fault; MISSING is the caller's: NULL. */
static const char *with_fault(const Field *field, Fault fault, Arena *arena) {
    switch (fault) {
    case LEFT_OVER: return arena_format(arena, "%s 5", field->value);
    case NEGATIVE: return "-7.25";
    case HUGE_ONE: return "1e30";
    case NOT_A_NUMBER: return "nan";
    case COMMA: return "1,5";
    default: return NULL;
    }
}

/* Is the message one line that names a line, and the field where the fault is in its value? */
static void check_refusal(bool is_read, const Field *field, Fault fault, const Error *err) {
    bool is_allowed = field->allowed & ALLOW(fault);
    if (is_read && !is_allowed) fail_msg("%s: fault %d is read", field->name, (int)fault);
    if (!is_read && is_allowed) fail_msg("%s: %d: %s", field->name, (int)fault, err->text);
    if (is_read) return;
    bool has_name = strstr(err->text, field->name) != NULL;
    bool has_line = strstr(err->path, "line") || strstr(err->text, "line");
    if (!has_line || ((fault == NEGATIVE || fault == NOT_A_NUMBER) && !has_name))
        fail_msg("%s: fault %d: %s: %s", field->name, (int)fault, err->path, err->text);
    if (fault == COMMA && !strstr(err->text, "decimal"))
        fail_msg("%s: no word of a decimal comma: %s", field->name, err->text);
}

static FileBytes bytes_of(const char *text) {
    return (FileBytes){(const unsigned char *)text, strlen(text)};
}

/* ---- luminaires -------------------------------------------------------------------------- */

#define SIZES (ALLOW(NEGATIVE)) /* round shapes */

static const Field ies_fields[] = {{"the number of lamps", "1", 0},
                                   {"the lumens a lamp", "3000", 0},
                                   {"the candela multiplier", "1", 0},
                                   {"the number of vertical angles", "4", 0},
                                   {"the number of horizontal angles", "2", 0},
                                   {"the photometric type", "1", 0},
                                   {"the units of length", "2", 0},
                                   {"the width", ".1", SIZES},
                                   {"the length", ".1", SIZES},
                                   {"the height", ".1", SIZES},
                                   {"the ballast factor", "1", 0},
                                   {"the ballast-lamp factor", "1", 0},
                                   {"the watts", "30", 0},
                                   {"the vertical angle", "0", 0},
                                   {"the vertical angle", "30", 0},
                                   {"the vertical angle", "60", 0},
                                   {"the vertical angle", "90", 0},
                                   {"the horizontal angle", "0", 0},
                                   {"the horizontal angle", "90", 0},
                                   {"an intensity", "1000", 0},
                                   {"an intensity", "800", 0},
                                   {"an intensity", "300", 0},
                                   {"an intensity", "0", 0},
                                   {"an intensity", "1000", 0},
                                   {"an intensity", "800", 0},
                                   {"an intensity", "300", 0},
                                   {"an intensity", "0", 0}};
enum { IES_FIELDS = sizeof ies_fields / sizeof *ies_fields };

static bool read_luminaire(bool is_ldt, const char *text, Arena *arena, Luminaire *out) {
    ImportSet set = import_set(arena);
    FileBytes bytes = bytes_of(text);
    *out = (Luminaire){0};
    *why() = (Error){0};
    return is_ldt ? eulumdat_read_luminaire("x.ldt", &bytes, &set, out, why())
                  : ies_read_luminaire("x.ies", &bytes, &set, out, why());
}

static void check_ies_field(int faulty, Fault fault, Arena arena) {
    char *text = ARENA_NEW(&arena, char, 2048);
    size_t at = (size_t)sprintf(text, "IESNA:LM-63-2002\n[TEST] x\nTILT=NONE\n");
    Luminaire out;
    for (int i = 0; i < IES_FIELDS; i++) {
        const char *value =
            i == faulty ? with_fault(&ies_fields[i], fault, &arena) : ies_fields[i].value;
        at += (size_t)sprintf(text + at, "%s%s", value ? value : "", i % 5 == 4 ? "\n" : " ");
    }
    check_refusal(read_luminaire(false, text, &arena, &out), &ies_fields[faulty], fault, why());
}

ARENA_TEST(every_number_of_an_ies_is_read_or_named) {
    for (int i = 0; i < IES_FIELDS; i++)
        for (int fault = 0; fault < FAULTS; fault++) check_ies_field(i, (Fault)fault, arena);
}

/* A line without a name holds what no light is made of. A decimal comma alone on its line can
 * be read; where a whole number is required it is no number. */
#define ANY_SIGN (ALLOW(NEGATIVE) | ALLOW(COMMA))
static const Field ldt_fields[] = {{NULL, "Maker", 0},
                                   {"the type of luminaire", "1", 0},
                                   {"the symmetry", "2", 0},
                                   {"the number of C-planes", "2", 0},
                                   {"the step of the C-planes", "180", ALLOW(COMMA)},
                                   {"the number of angles a plane", "4", 0},
                                   {"the step of the angles", "30", ALLOW(COMMA)},
                                   {NULL, "report", 0},
                                   {NULL, "Lamp", 0},
                                   {NULL, "nr", 0},
                                   {NULL, "x.ldt", 0},
                                   {NULL, "2020", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {"the length of the luminous area", "100", ALLOW(COMMA)},
                                   {"the width of the luminous area", "100", ALLOW(COMMA)},
                                   {"the height of the luminous area", "0", ALLOW(COMMA)},
                                   {"the height of the luminous area", "0", ALLOW(COMMA)},
                                   {"the height of the luminous area", "0", ALLOW(COMMA)},
                                   {"the height of the luminous area", "0", ALLOW(COMMA)},
                                   {"the downward flux fraction", "100", ALLOW(COMMA)},
                                   {"the light output ratio", "100", ALLOW(COMMA)},
                                   {"the conversion factor", "1", ALLOW(COMMA)},
                                   {"the tilt", "0", ANY_SIGN},
                                   {"the number of lamp sets", "1", 0},
                                   {"the number of lamps", "1", 0},
                                   {NULL, "LED", 0},
                                   {"the lamps' flux", "1000", ALLOW(COMMA)},
                                   {NULL, "3000", 0},
                                   {NULL, "80", 0},
                                   {NULL, "10", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {"the C-plane", "0", 0},
                                   {"the C-plane", "180", 0},
                                   {"the angle", "0", ALLOW(COMMA)},
                                   {"the angle", "30", ALLOW(COMMA)},
                                   {"the angle", "60", 0},
                                   {"the angle", "90", 0},
                                   {"an intensity", "300", ALLOW(COMMA)},
                                   {"an intensity", "200", ALLOW(COMMA)},
                                   {"an intensity", "100", ALLOW(COMMA)},
                                   {"an intensity", "0", ALLOW(COMMA)},
                                   {"an intensity", "300", ALLOW(COMMA)},
                                   {"an intensity", "200", ALLOW(COMMA)},
                                   {"an intensity", "100", ALLOW(COMMA)},
                                   {"an intensity", "0", ALLOW(COMMA)}};
enum { LDT_FIELDS = sizeof ldt_fields / sizeof *ldt_fields };

static char *ldt_text(int faulty, Fault fault, Arena *arena) {
    char *text = ARENA_NEW(arena, char, 2048);
    size_t at = 0;
    for (int i = 0; i < LDT_FIELDS; i++) {
        const char *value =
            i == faulty ? with_fault(&ldt_fields[i], fault, arena) : ldt_fields[i].value;
        if (value) at += (size_t)sprintf(text + at, "%s\n", value);
    }
    return text;
}

static bool has_doubt(const Luminaire *of, const char *words) {
    return lines_have(of->doubt, of->doubts, words);
}

ARENA_TEST(every_number_of_an_eulumdat_is_read_or_named) {
    for (int i = 0; i < LDT_FIELDS; i++)
        for (int fault = 0; fault < FAULTS && ldt_fields[i].name; fault++) {
            Arena scratch = arena;
            Luminaire out;
            const Field *field = &ldt_fields[i];
            bool is_read =
                read_luminaire(true, ldt_text(i, (Fault)fault, &scratch), &scratch, &out);
            if (fault != COMMA) check_refusal(is_read, field, (Fault)fault, why());
            else assert_true(is_read == ((field->allowed & ALLOW(COMMA)) != 0));
            if (fault == COMMA && is_read) assert_true(has_doubt(&out, "decimal comma of '1,5'"));
        }
    Luminaire out;
    assert_true(read_luminaire(true, ldt_text(-1, LEFT_OVER, &arena), &arena, &out));
    assert_int_equal(out.doubts, 0);
    char *text = ldt_text(-1, LEFT_OVER, &arena);
    assert_false(read_luminaire(true, arena_format(&arena, "%s\n7\n", text), &arena, &out));
    assert_error_has(why(), "'7' is left over behind the table of 2 x 4");
    assert_true(read_luminaire(true, arena_format(&arena, "%send\n", text), &arena, &out));
    assert_true(has_doubt(&out, "line 57: the text behind its table is left out ('end')"));
}

#define IES_LAMP(lumens, factors) "IESNA:LM-63-2002\nTILT=NONE\n1 " lumens " " factors

/* What can be read and cannot be: warned of, with what is assumed. */
ARENA_TEST(a_table_that_cannot_be_is_doubted) {
    static const struct {
        const char *text, *doubt;
    } cases[] = {
        {IES_LAMP("1000", "1 4 1 1 2 0 0 0\n1 1 9\n10 30 60 90\n0\n400 300 100 0\n"),
         "vertical angles begin at 10 degrees, required: 0 or 90: dark is assumed below, and "
         "so along its axis"},
        {IES_LAMP("1000", "1 3 1 1 2 0 0 0\n1 1 9\n0 30 60\n0\n400 300 100\n"),
         "vertical angles end at 60 degrees with 100 cd, required: 90 or 180"},
        {IES_LAMP("1000", "1 3 2 1 2 0 0 0\n1 1 9\n0 60 90\n0 90\n300 9 0\n200 9 0\n"),
         "planes have 200 to 300 cd at 0 degrees, which is one direction"},
        {IES_LAMP("1000", "1 3 2 1 2 0 0 0\n1 1 9\n0 90 180\n0 90\n3 1 3\n3 1 1\n"),
         "planes have 1 to 3 cd at 180 degrees"},
        {IES_LAMP("1000", "1 3 3 1 2 0 0 0\n1 1 9\n0 60 90\n0 180 360\n3 2 0\n3 2 0\n3 1 0\n"),
         "planes at 0 and 360 degrees are one, but have 2 and 1 cd at 60 degrees"},
        {IES_LAMP("1000", "1 3 4 1 2 0 0 0\n1 1 9\n0 60 90\n0 45 90 190\n"
                          "3 2 0 3 2 0 3 2 0 3 2 0\n"),
         "planes go from 0 to 190 degrees, required a whole turn"},
        {IES_LAMP("100", "1 3 1 1 2 0 0 0\n1 1 9\n0 90 180\n0\n100 100 100\n"),
         "add up to 1256.64 lm, 12.6 times the 100 lm that the file states"},
        {IES_LAMP("100", "2 3 1 1 2 0 0 0\n.5 1 9\n0 90 180\n0\n6 6 6\n"),
         "add up to 75.3982 lm, 1.51 times the 50 lm that the file states"},
        {IES_LAMP("1000", "1 3 3 3 2 0 0 0\n1 1 9\n-20 0 20\n-30 0 30\n1 2 1 2 9 2 1 2 1\n"),
         "angles go from V -20 to 20 and H -30 to 30 degrees, with up to 2 cd"},
        {IES_LAMP("1000", "1 3 1 1 2 0 0 0\n1 1 9\n0 60 90\n0\n3 2 0\n[END]\n"),
         "line 8: the text behind the table of 1 x 3 intensities is left out ('[END]')"}};
    static const char *const sound[] = {
        IES_LAMP("-1", "1 3 1 1 2 0 0 0\n1 1 9\n0 90 180\n0\n900 900 900\n"),
        IES_LAMP("100", "1 3 1 1 2 0 0 0\n1 1 9\n0 90 180\n0\n8.3 8.3 8.3\n"),
        IES_LAMP("9000", "1 3 2 1 2 0 0 0\n1 1 9\n0 60 90\n0 90\n300 9 0\n290 9 0\n"),
        IES_LAMP("9000", "1 3 4 1 2 0 0 0\n1 1 9\n0 60 90\n0, 90, 180, 270\n"
                         "300 9 0 300 9 0 300 9 0 300 9 0\n"),
        IES_LAMP("9000", "1 3 1 1 2 0 0 0\n1 1 9\n90 120 180\n0\n0 9 300\n")};
    Luminaire out;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (!read_luminaire(false, cases[i].text, &arena, &out)) fail_msg("%s", why()->text);
        if (!has_doubt(&out, cases[i].doubt))
            fail_msg("no \"%s\" but \"%s\"", cases[i].doubt, out.doubts ? out.doubt[0] : "");
    }
    for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) {
        if (!read_luminaire(false, sound[i], &arena, &out)) fail_msg("%s", why()->text);
        if (out.doubts) fail_msg("%zu: %s", i, out.doubt[0]);
    }
}

static const char *text_of_case(const char *name, Arena *arena) {
    FileBytes bytes;
    const char *path = arena_format(arena, "%s/cases/light/%s", SHARED_DATA_DIR, name);
    if (!file_exists(path)) skip();
    assert_done(file_read(path, 1 << 20, arena, &bytes, &err));
    return (const char *)bytes.data;
}

ARENA_TEST(the_cases_that_were_silent_are_told) {
    Luminaire out;
    assert_true(read_luminaire(false, text_of_case("06_plain.ies", &arena), &arena, &out));
    assert_false(read_luminaire(false, text_of_case("06_decimal_comma.ies", &arena), &arena, &out));
    assert_error_has(why(), "line 9 has '1000,5': if that is a decimal comma");
    assert_false(read_luminaire(true, text_of_case("06_negative.ldt", &arena), &arena, &out));
    assert_error_has(why(), "an intensity is '-300'");
    assert_true(
        read_luminaire(false, text_of_case("06_flux_above_lamps.ies", &arena), &arena, &out));
    assert_true(has_doubt(&out, "2404.72 lm, 24 times the 100 lm"));
    assert_true(
        read_luminaire(false, text_of_case("18_angles_10_to_90.ies", &arena), &arena, &out));
    assert_true(has_doubt(&out, "begin at 10 degrees"));
    Curve curve;
    assert_false(curve_parse(text_of_case("09_nir_only.csv", &arena), "09_nir_only.csv",
                             CURVE_SHARES, &curve, NULL, why()));
    assert_error_has(why(), "holds wavelengths from 820 to 2480 nm");
}

/* ---- weather ----------------------------------------------------------------------------- */

#define EMPTY_LIGHT (ALLOW(MISSING))

/* A decimal comma is a field too many, and so never in the field. */
static const Field epw_fields[] = {{"the year", "2001", 0},
                                   {"the month", "6", 0},
                                   {"the day", "21", 0},
                                   {"the hour", "11", 0},
                                   {"the minute", "60", 0},
                                   {NULL, "?9?9", 0},
                                   {NULL, "20", 0},
                                   {"the dew point", "10", ALLOW(NEGATIVE)},
                                   {NULL, "50", 0},
                                   {NULL, "101325", 0},
                                   {NULL, "0", 0},
                                   {NULL, "0", 0},
                                   {NULL, "300", 0},
                                   {"global irradiance", "812", EMPTY_LIGHT},
                                   {"direct normal irradiance", "855", EMPTY_LIGHT},
                                   {"diffuse irradiance", "92", EMPTY_LIGHT},
                                   {NULL, "0", 0},
                                   {"direct normal illuminance", "0", EMPTY_LIGHT},
                                   {"diffuse illuminance", "0", EMPTY_LIGHT},
                                   {NULL, "0", 0}};
static const Field location_fields[] = {{NULL, "LOCATION", 0},
                                        {NULL, "Here", 0},
                                        {NULL, "-", 0},
                                        {NULL, "X", 0},
                                        {NULL, "X", 0},
                                        {NULL, "1", 0},
                                        {"the latitude", "48", ALLOW(NEGATIVE)},
                                        {"the longitude", "11", ALLOW(NEGATIVE)},
                                        {"the zone", "1", ALLOW(NEGATIVE)},
                                        {"the elevation", "100", ALLOW(NEGATIVE)}};
enum {
    EPW_FIELDS = sizeof epw_fields / sizeof *epw_fields,
    LOCATION_FIELDS = sizeof location_fields / sizeof *location_fields
};

/* One line of commas; faulty -1: as it is right. A missing field is empty. */
static const char *comma_line(const Field *field, int count, int faulty, Fault fault,
                              Arena *arena) {
    char *line = ARENA_NEW(arena, char, 512);
    size_t at = 0;
    for (int i = 0; i < count; i++) {
        const char *value = i == faulty ? with_fault(&field[i], fault, arena) : field[i].value;
        at += (size_t)sprintf(line + at, "%s%s", i ? "," : "", value ? value : "");
    }
    return line;
}

static bool read_epw(const char *location, const char *row, Arena *arena, Weather *out) {
    const char *name = in_folder("x.epw");
    const char *plain = comma_line(epw_fields, EPW_FIELDS, -1, FAULTS, arena);
    write_text(name, arena_format(arena,
                                  "%s\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n%s\n"
                                  "%s\n",
                                  location, plain, row));
    *why() = (Error){0};
    bool ok = weather_read(name, arena, out, why());
    remove(name);
    return ok;
}

ARENA_TEST(every_number_of_a_weather_row_is_read_or_named) {
    Weather w;
    const char *place = comma_line(location_fields, LOCATION_FIELDS, -1, FAULTS, &arena);
    const char *plain = comma_line(epw_fields, EPW_FIELDS, -1, FAULTS, &arena);
    for (int fault = 0; fault < FAULTS; fault++) {
        for (int i = 0; i < EPW_FIELDS; i++) {
            Arena scratch = arena;
            if (!epw_fields[i].name) continue;
            const char *row = comma_line(epw_fields, EPW_FIELDS, i, (Fault)fault, &scratch);
            bool ok = read_epw(place, row, &scratch, &w);
            check_refusal(ok, &epw_fields[i], (Fault)fault, why());
            bool is_lightless = ok && fault == MISSING && (i == 14 || i == 15);
            if (is_lightless) assert_false(w.hour[1].has_light);
        }
        for (int i = 0; i < LOCATION_FIELDS; i++) {
            Arena scratch = arena;
            if (!location_fields[i].name) continue;
            const char *line =
                comma_line(location_fields, LOCATION_FIELDS, i, (Fault)fault, &scratch);
            bool ok = read_epw(line, plain, &scratch, &w);
            if (fault != COMMA) check_refusal(ok, &location_fields[i], (Fault)fault, why());
            else assert_true(!ok && strstr(why()->text, "11 fields"));
        }
    }
    const char *shorter = "2001,6,21,12,60,x,20,10,50,1,0,0,300,812,855,92";
    assert_false(read_epw(place, shorter, &arena, &w));
    assert_error_has(why(), "found '16 fields', required: the 20 of the rows before it");
    assert_true(read_epw("LOCATION,\"Here, West\",-,X,X,1,48,11,1,100", plain, &arena, &w));
    assert_string_equal(w.city, "Here, West");
    assert_near(w.place.longitude_deg, 11, 0);
    assert_false(read_epw("LOCATION,Here, West,-,X,X,1,48,11,1,100", plain, &arena, &w));
    assert_error_has(why(), "a name that holds a comma stands in quotes");
}

/* GHI = DHI + DNI sin(elevation), of one row; nines are missing. */
ARENA_TEST(a_row_that_does_not_add_up_is_doubted) {
    static const struct {
        const char *light;
        bool is_doubted, has_light;
    } cases[] = {{"812,855,92", false, true},   {"700,855,92", false, true},
                 {"812,85.5,92", true, true},   {"81.2,855,92", true, true},
                 {"812,855,920", true, true},   {"0,855,92", true, true},
                 {"9999,855,92", false, true},  {"999999,855,92", false, true},
                 {"812,9999,92", false, false}, {"812,855,999999", false, false},
                 {",855,92", false, true}};
    Weather w;
    const char *place = comma_line(location_fields, LOCATION_FIELDS, -1, FAULTS, &arena);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *row = arena_format(&arena,
                                       "2001,6,21,11,60,x,20,10,50,101325,0,0,300,%s,0,"
                                       "0,0,0",
                                       cases[i].light);
        assert_true(read_epw(place, row, &arena, &w));
        WeatherClock clock = weather_clock_find(&w, NULL, arena);
        const char *doubt = weather_clock_row_doubt(&w, &clock, &w.hour[1], &arena);
        assert_true(w.hour[1].has_light == cases[i].has_light);
        if (!doubt != !cases[i].is_doubted) fail_msg("%s: %s", cases[i].light, doubt);
    }
}

/* ---- spectra and levels ------------------------------------------------------------------ */

ARENA_TEST(every_number_of_a_spectrum_is_read_or_named) {
    static const Field fields[] = {{"wavelength", "500", 0}, {"value", "0.5", 0}};
    for (int f = 0; f < 2; f++)
        for (int fault = 0; fault < FAULTS; fault++) {
            Arena scratch = arena;
            Curve curve;
            const char *cell = with_fault(&fields[f], (Fault)fault, &scratch);
            const char *text = arena_format(&scratch, "nm;value\n400;0.5\n%s;%s\n700;0.5\n",
                                            f      ? "500"
                                            : cell ? cell
                                                   : "",
                                            f ? cell ? cell : "" : "0.5");
            bool ok = curve_parse(text, "x.csv", CURVE_SHARES, &curve, NULL, why());
            if (ok) fail_msg("%s: fault %d is read", fields[f].name, fault);
            assert_text_has(why()->path, "line");
            if (fault == COMMA) assert_error_has(why(), "a decimal comma?");
        }
}

/* Refused where 400 to 700 nm are not there; the share of V(lambda) (CIE 018) that is not
 * measured: 4e-5 below 380 nm, 0.0009 above 700 nm. Light may end in the dark. */
TEST(a_spectrum_reaches_what_is_seen_and_says_what_it_extrapolates) {
    static const struct {
        const char *text;
        bool is_read, is_light;
        double low, high;
    } cases[] = {{"380,.5\n780,.5\n", true, true, 0, 0},
                 {"360,.5\n830,.5\n", true, true, 0, 0},
                 {"380.4,.5\n779.6,.5\n", true, true, 0, 0},
                 {"400,.5\n700,.5\n", true, true, 0.0005, 0.003},
                 {"400.8,.5\n780,.5\n", true, true, 2e-6, 0.0005},
                 {"380,.5\n720,.5\n", true, true, 5e-5, 0.0005},
                 {"410,.5\n780,.5\n", false, false, 0, 0},
                 {"380,.5\n690,.5\n", false, false, 0, 0},
                 {"450,.5\n650,.5\n", false, false, 0, 0},
                 {"550,.5\n", false, false, 0, 0},
                 {"690,.5\n2480,.5\n", false, false, 0, 0},
                 {"820,.5\n2480,.5\n", false, false, 0, 0},
                 {"550,0\n600,1\n650,0\n", false, true, 0, 0},
                 {"550,.1\n600,1\n650,0\n", false, false, 0, 0},
                 {"400,.1\n600,1\n650,0\n", false, true, 2e-6, 0.0005}};
    Curve curve;
    CurveNotes notes;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int light = 0; light < 2; light++) {
            CurveRange range = light ? CURVE_AMOUNTS : CURVE_SHARES;
            bool ok = curve_parse(cases[i].text, "x.csv", range, &curve, &notes, why());
            if (ok != (light ? cases[i].is_light : cases[i].is_read))
                fail_msg("%s %d", cases[i].text, light);
            if (ok) assert_in(notes.beyond, cases[i].low, cases[i].high);
            else assert_error_has(why(), "required from 400 to 700 nm or beyond");
        }
    assert_false(
        curve_parse_index("410,1,2\n780,1,2\n", "x.csv", &curve, &(Curve){0}, NULL, why()));
    assert_error_has(why(), "from 410 to 780 nm, required from 400 to 700 nm or beyond");
    const char *um = "value of what\n.38,.5\n.78,.5\n";
    assert_false(curve_parse(um, "x.csv", CURVE_SHARES, &curve, NULL, why()));
    assert_error_has(why(), "in micrometres? Required are nm");
}

ARENA_TEST(every_number_of_a_level_table_is_read_or_named) {
    static const Field fields[] = {{"level", "128", 0}, {"white", "50", 0}};
    LevelTable table;
    for (int f = 0; f < 2; f++)
        for (int fault = 0; fault < FAULTS; fault++) {
            Arena scratch = arena;
            const char *name = in_folder("levels.csv");
            const char *cell = with_fault(&fields[f], (Fault)fault, &scratch);
            write_text(name, arena_format(&scratch, "level;white\n0;.1\n%s;%s\n255;200\n",
                                          f      ? "128"
                                          : cell ? cell
                                                 : "",
                                          f ? cell ? cell : "" : "50"));
            bool ok = level_table_read(name, 0, &scratch, &table, why());
            remove(name);
            if (ok) fail_msg("%s: fault %d is read", fields[f].name, fault);
            assert_text_has(why()->path, "line");
            if (fault == COMMA) assert_error_has(why(), "a decimal comma?");
        }
}

ARENA_TEST(primaries_hold_light_and_all_that_is_seen) {
    static const struct {
        const char *rows, *message;
    } cases[] = {
        {"380,0,0,0,0\n450,0,0,1,0\n550,0,1,-.01,0\n620,1,0,0,0\n700,0,0,0,0\n", NULL},
        {"380,0,0,0,0\n450,0,0,1,0\n550,0,1,-.5,0\n620,1,0,0,0\n700,0,0,0,0\n",
         "column 'blue' holds -0.5, required: 0 or more"},
        {"380,0,0,0,0\n450,0,0,1,0\n550,0,1,0,0\n620,1,0,0,0\n",
         "column 'red' goes from 380 to 620 nm and ends in light, required: 400 to 700 nm"}};
    static float spectrum[3][SPECTRAL_COUNT];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *name = in_folder("primaries.csv");
        write_text(name, arena_format(&arena, "nm,red,green,blue,black\n%s", cases[i].rows));
        double beyond = 0;
        bool ok = primary_spectra_read(name, &arena, spectrum, &beyond, why());
        remove(name);
        assert_true(ok == !cases[i].message);
        if (!ok) assert_error_has(why(), cases[i].message);
    }
}

TEST_PROGRAM(make_folder, remove_folder)

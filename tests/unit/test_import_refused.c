/* SPDX-License-Identifier: Apache-2.0 */
/* Text tables that are refused: the message says where, what was found and what to give. */
#include "lab_fixture.h"

static void refuse(Lab *lab, const char *text, const char *message) {
    lab_write(lab, "white.csv", text);
    lab_refused(lab, message);
}

typedef struct Refusal {
    const char *text, *message;
} Refusal;

#define REFUSE_ALL(lab, rows) \
    for (size_t i_ = 0; i_ < sizeof(rows) / sizeof *(rows); i_++) \
    refuse(lab, (rows)[i_].text, (rows)[i_].message)

LAB_TEST(cells_and_rows_that_do_not_fit) {
    static const Refusal rows[] = {
        {"theta,phi,X,Y,Z\n0,0,1,2,3\n10,0,1,abc,3\n",
         "white.csv: line 3: column 'Y' holds 'abc', required: a number or a mark of what was "
         "not measured (---, NaN, or one given as --mask)"},
        {"theta,phi,X,Y,Z\n0,0,1,2,3\n10,0,1,2\n",
         "white.csv: line 3: has 4 cells, required: 5 as the columns are"},
        {"theta,phi,X,Y,Z\n0,0,1,2,3\n10,0,1,2,3,4\n",
         "white.csv: line 3: has 6 cells, required: 5 as the columns are"},
        {"theta,phi,X,Y,Z\n0,0,1,2,3\n10,---,1,2,3\n20,0,1,2,3\n",
         "white.csv: line 3: has no angle, required: two numbers"},
        {"theta,phi,X,Y,Z\n0,0,1,2,3\nend\n10,0,1,2,3\n",
         "white.csv: line 4: holds numbers again behind the end of the table"},
        {"theta,phi,X,Y,Z\n0,0,1e999,2,3\n",
         "white.csv: line 2: column 'X' holds '1e999', required: a number or a mark of what "
         "was not measured (---, NaN, or one given as --mask)"},
        {"0,0,1,2,3\n10,0,1,2,3\n",
         "white.csv: line 1: begins numbers that no header names — name them with --columns "
         "theta,phi,..., or say --table theta-down or phi-down for a matrix"},
        {"theta,phi,X,Y,Z\n",
         "white.csv: has no row of numbers — say how they are written with --delimiter and "
         "--decimal, or name the file's --format"},
        {"theta,phi,X,Y,Z\n0,0,1,2,3\n190,0,1,2,3\n20,0,1,2,3\n",
         "white.csv: line 3: theta is 190, required: -90 to 90 degrees"},
        {"theta,phi,Y,x,y\n0,0,1,0.3,0.3\n10,0,1,0.7,0.5\n20,0,1,.3,.3\n",
         "white.csv: line 3: chromaticity is 0.7, 0.5, required: a point of the CIE diagram"},
        {"", "white.csv: is empty"},
        {"theta,phi,L\n0,0,1\n10,0,1\n",
         "white.csv: line 2: begins a table of 2 measured directions, required: an angular "
         "table of at least 3 — leave the file out (--role FILE=skip) if it is none"},
    };
    REFUSE_ALL(lab, rows);
}

LAB_TEST(headers_that_do_not_say_enough) {
    static const Refusal rows[] = {
        {"theta,phi,X,Y\n0,0,1,2\n10,0,1,2\n20,0,1,2\n",
         "white.csv: header line: has not what makes a colour: X, Y, Z; or luminance with x, "
         "y or u', v'; or luminance alone — name the columns with --columns"},
        {"theta,phi,CCT\n0,0,1\n10,0,1\n",
         "white.csv: header line: has no column of luminance or reflection — name them with "
         "--columns"},
        {"theta,phi,L,u,v\n0,0,1,.2,.3\n",
         "white.csv: line 1: column 'u' may be CIE 1960 or 1976 — name the columns with "
         "--columns, u' and v' for 1976"},
        {"theta,phi,phi_out,L\n0,0,0,1\n10,0,0,1\n",
         "white.csv: line 1: columns 'phi' and 'phi_out' name the same quantity — say which "
         "is which with --columns (- skips one)"},
        {"theta,phi,L,550nm\n0,0,0,1\n10,0,0,1\n",
         "white.csv: header line: has columns of luminance and of reflection, required: one "
         "kind — skip some with --columns"},
        {"theta_H,theta_V,L\n0,0,1\n10,0,1\n20,0,1\n",
         "white.csv: header line: has a horizontal and a vertical angle — say which with "
         "--angles projected, equidistant, north-polar or east-polar"},
        {"theta,phi,L\n0,0,1\n0.5,0,1\n1.5,3,1\n",
         "white.csv: has angles up to 1.5: radians, or a cone of so many degrees — say "
         "--angle-unit rad or deg"},
        {"theta,phi,X (nit),Y (fL),Z (fL)\n0,0,1,1,1\n10,0,1,1,1\n20,0,1,1,1\n",
         "white.csv: header line: has columns in cd/m2 and in fL, required: one unit"},
        {"R,G,B,theta,phi,L\n10,20,0,0,0,1\n10,20,0,10,0,1\n10,20,0,20,0,1\n",
         "white.csv: line 2: the codes 10, 20, 0 are a mixture, required: one primary at a "
         "time, black or white — leave the file out (--role FILE=skip) if it is no table of "
         "one pattern"},
    };
    REFUSE_ALL(lab, rows);
    lab->count = 0;
    lab_write(lab, "BRDF_20.csv", "theta,phi,brdf\n0,0,1\n10,0,1\n20,0,1\n");
    lab_refused(lab, "BRDF_20.csv: header line: does not say the wavelength of 'brdf' — say it "
                     "with --wavelength NM or --role FILE=brdf:INCIDENCE:AZIMUTH:NM");
}

LAB_TEST(matrices_that_do_not_say_enough) {
    static const Refusal rows[] = {
        {"L\n-\\-,0,30\n0,10,20\n60,10,30\n",
         "white.csv: line 2: does not tell whether theta runs down or across — say --table "
         "theta-down or phi-down"},
        {"theta\\phi,0,120\n0,10,20\n60,10,30\n",
         "white.csv: does not say what its matrix holds — say --quantity X, Y, Z, L or brdf, "
         "or the component in the role, as --role white.csv=red:255:X"},
        {"[X]\ntheta\\phi,0,120\n0,1,2\n\n[X]\ntheta\\phi,0,120\n0,1,2\n",
         "white.csv: line 6: begins a matrix of the same quantity (X) as line 2 — label "
         "each, as [X], [Y], [Z] or [550 nm]"},
        {"[X]\ntheta\\phi,0,120\n0,1,2\n30,1,2\n\n[Y]\ntheta\\phi,0,120\n0,1,2\n20,1,2\n",
         "white.csv: line 7: begins a matrix over other angles than the one of line 2, "
         "required: one grid in a file"},
        {"[L]\ntheta\\phi,0,120\n0,1,2\n30,1\n",
         "white.csv: line 4: has 2 cells, required: 3 as the head of the matrix"},
        {"[L]\ntheta\\phi,0,120\n0,1,2\n30,1,x\n",
         "white.csv: line 4: column 'matrix' holds 'x', required: a number or a mark of what "
         "was not measured (---, NaN, or one given as --mask)"},
    };
    REFUSE_ALL(lab, rows);
    lab_declare(lab, "table", "phi-down");
    refuse(lab, "[L]\ntheta\\phi,0,120\n0,1,2\n30,1,2\n",
           "white.csv: line 2: the corner 'theta\\phi' says that theta runs down, and --table "
           "says the other");
}

#define SAYS "Azimuth;0 = 12 o'clock; clockwise\nUnit;cd/m2\ntheta;phi;L\n0;0;1\n9;0;1\n8;0;1\n"

LAB_TEST(contradictions_of_file_and_user) {
    static const struct {
        const char *key, *value, *message;
    } cases[] = {
        {"azimuth_zero", "right",
         "white.csv: line 1: says where azimuth 0 points, and --azimuth-zero says otherwise"},
        {"azimuth_sense", "ccw",
         "white.csv: line 1: says how azimuths run, and --azimuth-sense says otherwise"},
        {"unit", "fL", "white.csv: line 2: says cd/m2, and --unit says otherwise"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lab->request->text = (TextOptions){.layout = LAYOUT_AUTO};
        lab_declare(lab, cases[i].key, cases[i].value);
        refuse(lab, SAYS, cases[i].message);
    }
    lab->request->text = (TextOptions){.layout = LAYOUT_AUTO};
    lab_declare(lab, "azimuth_zero", "top");
    lab_declare(lab, "azimuth_sense", "cw");
    lab_declare(lab, "unit", "nit");
    lab_write(lab, "white.csv", SAYS);
    lab_import(lab);
    lab_declare(lab, "angle_unit", "deg");
    refuse(lab, "theta_rad,phi_rad,L\n0,0,1\n1,0,1\n.5,0,1\n",
           "white.csv: header line: says the unit of its angles, and --angle-unit says "
           "otherwise");
}

LAB_TEST(declarations_that_are_wrong) {
    TextOptions *text = &lab->request->text;
    assert_false(text_options_set(text, "azimuth_zreo", "top", &lab->err));
    assert_non_null(strstr(lab->err.text, "'azimuth_zreo' is no key of a declaration — did you "
                                          "mean azimuth_zero? There are table, columns, "));
    assert_false(text_options_set(text, "azimuth_zero", "north", &lab->err));
    assert_string_equal(lab->err.text, "azimuth_zero is 'north', required: "
                                       "right|top|left|bottom|DEG");
    static const char *const wrong[][2] = {
        {"delimiter", "|"},     {"unit", "lux"},       {"table", ""},
        {"skip_lines", "-1"},   {"skip_lines", "1.5"}, {"level_max", "0"},
        {"quantity", "theta"},  {"quantity", "u"},     {"white_reflectance", "0"},
        {"encoding", "ebcdic"}, {"columns", ""},       {"light_azimuth", "x"},
        {"angles", "type C"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (text_options_set(text, wrong[i][0], wrong[i][1], &lab->err))
            fail_msg("%s = '%s' is taken", wrong[i][0], wrong[i][1]);
    lab->request->text = (TextOptions){.layout = LAYOUT_AUTO};
    lab_declare(lab, "columns", "theta,phi,X,Y,Q");
    refuse(lab, "0,0,1,2,3\n",
           "--columns: 'Q' is no name of a column, required: theta, phi, X, Y, Z, L, x, y, u', "
           "v', a wavelength, incidence, ... or -");
    lab_declare(lab, "columns", "X,Y,Z");
    refuse(lab, "0,0,1,2,3\n",
           "--columns 'X,Y,Z' has no two angles, required: theta and phi, "
           "or horizontal and vertical");
}

/* ---- nothing crashes --------------------------------------------------------------------- */

static const char *const samples[] = {
    "\xEF\xBB\xBF# azimuth 0: top, cw\r\ntheta;phi;X;Y;Z\r\n0;0;1,5;2,5;3,5\r\n10;0;---;2;3\r\n"
    "10;90;1;2;3\r\n20;0;1;2;3\r\n",
    "[Conoscope]\nSample;white\nUnit;cd/m\xB2\n\n[Y]\nIncl\\Azim;0;90;180;270\n0;1;1;1;1\n"
    "10;2;2;---;2\n\n[X]\nIncl\\Azim;0;90;180;270\n0;1;1;1;1\n10;2;2;---;2\n\n[Z]\n"
    "Incl\\Azim;0;90;180;270\n0;1;1;1;1\n10;2;2;---;2\n",
    "R,G,B,theta,phi,Y,x,y\n255,255,255,0,0,1,.3,.3\n255,255,255,9,0,1,.3,.3\n"
    "255,255,255,8,0,1,.3,.3\n"};
#define SAMPLES (sizeof samples / sizeof *samples)

/* A sample's bytes; behind the last one its UTF-16 twin. Returns the size. */
static size_t sample_bytes(size_t index, char bytes[1024]) {
    const char *text = samples[index < SAMPLES ? index : SAMPLES - 1];
    size_t size = strlen(text);
    if (index < SAMPLES) {
        memcpy(bytes, text, size);
        return size;
    }
    for (size_t i = 0; i < size; i++) {
        bytes[2 * i] = text[i];
        bytes[2 * i + 1] = 0;
    }
    return 2 * size;
}

static void run_quietly(Lab *lab, const void *bytes, size_t size) {
    Arena before = lab->arena;
    lab_write_bytes(lab, "white.csv", bytes, size);
    if (!lab_run(lab)) {
        assert_true(lab->err.code == ERROR_INPUT || lab->err.code == ERROR_USAGE);
        assert_true(lab->err.text[0] != 0);
    } else {
        assert_true(lab->set.count > 0);
    }
    lab->arena = before;
}

LAB_TEST(every_prefix_is_refused_or_valid) {
    lab_write(lab, "white.csv", "");
    for (size_t s = 0; s <= SAMPLES; s++) {
        char bytes[1024];
        size_t size = sample_bytes(s, bytes);
        for (size_t n = 0; n <= size; n++) run_quietly(lab, bytes, n);
    }
}

LAB_TEST(no_changed_byte_crashes) {
    char bytes[1024];
    uint32_t random = 1;
    lab_write(lab, "white.csv", "");
    for (int i = 0; i < 1200; i++) {
        size_t size = sample_bytes((size_t)i % (SAMPLES + 1), bytes);
        for (int k = 0; k < 1 + i % 3; k++) {
            random = random * 1664525u + 1013904223u;
            static const char common[] = ";,.-0e\n\r\t \"[]\xFF";
            char to =
                random & 1 ? common[(random >> 4) % (sizeof common - 1)] : (char)(random >> 24);
            bytes[(random >> 8) % size] = to;
        }
        run_quietly(lab, bytes, size);
    }
}

LAB_TEST(hostile_sizes_are_bounded) {
    char *wide = ARENA_NEW(&lab->arena, char, 20000);
    memset(wide, ',', 19998);
    lab_write(lab, "white.csv", "");
    run_quietly(lab, wide, 19998);
    memset(wide, '\n', 19998);
    run_quietly(lab, wide, 19998);
    memset(wide, '9', 19998);
    run_quietly(lab, wide, 19998);
    memset(wide, '"', 19998);
    run_quietly(lab, wide, 19998);
    size_t at = (size_t)sprintf(wide, "theta,phi");
    for (int i = 0; i < 3000; i++) at += (size_t)sprintf(wide + at, ",%d", 400 + i % 10);
    run_quietly(lab, wide, at);
}

/* Light beyond the last angle of a set is left out, but never all of it. */
LAB_TEST(light_that_only_grazes) {
    lab_write(lab, "i89.5.csv", "theta,phi,450nm\n0,0,0.1\n20,90,0.1\n20,270,0.1\n");
    lab_refused(lab, "i89.5.csv: has light from 89.5 degrees and no file from less, required: "
                     "one of 0 to 89 degrees");
}

TEST_PROGRAM(NULL, NULL)

/* SPDX-License-Identifier: Apache-2.0 */
/* `panel import` as it is typed: options, the declaration file under them, the answer. */
#include "lab_fixture.h"

#include <fcntl.h>
#include <jansson.h>

#include "base/count.h"
#include "base/units.h"
#include "cli/panel/panel_commands.h"

#define TABLE "theta;phi;L\n0;0;1,5\n30;0;2,5\n30;90;3,5\n40;0;-999\n"

/* Runs the command with words; "@NAME" is a file in the laboratory's folder. What it prints on
 * stdout comes back. */
static bool run(Lab *lab, const char *const *words, const char **printed) {
    char *argv[32] = {(char *)(uintptr_t)"import"};
    int argc = 1;
    const char *path = arena_format(&lab->arena, "%s/printed", lab->folder);
    for (; words[argc - 1]; argc++) {
        const char *word = words[argc - 1];
        argv[argc] = *word == '@' ? arena_format(&lab->arena, "%s/%s", lab->folder, word + 1)
                                  : arena_string(&lab->arena, word, strlen(word));
    }
    fflush(stdout);
    int saved = dup(STDOUT_FILENO), file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    lab->err = (Error){.code = ERROR_NONE};
    bool ok = command_panel_import.run(argc, argv, &lab->arena, &lab->err);
    fflush(stdout);
    dup2(saved, STDOUT_FILENO);
    close(saved);
    close(file);
    FileBytes bytes;
    Error ignored;
    assert_true(file_read(path, 1 << 20, &lab->arena, &bytes, &ignored));
    *printed = (const char *)bytes.data;
    return ok;
}

#define RUN(lab, printed, ...) \
    run((lab), (const char *const[]){__VA_ARGS__, "--quiet", NULL}, (printed))

static const Measurement *read_set(Lab *lab) {
    Measurement *set = ARENA_NEW(&lab->arena, Measurement, 1);
    const char *manifest = arena_format(&lab->arena, "%s/out/M.json", lab->folder);
    if (!measurement_read(manifest, &lab->arena, set, &lab->err)) fail_msg("%s", lab->err.text);
    return set;
}

LAB_TEST(options_reach_the_files) {
    const char *printed;
    lab_write(lab, "m1.txt", TABLE);
    if (!RUN(lab, &printed, "@m1.txt", "--role", "m1*=white", "--azimuth-zero", "top",
             "--azimuth-sense=cw", "--mask", "-999", "--unit", "fL", "--panel", "P 7",
             "--instrument", "C 88", "--date", "2026-03-14", "--operator", "A. Name",
             "--conditions", "23 C", "-o", "@out/M.json"))
        fail_msg("%s", lab->err.text);
    const Measurement *set = read_set(lab);
    assert_string_equal(set->panel, "P 7");
    assert_string_equal(set->instrument, "C 88");
    assert_string_equal(set->date, "2026-03-14");
    assert_string_equal(set->operator_name, "A. Name");
    assert_string_equal(set->conditions, "23 C");
    assert_null(strstr(printed, "not stated"));
    assert_true(set->is_white_only);
    const AngleTable *table = &set->primary[1].table[0];
    assert_int_equal(table->rows, 3);
    assert_near(table->phi[1], 0, 0); /* 90 clockwise from the top is right */
    assert_near(table->phi[2], (float)radians_from_degrees(90), 0);
}

LAB_TEST(the_command_line_stands_above_the_declaration) {
    const char *printed;
    lab_write(lab, "m1.txt", TABLE);
    lab_write(lab, "d.json",
              "{\"mask\": [-999], \"unit\": \"fL\","
              " \"roles\": {\"*\": \"black\"}}");
    assert_true(RUN(lab, &printed, "--layout", "@d.json", "--unit", "nit", "--role", "m1*=white",
                    "@m1.txt", "-o", "@out/M.json"));
    double sum = 0;
    const Measurement *set = read_set(lab);
    for (int p = 0; p < 3; p++) sum += (double)set->primary[p].table[0].value[1];
    assert_close(sum, 1.5, 1e-5);
}

LAB_TEST(the_answer_is_one_json_document) {
    const char *printed;
    json_error_t error;
    lab_write(lab, "white.txt", TABLE);
    assert_true(RUN(lab, &printed, "@white.txt", "--mask=-999", "--json", "-o", "@out/M.json"));
    json_auto_t *answer = json_loads(printed, 0, &error);
    assert_non_null(answer);
    json_t *table = json_array_get(json_object_get(answer, "tables"), 0);
    assert_int_equal(json_integer_value(json_object_get(table, "rows")), 3);
    assert_int_equal(json_integer_value(json_object_get(table, "masked")), 1);
    json_t *hole = json_array_get(json_object_get(table, "not_measured"), 0);
    assert_near(json_number_value(json_array_get(hole, 0)), 40, 0);
    assert_near(json_number_value(json_object_get(answer, "rows")), 3, 0);
    assert_near(json_number_value(json_object_get(answer, "masked")), 1, 0);
    assert_int_equal(json_array_size(json_object_get(answer, "not_stated")), 4);
    assert_true(json_array_size(json_object_get(answer, "notes")) >= 3);
}

LAB_TEST(mistakes_have_their_status) {
    const char *printed;
    lab_write(lab, "white.txt", TABLE);
    lab_write(lab, "out", "a file");
    static const struct {
        const char *word;
        ErrorCode code;
        const char *text;
    } cases[] = {{"--role=white.txt", ERROR_USAGE, "--role"},
                 {"--role=a=rot", ERROR_USAGE, "the role 'rot' is unknown"},
                 {"--azimuth-zero=north", ERROR_USAGE, "azimuth_zero is 'north'"},
                 {"--symmetry=all", ERROR_USAGE, "symmetry is 'all'"},
                 {"--format=bsdf", ERROR_USAGE, "--format 'bsdf' is unknown"},
                 {"--section=40", ERROR_USAGE, "section is '40', required: PATTERN=DEG"},
                 {"--mask=-999", ERROR_OUTPUT, "cannot be"},
                 {"--layout=/absent.json", ERROR_INPUT, ""}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_false(RUN(lab, &printed, "@white.txt", cases[i].word, "-o", "@out/M.json"));
        if (lab->err.code != cases[i].code || !strstr(lab->err.text, cases[i].text))
            fail_msg("%s: %d, %s", cases[i].word, (int)lab->err.code, lab->err.text);
        assert_string_equal(printed, "");
    }
    assert_false(RUN(lab, &printed, "@white.txt"));
    assert_string_equal(lab->err.text, "panel import wants -o MANIFEST.json");
    assert_true(RUN(lab, &printed, "--help"));
    assert_non_null(strstr(printed, "--azimuth-zero right|top|left|bottom|DEG"));
    assert_non_null(strstr(printed, "eulumdat"));
}

TEST_PROGRAM(NULL, NULL)

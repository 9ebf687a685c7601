/* SPDX-License-Identifier: Apache-2.0 */
/* What importers of scatter say of text that they refuse: a row a message. */
#include "base/count.h"
#include "import_fixture.h"

typedef struct Refusal {
    const char *text;
    const char *words; /* of the message, its place included */
} Refusal;

static void check_refusals(Fixture *f, const Importer *importer, const Refusal *row, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char line[2048];
        Arena before = f->arena;
        fixture_write(f, row[i].text, strlen(row[i].text));
        f->set = import_set(&f->arena);
        f->err = (Error){.code = ERROR_NONE};
        if (importer->read(f->file, &f->options, &f->set, &f->err))
            fail_msg("%s took: %s", importer->name, row[i].text);
        error_line(&f->err, line, sizeof line);
        if (!strstr(line, row[i].words)) fail_msg("%s\n  wanted: %s", line, row[i].words);
        f->arena = before;
    }
}

#define CHECK(importer, rows) check_refusals(f, &importer, rows, sizeof rows / sizeof *rows)

#define ZEMAX \
    "Symmetry Asymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n" \
    "SampleRotation 1\n0\nAngleOfIncidence 1\n30\nScatterAzimuth 1\n0\nScatterRadial 1\n10\n" \
    "Monochrome\nDataBegin\n"

FIXTURE_TEST(zemax_refusals) {
    static const Refusal rows[] = {
        {"SpectralContent RGB", "line 1: SpectralContent is 'RGB', required: Monochrome or "
                                "XYZ"},
        {"ScatterType BSSRDF", "line 1: ScatterType is 'BSSRDF', required: BRDF"},
        {"Source", "line 1: the file ends after Source"},
        {"Symmetry Asymmetrical\n", "line 1: the file ends in its header, required: DataBegin"},
        {"Colour red\n", "line 1: 'Colour' is no entry of this format's header"},
        {"SampleRotation 0\n", "line 1: SampleRotation is 0, required: a whole number from 1 "
                               "to"},
        {"SampleRotation 1.5\n", "SampleRotation is 1.5, required: a whole number from 1 to"},
        {"Symmetry Asymmetrical\nMonochrome\n", "line 1: the header has no SpectralContent"},
        {"Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nSampleRotation 1\n0\n"
         "AngleOfIncidence 1\n90\nScatterAzimuth 1\n0\nScatterRadial 1\n0\nDataBegin\n",
         "AngleOfIncidence is 90, required: 0 to 89.999 degrees"},
        {"Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nSampleRotation 1\n0\n"
         "AngleOfIncidence 1\n0\nScatterAzimuth 1\n190\nScatterRadial 1\n0\nDataBegin\n",
         "ScatterAzimuth is 190, required: 0 to 180 degrees"},
        {"Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nSampleRotation 1\n0\n"
         "AngleOfIncidence 1\n0\nScatterAzimuth 1\n0\nScatterRadial 2\n5 5\nDataBegin\n",
         "ScatterRadial 5 follows 5, required: rising angles"},
        {"Symmetry Asymmetrical\nSpectralContent Monochrome\nSampleRotation 1\n0\n"
         "AngleOfIncidence 1\n0\nScatterAzimuth 5\n0 1 2 3 4\nScatterRadial 5\n0 1 2 3 4\n"
         "DataBegin\n",
         "the header announces 25 values, more than the file can hold"},
        {ZEMAX "TIS 0 1\nTIS 0 1\nDataEnd\n", "this TIS is one block too many, required: 1"},
        {ZEMAX "TOS 0 1\nDataEnd\n", "line 14: 'TOS' stands where TIS or DataEnd is required"},
        {ZEMAX "TIS 0 1\n", "the file ends without DataEnd"},
        {ZEMAX "TIS 0 nan\nDataEnd\n", "a value of the block is 'nan', required: a number"},
    };
    CHECK(importer_zemax, rows);
}

FIXTURE_TEST(astm_refusals) {
    static const Refusal rows[] = {
        {"VARS theta_i,theta_s\n", "VARS names no column of values"},
        {"NUM_POINTS none\n", "NUM_POINTS is ' none', required: 1 to"},
        {"LAB_NAME x\n", "the file ends in its header, required: VARS and rows"},
        {"VARS theta_i,theta_s,brdf\n", "the file ends before its first row"},
        {"VARS theta_i,theta_s,brdf\n1,2,3,4,5,6,7,8,9\n", "a line has more than 3 numbers"},
        {"VARS theta_i,theta_s,brdf\n10,200,3\n",
         "row 1 has an angle of 200, required: at most 180 degrees"},
        {"VARS theta_i,theta_s,brdf\n100,20,3\n",
         "row 1 has an angle of 100, required: at most 90 degrees"},
        {"VARS theta_i,theta_s,brdf\n90,20,3\n", "the angle of incidence is 90, required: 0 "
                                                 "to"},
    };
    CHECK(importer_astm, rows);
}

#define SPEOS "OPTIS - Anisotropic BSDF surface file v8.0\n0\nC\n"
#define SPEOS_LIGHT SPEOS "0\n\n0 1 0\n1 0\n1\n1\n0\n1\n30\n30 0\n\n"
#define SPEOS_ZERO "2 2\n0 180\n0 0 0\n80 0 0\n"
#define SPEOS_ONE "2 2\n0 180\n0 1 1\n80 1 1\n"

FIXTURE_TEST(speos_refusals) {
    static const Refusal rows[] = {
        {"nothing\n", "the first line is 'nothing', required: OPTIS - ..."},
        {"OPTIS - Anisotropic BSDF surface file v8.0\n2\n", "the mode is 2, required: 0 or 1"},
        {SPEOS "900\n", "the length of the description is 900, more than the rest of the file"},
        {SPEOS_LIGHT "1\n500 50\n" SPEOS_ZERO, "the table at incidence 30 integrates to 0"},
        {SPEOS_LIGHT "2\n500 50\n400 50\n" SPEOS_ONE, "the spectrum has 400 nm, required: "
                                                      "rising"},
        {SPEOS_LIGHT "1\n500 -5\n" SPEOS_ONE, "the spectrum is -5% at 500 nm, required: 0 or"},
        {SPEOS_LIGHT "2\n900 5\n950 5\n" SPEOS_ONE, "required: some of 360 to 830 nm"},
        {SPEOS_LIGHT "1\n500 50\n" SPEOS_ONE "more\n", "'more' follows the last table"},
        {SPEOS_LIGHT "1\n500 50\n9 9\n0 1 2 3 4 5 6 7 8\n0 1 1 1\n",
         "a table of 9 thetas x 9 phis is more than the rest of the file can hold"},
        {"OPTIS - BRDF surface file v8.0\n0\nC\n0\n\n1 0\n1\n1 1\n30\n500\n50\n" SPEOS_ZERO,
         "the table at incidence 30 and 500 nm integrates to 0, required: above 0"},
        {"OPTIS - Simple scattering surface file v2.0\nC\nVolume\n",
         "the surface's kind is 'Volume', required: Reflection"},
        {"OPTIS - Anisotropic BSDF surface file v8.0\n1", "is binary and not of version 9.0"},
    };
    CHECK(importer_speos, rows);
}

/* ---- formats of before ------------------------------------------------------------------- */

FIXTURE_TEST(a_file_of_a_removed_format_is_named) {
    static const Refusal rows[] = {
        {"type bsdf_data\nformat angles=deg\n30 0\n0 0 1\n", "is of FRED's format"},
        {"!!sample\n!!BSDF Data\n20 90\n20 90 7\n", "is of FRED's format"},
        {"# a\nSpectralContent Monochrome\nScatterAzimuth 1\n0\n", "is of LightTools's format"},
        {"#sample_name \"pane\"\n#format: theta phi DSF\n", "is of Mountain's format"},
        {"#incident_angle 30 90\n30 270 0.5\n", "is of Mountain's format"},
        {"VERSION 0.2\n\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\n", "is of SSDD's format"},
        {"<?xml version='1.0'?><WindowElement/>\n", "is of WINDOW's format"},
        {"tensor_file", "is of KAIST's format, which is no longer read — export it as text"},
    };
    for (int i = 0; i < COUNT_OF(rows); i++) {
        char line[2048];
        fixture_write(f, rows[i].text, strlen(rows[i].text));
        assert_false(import_file(f->file, &f->options, &f->set, &f->err));
        error_line(&f->err, line, sizeof line);
        if (!strstr(line, rows[i].words)) fail_msg("%s\n  wanted: %s", line, rows[i].words);
    }
}

TEST_PROGRAM(NULL, NULL)

/* SPDX-License-Identifier: Apache-2.0 */
/* What importers of scatter say of text that they refuse: a row a message. */
#include "import_fixture.h"

typedef struct Refusal {
    const char *text;
    const char *words; /* of the message, its place included */
} Refusal;

static void check_refusals(Fixture *f, const Importer *importer, const Refusal *row,
                           size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char  line[2048];
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

#define ZEMAX                                                                                  \
    "Symmetry Asymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"                    \
    "SampleRotation 1\n0\nAngleOfIncidence 1\n30\nScatterAzimuth 1\n0\nScatterRadial 1\n10\n"  \
    "Monochrome\nDataBegin\n"

FIXTURE_TEST(zemax_refusals)
{
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
         "DataBegin\n", "the header announces 25 values, more than the file can hold"},
        {ZEMAX "TIS 0 1\nTIS 0 1\nDataEnd\n", "this TIS is one block too many, required: 1"},
        {ZEMAX "TOS 0 1\nDataEnd\n", "line 14: 'TOS' stands where TIS or DataEnd is required"},
        {ZEMAX "TIS 0 1\n", "the file ends without DataEnd"},
        {ZEMAX "TIS 0 nan\nDataEnd\n", "a value of the block is 'nan', required: a number"},
    };
    CHECK(importer_zemax, rows);
}

#define LIGHTTOOLS                                                                             \
    "SpectralContent Monochrome\nScatterAzimuth 1\n0\nScatterRadial 1\n0\nDataBegin\n"

FIXTURE_TEST(lighttools_refusals)
{
    static const Refusal rows[] = {
        {"SpectralContent RGB", "SpectralContent is 'RGB', required: Monochrome or XYZ"},
        {"Symmetry Round", "Symmetry is 'Round', required: Asymmetric"},
        {"Source Measured\n", "the file ends in its header, required: DataBegin"},
        {"DataBegin\n", "the header has no SpectralContent"},
        {LIGHTTOOLS "AOI 95\nTIS 0\n1\nDataEnd\n", "AOI is 95, required: 0 to below 90 "
        "degrees"},
        {LIGHTTOOLS "Side Top\n", "Side is 'Top', required: Front or Back"},
        {LIGHTTOOLS "ScatterType BXDF\n", "ScatterType is 'BXDF', required: BRDF or BTDF"},
        {LIGHTTOOLS "TristimulusValue TrisW\n",
         "TristimulusValue is 'TrisW', required: TrisX, TrisY or TrisZ"},
        {"SpectralContent Monochrome\nScatterAzimuth 4\n0 1 2 3\nScatterRadial 4\n0 1 2 3\n"
         "DataBegin\nAOI 3\n", "the header announces 16 values a block, more than the"},
    };
    CHECK(importer_lighttools, rows);
}

FIXTURE_TEST(fred_refusals)
{
    static const Refusal rows[] = {
        {"type bsdf_data\nformat scale=0\n", "line 2: scale is '0', required: a number above "
        "0"},
        {"type psd_data\n", "'type psd_data' stands where 'type bsdf_data' is required"},
        {"type bsdf_data\n", "the file ends before the two angles of the light"},
        {"type bsdf_data\n30 400\n", "phi is 400, required: -360 to 360 degrees"},
        {"type bsdf_data\n30 0\n200 0 1\n", "line 3: theta is 200, required: -90 to 90 "
        "degrees"},
        {"type bsdf_data\n30 0\n20 -400 1\n", "phi is -400, required: -360 to 360 degrees"},
        {"type bsdf_data\n30 0\n20 0 inf\n", "'20 0 inf' is no row"},
    };
    CHECK(importer_fred, rows);
}

FIXTURE_TEST(mountain_refusals)
{
    static const Refusal rows[] = {
        {"#intheta steep\n", "line 1: intheta is ' steep', required: degrees"},
        {"#format: theta phi BTDF\n",
         "the format is BTDF: transmission, and a display panel is opaque"},
        {"#format: phi theta BSDF\n",
         "the format is ' phi theta BSDF', required: theta phi BSDF or DSF"},
        {"#colorimetry: RGB\n", "the colorimetry is 'RGB', required: CIE-Y or CIE-XYZ"},
        {"#incident_angle 30\n", "incident_angle is ' 30', required: theta and phi"},
        {"#format: theta phi BSDF\n#incident_angle -5 0\n1 2 3\n",
         "the light comes from (-5, 0), required: theta 0 to 90 and phi -360 to 360 degrees"},
        {"#format: theta phi BSDF\n#incident_angle 5 0\n1 400 3\n",
         "the direction is (1, 400), required: theta 0 to 180 and phi -360 to 360 degrees"},
        {"#format: theta phi BSDF\n#incident_angle 5 0\n1 2 3 1 2 3 1 2 3\n",
         "there is more than one row a line"},
        {"#format: theta phi BSDF\n#incident_angle 5 0\n1 2 3",
         "the last line has no line end: the file may be cut"},
    };
    CHECK(importer_mountain, rows);
}

FIXTURE_TEST(astm_refusals)
{
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

#define SSDD "VERSION 0.2\nDATA_TYPE brdf\nCOLOR_MODEL monochrome\n"
#define SSDD_GRID                                                                              \
    SSDD "PARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 0\nPARAM2_LIST 0\nPARAM3_LIST 0\n"

FIXTURE_TEST(ssdd_refusals)
{
    static const Refusal rows[] = {
        {"VERSION 0.2\nDATA_TYPE bssrdf\n", "DATA_TYPE 'bssrdf' is not known here"},
        {"VERSION 0.2\nDATA_TYPE brdf\nCOLOR_MODEL lab\n", "COLOR_MODEL is 'lab', required:"},
        {SSDD "PARAM_TYPE polar\n", "PARAM_TYPE 'polar' is not known here"},
        {SSDD "REDUCTION_TYPE isotropy\n", "REDUCTION_TYPE 'isotropy' is not known here"},
        {SSDD "PARAM0_LIST 0 ten\n", "PARAM0_LIST has 'ten', required: numbers"},
        {SSDD "PARAM0_LIST #\n", "PARAM0_LIST is empty"},
        {SSDD "PARAM4_LIST 1\n", "PARAM4_LIST (offsets of the mirror direction) is not known"},
        {"VERSION 0.2\nDATA_TYPE brdf\nDATA ascii\n", "the block has no COLOR_MODEL"},
        {"VERSION 0.2\nDATA_TYPE brdf\nCOLOR_MODEL spectrum\nDATA ascii\n",
         "the block has no WAVELENGTH_LIST"},
        {SSDD "DATA ascii\n", "the block has no PARAM_TYPE"},
        {SSDD "PARAM_TYPE specular_coordinate_system\nPARAM0_LIST 0\nDATA ascii\n",
         "the block has no PARAM2_LIST"},
        {SSDD_GRID "DATA hex\n", "DATA is 'hex', required: ascii or binary"},
        {SSDD_GRID "DATA binary\nab", "more than the rest of the file can hold"},
        {SSDD_GRID "DATA binary\nabc", "the file ends inside its table"},
        {SSDD_GRID "DATA binary\n\xff\xff\xff\x7f", "number 1 of the table is not finite"},
        {SSDD_GRID "DATA ascii\n1", "the last line has no line end: the file may be cut"},
        {SSDD "PARAM_TYPE spherical_coordinate_system\nPARAM0_LIST 95\nPARAM2_LIST 0\n"
         "PARAM3_LIST 0\nDATA ascii\n1\n", "PARAM0_LIST is 95, required: 0 to 90 degrees"},
    };
    CHECK(importer_ssdd, rows);
}

#define SPEOS "OPTIS - Anisotropic BSDF surface file v8.0\n0\nC\n"
#define SPEOS_LIGHT SPEOS "0\n\n0 1 0\n1 0\n1\n1\n0\n1\n30\n30 0\n\n"
#define SPEOS_ZERO "2 2\n0 180\n0 0 0\n80 0 0\n"
#define SPEOS_ONE "2 2\n0 180\n0 1 1\n80 1 1\n"

FIXTURE_TEST(speos_refusals)
{
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

#define XML_BEGIN "<WindowElement><Optical><Layer><DataDefinition>"
#define XML_BLOCK                                                                              \
    "</DataDefinition><WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>"   \
    "<WavelengthDataDirection>Reflection Front</WavelengthDataDirection>"
#define XML_END "</WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>"
#define XML_COLUMNS "<IncidentDataStructure>Columns</IncidentDataStructure>"
#define XML_TREE "<IncidentDataStructure>TensorTree3</IncidentDataStructure>"
#define XML_SQUARE "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>"
#define XML_BASIS(low, high, pieces)                                                           \
    "<AngleBasis><AngleBasisName>a</AngleBasisName><AngleBasisBlock>" pieces "<ThetaBounds>"   \
    low high "</ThetaBounds></AngleBasisBlock></AngleBasis>"
#define XML_DATA(text) "<ScatteringData>" text "</ScatteringData>"

FIXTURE_TEST(xml_refusals)
{
    static const Refusal rows[] = {
        {"<Window/>", "the document is not of this kind, required: WindowElement / Optical"},
        {"<WindowElement><Optical><Layer><WavelengthData><Wavelength>NIR</Wavelength>"
         "<WavelengthDataBlock><WavelengthDataDirection>Reflection Front"
         "</WavelengthDataDirection>" XML_END, "there is no reflection at Visible"},
        {XML_BEGIN XML_TREE XML_BLOCK XML_END, "the block has no ScatteringData, required:"},
        {XML_BEGIN XML_TREE XML_BLOCK XML_DATA("{1}") XML_END,
         "AngleBasis is '', required: LBNL/Shirley-Chiu for a tensor tree"},
        {XML_BEGIN XML_TREE XML_BLOCK XML_SQUARE XML_DATA("{1 2") XML_END,
         "the text ends inside the tensor tree, required: '}'"},
        {XML_BEGIN XML_TREE XML_BLOCK XML_SQUARE XML_DATA("{1}{2}") XML_END,
         "more text follows the tensor tree"},
        {XML_BEGIN XML_TREE XML_BLOCK XML_SQUARE XML_DATA("{{{{{{{{{{{{{{{{{1}") XML_END,
         "the tensor tree is deeper than 14"},
        {XML_BEGIN XML_TREE XML_BLOCK XML_SQUARE XML_DATA("{one}") XML_END,
         "a number of the tensor tree is 'one', required: a number"},
        {XML_BEGIN XML_COLUMNS XML_BASIS("", "", "") XML_BLOCK XML_DATA("1") XML_END,
         "an AngleBasisBlock lacks a number"},
        {XML_BEGIN XML_COLUMNS XML_BASIS("<LowerTheta>5</LowerTheta>",
                                         "<UpperTheta>90</UpperTheta>", "<nPhis>1</nPhis>")
         XML_BLOCK XML_DATA("1") XML_END, "the theta bounds do not follow each other"},
        {XML_BEGIN XML_COLUMNS XML_BASIS("<LowerTheta>0</LowerTheta>",
                                         "<UpperTheta>90</UpperTheta>", "<nPhis>0</nPhis>")
         XML_BLOCK XML_DATA("1") XML_END, "nPhis is out of range, required: 1 to 4096"},
        {XML_BEGIN XML_COLUMNS XML_BASIS("<LowerTheta>0</LowerTheta>",
                                         "<UpperTheta>90</UpperTheta>", "<nPhis>1</nPhis>")
         XML_BLOCK "<ColumnAngleBasis>a</ColumnAngleBasis><RowAngleBasis>a</RowAngleBasis>"
         XML_DATA("1 2") XML_END, "more numbers than 1 x 1 follow"},
    };
    CHECK(importer_window, rows);
    assert_false(fixture_read(f, "<WindowElement\0/>", 17, "window"));
    assert_string_equal(f->err.text, "has zero bytes (at byte 14), required: UTF-8");
}

TEST_PROGRAM(NULL, NULL)

/* SPDX-License-Identifier: Apache-2.0 */
/* Scatter as XML: Klems matrices and tensor trees of WINDOW and Radiance. */
#include "import_fixture.h"

#define PI 3.14159265358979323846
#define QUARTER 41 /* patches of the quarter basis: latitudes of 1, 8, 12, 12, 8 */

/* A document of one block. `bases` and `data` are elements' contents. */
static char *document(Arena *arena, const char *structure, const char *side, const char *bases,
                      const char *data)
{
    return arena_format(
        arena,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<WindowElement>\n<Optical>\n<Layer>\n"
        "<Material><Name>pane</Name></Material>\n"
        "<DataDefinition><IncidentDataStructure>%s</IncidentDataStructure></DataDefinition>\n"
        "<WavelengthData><Wavelength unit=\"Integral\">Visible</Wavelength>\n"
        "<WavelengthDataBlock><WavelengthDataDirection>%s</WavelengthDataDirection>\n%s\n"
        "<ScatteringData>\n%s\n</ScatteringData></WavelengthDataBlock></WavelengthData>\n"
        "</Layer></Optical></WindowElement>\n", structure, side, bases, data);
}

static const char quarter_bases[] = "<ColumnAngleBasis>LBNL/Klems Quarter</ColumnAngleBasis>"
                                    "<RowAngleBasis>LBNL/Klems Quarter</RowAngleBasis>";
static const char tree_basis[] = "<AngleBasis>LBNL/Shirley-Chiu</AngleBasis>";

/* value(leaving or row, incident or column) as text, one row a line. */
static char *matrix(Arena *arena, double (*value)(int, int))
{
    char *text = (char *)arena_alloc(arena, 1, 1, QUARTER * QUARTER * 16), *at = text;
    for (int row = 0; row < QUARTER; row++) {
        for (int column = 0; column < QUARTER; column++)
            at += sprintf(at, "%.6g, ", value(row, column));
        *at++ = '\n';
    }
    return text;
}

/* ---- Klems ------------------------------------------------------------------------------- */

static double numbered(int row, int column)
{
    return 1 + column + 100 * row;
}

static double lambertian(int row, int column)
{
    (void)row;
    (void)column;
    return 0.5 / PI;
}

static int latitude_of(int patch, int *piece, int *pieces)
{
    static const int cut[] = {1, 8, 12, 12, 8};
    int latitude = 0;
    for (; patch >= cut[latitude]; latitude++) patch -= cut[latitude];
    *piece = patch;
    *pieces = cut[latitude];
    return latitude;
}

/* Depends on the latitudes and on the difference of the azimuths alone. */
static double rotating(int row, int column)
{
    int out, outs, in, ins;
    int lat_out = latitude_of(row, &out, &outs), lat_in = latitude_of(column, &in, &ins);
    return 10 * lat_in + lat_out + 0.5 * cos(2 * PI * ((double)out / outs - (double)in / ins));
}

FIXTURE_TEST(klems_lambertian_is_isotropic)
{
    f->options.wavelength_nm = 0;
    assert_reads(f, document(&f->arena, "Columns", "Reflection Front", quarter_bases,
                             matrix(&f->arena, lambertian)), "window");
    assert_int_equal(f->set.count, 5);
    assert_false(f->set.is_anisotropic);
    assert_close(f->set.table[0].wavelength_nm[0], 555, 1e-7);
    for (int i = 0; i < 5; i++)
        for (int r = 0; r < QUARTER; r++)
            assert_close(f->set.table[i].value[r], 0.5 / PI, 1e-5);
    assert_noted(f, "values are means over patches");
    assert_string_equal(f->set.panel, "pane");
}

FIXTURE_TEST(klems_columns_are_incident_and_rows_leaving)
{
    assert_reads(f, document(&f->arena, "Columns", "Reflection Front", quarter_bases,
                             matrix(&f->arena, numbered)), "window");
    assert_true(f->set.is_anisotropic);
    assert_int_equal(f->set.count, 1 + 4 * 12);
    /* Incident patch 3 is latitude 1 at azimuth 90: light from 270. Leaving patch 12 is
     * latitude 2 at azimuth 90, the mirror direction's. */
    assert_near(value_at(table_at(f, 18, 270), 36.5, 0, 0), 1 + 3 + 1200, 0);
    /* Leaving patch 15, azimuth 180, is 90 degrees on. */
    assert_near(value_at(table_at(f, 18, 270), 36.5, 90, 0), 1 + 3 + 1500, 0);
    /* Azimuth 30 lies in the patch about 45, incident patch 2. */
    assert_near(value_at(table_at(f, 18, 210), 36.5, 0, 0), 1 + 2 + 1000, 0);
    assert_near(value_at(table_at(f, 0, 180), 0, 0, 0), 1, 0);
    assert_reads(f, document(&f->arena, "Rows", "Reflection Front", quarter_bases,
                             matrix(&f->arena, numbered)), "window");
    assert_near(value_at(table_at(f, 18, 270), 36.5, 0, 0), 1 + 12 + 300, 0);
}

FIXTURE_TEST(klems_turning_together_is_isotropic)
{
    assert_reads(f, document(&f->arena, "Columns", "Reflection Back", quarter_bases,
                             matrix(&f->arena, rotating)), "window");
    assert_int_equal(f->set.count, 5);
    const ImportTable *t = table_at(f, 56, 180);
    assert_close(value_at(t, 36.5, 0, 0), 30 + 2 + 0.5, 1e-5);
    assert_close(value_at(t, 36.5, 180, 0), 30 + 2 - 0.5, 1e-5);
    assert_noted(f, "Reflection Back is taken");
}

FIXTURE_TEST(klems_bases_of_the_files_own)
{
    assert_reads(f, "<WindowElement><Optical><Layer><DataDefinition>"
                    "<IncidentDataStructure>Columns</IncidentDataStructure><AngleBasis>"
                    "<AngleBasisName>own</AngleBasisName>"
                    "<AngleBasisBlock><Theta>0</Theta><nPhis>1</nPhis><ThetaBounds>"
                    "<LowerTheta>0</LowerTheta><UpperTheta>30</UpperTheta></ThetaBounds>"
                    "</AngleBasisBlock><AngleBasisBlock><Theta>60</Theta><nPhis>2</nPhis>"
                    "<ThetaBounds><LowerTheta>30</LowerTheta><UpperTheta>90</UpperTheta>"
                    "</ThetaBounds></AngleBasisBlock></AngleBasis></DataDefinition>"
                    "<WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>"
                    "<WavelengthDataDirection>Reflection Front</WavelengthDataDirection>"
                    "<ColumnAngleBasis>own</ColumnAngleBasis><RowAngleBasis>own</RowAngleBasis>"
                    "<ScatteringData>1 2 2 3 4 5 3 5 4</ScatteringData></WavelengthDataBlock>"
                    "</WavelengthData></Layer></Optical></WindowElement>", "window");
    assert_int_equal(f->set.count, 2);
    const ImportTable *t = table_at(f, 60, 180);
    assert_near(value_at(t, 0, 0, 0), 2, 0);
    assert_near(value_at(t, 60, 0, 0), 4, 0);
    assert_near(value_at(t, 60, 180, 0), 5, 0);
}

/* ---- tensor trees ------------------------------------------------------------------------ */

/* Rank 3, a grid of 2 x 2 x 2: the first dimension is (1 - sin theta) / 2, so that above 30
 * degrees of incidence... all real light lies in its first half; the last one runs fastest. */
FIXTURE_TEST(tensor_tree_of_rank_3)
{
    assert_reads(f, document(&f->arena, "TensorTree3", "Reflection Front", tree_basis,
                             "{ 1 2 3 4 5 6 7 8 }"), "window");
    assert_int_equal(f->set.count, 9);
    const ImportTable *t = table_at(f, 40, 180);
    assert_int_equal(t->rows, 32 * 32);
    /* x along the mirror direction, y to its left: (low x, low y) is 1, then y, then x. */
    assert_near(t->value[row_at(t, 40, 225, 3)], 1, 0);
    assert_near(t->value[row_at(t, 40, 135, 3)], 2, 0);
    assert_near(t->value[row_at(t, 40, 315, 3)], 3, 0);
    assert_near(t->value[row_at(t, 40, 45, 3)], 4, 0);
}

/* The first dimension of a branch is the lowest bit of the child's number. */
FIXTURE_TEST(tensor_tree_branches_and_depth)
{
    assert_reads(f, document(&f->arena, "TensorTree3", "Reflection Front", tree_basis,
                             "{{{1}{2}{1}{2}{1}{2}{1}{2}}{0}{3}{0}{4}{0}{5}{0}}"), "window");
    /* Within the first eighth (light in [0, .5), x and y low) the halves of the light differ:
     * below 30 degrees of incidence the light is above .25. */
    const ImportTable *t = table_at(f, 20, 180);
    assert_near(t->value[row_at(t, 40, 225, 3)], 2, 0);
    t = table_at(f, 40, 180);
    assert_near(t->value[row_at(t, 40, 225, 3)], 1, 0);
    assert_near(t->value[row_at(t, 40, 315, 3)], 3, 0); /* child 2: x high */
    assert_near(t->value[row_at(t, 40, 135, 3)], 4, 0); /* child 4: y high */
    assert_near(t->value[row_at(t, 40, 45, 3)], 5, 0);
}

FIXTURE_TEST(tensor_tree_lambertian_is_isotropic)
{
    assert_reads(f, document(&f->arena, "TensorTree4", "Reflection Front", tree_basis,
                             "{ 0.25 }"), "window");
    assert_int_equal(f->set.count, 9);
    double sum = 0; /* equal squares are equal parts of the projected disk */
    for (int i = 0; i < f->set.table[3].rows; i++) sum += f->set.table[3].value[i];
    assert_close(sum / f->set.table[3].rows * PI, 0.25 * PI, 1e-12);
}

FIXTURE_TEST(a_tensor_tree_of_rank_4_has_its_values)
{
    const char *file = shared_bsdf(f, "window-xml/simple_tensor_d2_refl.xml");
    assert_true(fixture_read_file(f, file, "window"));
    assert_true(f->set.is_anisotropic);
    assert_int_equal(f->set.count, 1 + 8 * 12);
    /* Child n has bits: mirror x, mirror y, leaving x, leaving y; its value is (n + 1) / 100.
     * Light from 210 is mirrored to 30: bits 1 and 2. Leaving at 30 + 15 = 45: all bits. */
    const ImportTable *t = table_at(f, 30, 210);
    assert_near(t->value[row_at(t, 40, 15, 3)], 0.16, 0);
    assert_near(t->value[row_at(t, 40, 195, 3)], 0.04, 0);
    assert_near(t->value[row_at(t, 40, 105, 3)], 0.12, 0); /* at 135: y alone */
    t = table_at(f, 30, 330); /* mirrored to 150: y alone */
    assert_near(t->value[row_at(t, 40, 45 - 150, 3)], 0.15, 0);
    assert_noted(f, "Reflection Back left out");
}

/* ---- real files and refusals ------------------------------------------------------------- */

FIXTURE_TEST(a_real_klems_file_has_its_spot)
{
    const char *file = shared_bsdf(f, "window-xml/simple_klems_spot_front_refl.xml");
    assert_true(fixture_read_file(f, file, "window"));
    /* 42 at (0, 0), (9, 9) and (10, 10) of the matrix, which is latitude 20 at azimuth 0 and
     * 22.5: a mirror there. */
    assert_true(f->set.is_anisotropic);
    const ImportTable *t = table_at(f, 20, 180);
    assert_int_equal(t->rows, 145);
    assert_near(value_at(t, 20, 0, 0), 42, 0);
    assert_near(value_at(t, 0, 0, 0), 0, 0);
    assert_near(value_at(table_at(f, 0, 180), 0, 0, 0), 42, 0);
    assert_near(value_at(table_at(f, 20, 195), 20, 7.5, 0), 42, 0);
    t = table_at(f, 20, 225);
    assert_near(t->value[brightest_row(t)], 0, 0);
}

FIXTURE_TEST(files_without_reflection_are_refused)
{
    const char *file = shared_bsdf(f, "window-xml/simple_klems_spot_trans.xml");
    assert_false(fixture_read_file(f, file, "window"));
    assert_string_equal(f->err.text,
                        "there is transmission only, required: a WavelengthDataBlock of "
                        "Reflection Front at the wavelength Visible: a display panel is "
                        "opaque");
    assert_false(fixture_read_file(f, shared_bsdf(f, "window-xml/simple_tensor_spot_trans.xml"),
                                   "window"));
    assert_false(fixture_read_file(f, shared_bsdf(f, "window-xml/minimalBSDFt.xml"), "window"));
    assert_string_equal(f->err.text,
                        "there is no scattering data, required: a WavelengthDataBlock of "
                        "Reflection Front at the wavelength Visible: a display panel is "
                        "opaque");
}

FIXTURE_TEST(xml_errors_name_the_line)
{
    const Importer *i = &importer_window;
    assert_refused(f, "<!DOCTYPE a [<!ENTITY b \"c\">]><WindowElement/>", i,
                   "has a document type (<!DOCTYPE), which is not taken");
    assert_refused(f, document(&f->arena, "TensorTree3", "Reflection Front", tree_basis,
                               "{ 1 2 3 }"), i,
                   "line 10: a grid of the tensor tree has 3 numbers, required: a power of 8");
    assert_refused(f, document(&f->arena, "TensorTree4", "Reflection Front", tree_basis,
                               "{{1}{2}"), i,
                   "line 10: ' ' stands where '{' of the tensor tree is required");
    assert_refused(f, document(&f->arena, "Columns", "Reflection Front", quarter_bases,
                               "1 2"), i,
                   "line 10: the matrix is 41 x 41, more numbers than there are");
    assert_refused(f, document(&f->arena, "Diagonal", "Reflection Front", tree_basis, "1"), i,
                   "line 6: IncidentDataStructure is 'Diagonal', required: Columns, Rows, "
                   "TensorTree3 or TensorTree4");
    assert_refused(f, document(&f->arena, "Rows", "Reflection Front", tree_basis, "1"), i,
                   "line 8: ColumnAngleBasis is '', which is not defined, required: the name "
                   "of an angle basis");
    fixture_write(f, "<WindowElement><Optical>", 24);
    f->set = import_set(&f->arena);
    assert_false(i->read(f->file, &f->options, &f->set, &f->err));
    assert_memory_equal(f->err.text, "is no sound XML: ", 17);
    const char *text = document(&f->arena, "TensorTree4", "Reflection Front", tree_basis,
                                "{1}");
    assert_prefixes_refused(f, text, strlen(text) - 1, 1, i);
}

TEST_PROGRAM(NULL, NULL)

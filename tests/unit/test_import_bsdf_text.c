/* SPDX-License-Identifier: Apache-2.0 */
/* Scatter in the text formats of optical design programs and goniophotometers. */
#include "import_fixture.h"

#define PI 3.14159265358979323846

/* ---- Zemax ------------------------------------------------------------------------------- */

#define ZEMAX_HEAD \
    "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\n" \
    "ScatterType BRDF\nSampleRotation 1\n0\nAngleOfIncidence 2\n20 40\n" \
    "ScatterAzimuth 3\n0 90 180\nScatterRadial 3\n0 10 60\n\nMonochrome\nDataBegin\n"
#define ZEMAX \
    ZEMAX_HEAD \
    "TIS 0.5\n9 1 2\n9 3 4\n9 5 6\n" \
    "TIS 0.6\n19 11 12\n19 13 14\n19 15 16\nDataEnd\n"

FIXTURE_TEST(zemax_angles_count_from_the_mirror_direction) {
    f->options.wavelength_nm = 633;
    assert_reads(f, ZEMAX, "zemax");
    assert_int_equal(f->set.count, 2);
    const ImportTable *t = table_at(f, 40, 180);
    assert_close(t->wavelength_nm[0], 633, 1e-7);
    /* The mirror direction is (40, 0); azimuth 0 leads towards the normal and beyond. */
    assert_near(value_at(t, 40, 0, 0), 19, 0);
    assert_near(value_at(t, 30, 0, 0), 11, 0);
    assert_near(value_at(t, 20, 180, 0), 12, 0);
    assert_near(value_at(t, 50, 0, 0), 15, 0);
    /* Across: cos theta = cos 10 cos 40, sin of the turn over sin theta; both halves. */
    double r = PI / 180;
    double theta = acos(cos(10 * r) * cos(40 * r)) / r;
    double phi = asin(sin(10 * r) / sin(theta * r)) / r;
    assert_near(value_at(t, theta, phi, 0), 13, 0);
    assert_near(value_at(t, theta, -phi, 0), 13, 0);
    /* Azimuth 180 and radial 60 lies under the horizon: the others are there. */
    assert_int_equal(t->rows, 1 + 4 + 3);
    assert_false(f->set.is_anisotropic);
}

FIXTURE_TEST(zemax_azimuth_runs_counter_clockwise) {
    assert_reads(f,
                 "Source Measured\nSymmetry ASymmetrical\nSpectralContent Monochrome\n"
                 "ScatterType BRDF\nSampleRotation 1\n0\nAngleOfIncidence 1\n0\n"
                 "ScatterAzimuth 4\n0 90 180 270\nScatterRadial 2\n0 30\n\nMonochrome\n"
                 "DataBegin\nTIS 0\n1 2\n1 3\n1 4\n1 5\nDataEnd\n",
                 "zemax");
    /* At normal incidence the tangent towards the normal points away from phi 0, to 180. */
    const ImportTable *t = table_at(f, 0, 180);
    assert_near(value_at(t, 30, 180, 0), 2, 0);
    assert_near(value_at(t, 30, 270, 0), 3, 0);
    assert_near(value_at(t, 30, 0, 0), 4, 0);
    assert_near(value_at(t, 30, 90, 0), 5, 0);
    assert_int_equal(t->rows, 5);
}

FIXTURE_TEST(zemax_sample_rotations_are_azimuths_of_the_light) {
    assert_reads(f,
                 "Symmetry ASymmetrical4D\nSpectralContent Monochrome\nScatterType BRDF\n"
                 "SampleRotation 2\n0 90\nAngleOfIncidence 1\n30\nScatterAzimuth 1\n0\n"
                 "ScatterRadial 1\n10\nMonochrome\nDataBegin\nTIS 0 7\nTIS 0 8\nDataEnd\n",
                 "zemax");
    assert_true(f->set.is_anisotropic);
    assert_near(value_at(table_at(f, 30, 180), 20, 0, 0), 7, 0);
    assert_near(value_at(table_at(f, 30, 90), 20, 0, 0), 8, 0);
    /* Declared isotropic: the first azimuth serves. */
    f->set = import_set(&f->arena);
    f->set.is_isotropic = true;
    assert_true(importer_zemax.read(f->file, &f->options, &f->set, &f->err));
    assert_int_equal(f->set.count, 1);
    assert_noted(f, "isotropic as declared");
    /* 360 is 0 again. */
    assert_reads(f,
                 "Symmetry ASymmetrical4D\nSpectralContent Monochrome\nScatterType BRDF\n"
                 "SampleRotation 3\n0 180 360\nAngleOfIncidence 1\n30\nScatterAzimuth 2\n"
                 "0 360\nScatterRadial 1\n10\nMonochrome\nDataBegin\nTIS 0 7 7\n"
                 "TIS 0 8 8\nTIS 0 7 7\nDataEnd\n",
                 "zemax");
    assert_int_equal(f->set.count, 2);
    assert_int_equal(f->set.table[0].rows, 1);
    assert_near(value_at(table_at(f, 30, 0), 20, 0, 0), 8, 0);
}

FIXTURE_TEST(zemax_of_xyz_keeps_y) {
    f->options.wavelength_nm = 0;
    assert_reads(f,
                 "Symmetry PlaneSymmetrical\nSpectralContent XYZ\nScatterType BRDF\n"
                 "SampleRotation 1\n0\nAngleOfIncidence 1\n30\nScatterAzimuth 1\n0\n"
                 "ScatterRadial 1\n10\nTristimulusX\nDataBegin\nTIS 0 7\nDataEnd\n"
                 "TristimulusY\nDataBegin\nTIS 0 8\nDataEnd\nTristimulusZ\nDataBegin\n"
                 "TIS 0 9\nDataEnd\n",
                 "zemax");
    assert_near(value_at(table_at(f, 30, 180), 20, 0, 0), 8, 0);
    assert_close(f->set.table[0].wavelength_nm[0], 555, 1e-7);
    assert_noted(f, "of X, Y and Z only Y is taken");
}

/* A Lambertian surface of reflectance 0.6: brdf 0.6 / pi about any mirror direction. */
FIXTURE_TEST(zemax_totals_are_told_beside_the_tables_own) {
    char text[16384];
    int n = snprintf(text, sizeof text,
                     "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\n"
                     "ScatterType BRDF\n"
                     "SampleRotation 1\n0\nAngleOfIncidence 1\n50\nScatterAzimuth 19\n");
    for (int i = 0; i < 19; i++) n += sprintf(text + n, "%d ", i * 10);
    n += sprintf(text + n, "\nScatterRadial 19\n");
    for (int i = 0; i < 19; i++) n += sprintf(text + n, "%d ", i * 10);
    n += sprintf(text + n, "\nMonochrome\nDataBegin\nTIS 0.6\n");
    for (int i = 0; i < 19 * 19; i++) n += sprintf(text + n, "0.190986 ");
    sprintf(text + n, "\nDataEnd\n");
    assert_reads(f, text, "zemax");
    assert_noted(f, "50 deg 0.6 (0.6)");
    for (int i = 0; i < f->set.table[0].rows; i++)
        assert_close(f->set.table[0].value[i], 0.190986, 1e-12);
}

FIXTURE_TEST(zemax_zeros_are_directions_without_a_measurement) {
    assert_reads(f,
                 "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\n"
                 "SampleRotation 1\n0\nAngleOfIncidence 1\n30\nScatterAzimuth 1\n0\n"
                 "ScatterRadial 3\n0 10 20\nMonochrome\nDataBegin\nTIS 0 7 0 8\nDataEnd\n",
                 "zemax");
    assert_int_equal(f->set.table[0].rows, 2);
    assert_int_equal(f->set.table[0].masked, 1);
    assert_close(f->set.table[0].masked_theta_deg[0], 20, 1e-9);
}

FIXTURE_TEST(zemax_errors_name_the_line) {
    const Importer *z = &importer_zemax;
    assert_refused(f, ZEMAX_HEAD "TIS 0.5\n9 1 2\n9 x 4\n", z,
                   "line 18: a value of the block is 'x', required: a number");
    assert_refused(f, ZEMAX_HEAD "TIS 0.5\n9 1 2\n9 3 4\n9 5 6\nDataEnd\n", z,
                   "line 21: the file ends after 1 blocks, required: 2");
    assert_refused(f, "Symmetry Round\n", z,
                   "line 1: Symmetry is 'Round', required: "
                   "PlaneSymmetrical, Asymmetrical or ASymmetrical4D");
    assert_refused(f, "ScatterType BTDF\n", z,
                   "line 1: ScatterType is BTDF: transmission, and a display panel is opaque");
    assert_refused(f, "AngleOfIncidence 1000\n1 2\n", z,
                   "line 1: AngleOfIncidence is 1000, more than the rest of the file can hold");
    f->options.wavelength_nm = 0;
    assert_refused(f,
                   "Symmetry PlaneSymmetrical\nSpectralContent Monochrome\n"
                   "ScatterType BRDF\nSampleRotation 1\n0\nAngleOfIncidence 1\n30\n"
                   "ScatterAzimuth 1\n0\n"
                   "ScatterRadial 1\n10\nMonochrome\nDataBegin\nTIS 0 7\nDataEnd\n",
                   z, "does not say the wavelength of its values — give it as --wavelength NM");
}

FIXTURE_TEST(zemax_prefixes_are_refused) {
    assert_prefixes_refused(f, ZEMAX, strlen(ZEMAX) - 1, 1, &importer_zemax);
}

/* Values read off the file: line 39 is azimuth 0 of incidence 10, line 47 azimuth 80. */
FIXTURE_TEST(a_real_black_coating_of_zemax_has_its_values) {
    f->options.wavelength_nm = 650;
    const char *file = shared_bsdf(f, "loft-rt300s/AnoBlackEC1onAlum.bsdf");
    assert_true(fixture_read_file(f, file, "zemax"));
    assert_int_equal(f->set.count, 4);
    const ImportTable *t = table_at(f, 10, 180);
    assert_close(t->wavelength_nm[0], 650, 1e-7);
    assert_close(value_at(t, 10, 0, 0), 3.480e-2, 1e-12);
    assert_close(value_at(t, 5, 0, 0), 3.355e-2, 1e-12);
    assert_close(value_at(t, 0, 0, 0), 3.067e-2, 1e-12);
    assert_close(value_at(t, 5, 180, 0), 2.781e-2, 1e-12);
    assert_close(value_at(t, 80, 180, 0), 7.904e-3, 1e-12); /* radial 90 */
    assert_close(value_at(t, 15, 0, 0), 3.248e-2, 1e-12);   /* azimuth 180, radial 5 */
    assert_true(t->masked > 0);
    assert_noted(f, "10 deg 0.03866 (");
}

TEST_PROGRAM(NULL, NULL)

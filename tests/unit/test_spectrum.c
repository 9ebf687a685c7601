/* SPDX-License-Identifier: Apache-2.0 */
/* Colour from spectra: one observer, one normalisation, no bias from sampling wavelengths. */
#include "fixture.h"

#include "base/units.h"
#include "spectrum/curve.h"
#include "spectrum/illuminant.h"
#include "spectrum/photometry.h"
#include "spectrum/wavelengths.h"

#define OFFSETS 20000

static Spectrum curve_of_d65(const Wavelengths *w) {
    return w->d65;
}

/* Mean estimate of XYZ over many offsets. */
static void estimate_xyz(Spectrum (*radiance)(const Wavelengths *), double xyz[3]) {
    xyz[0] = xyz[1] = xyz[2] = 0;
    for (int i = 0; i < OFFSETS; i++) {
        Wavelengths w;
        float one[3] = {0, 0, 0};
        wavelengths_sample(((float)i + 0.5f) / OFFSETS, &w);
        spectrum_add_xyz(&w, radiance(&w), one);
        for (int c = 0; c < 3; c++) xyz[c] += (double)one[c] / OFFSETS;
    }
}

TEST(equal_energy_has_its_luminance) {
    float one[SPECTRAL_COUNT];
    for (int i = 0; i < SPECTRAL_COUNT; i++) one[i] = 1;
    assert_close(luminance_cd_m2(one, SPECTRAL_COUNT, 360, 1), 683.002 * 106.8569, 1e-6);
    assert_close(luminance_cd_m2(one, 95, 360, 5), 683.002 * 106.8569, 1e-6);
    assert_close(luminance_cd_m2(one, 48, 360, 10), 683.002 * 106.8569, 1e-6);
    float three[6] = {1, 1, 1, 1, 1, 1};
    assert_close(luminance_cd_m2(three, 6, 554.5, 0.2), 683.002, 2e-4);
}

TEST(equal_energy_is_white_of_e) {
    float one[SPECTRAL_COUNT];
    double xyz[3];
    for (int i = 0; i < SPECTRAL_COUNT; i++) one[i] = 1;
    xyz_from_radiance(one, SPECTRAL_COUNT, 360, 1, xyz);
    assert_close(xyz[0], 683.002 * 106.86546949, 2e-6);
    assert_close(xyz[2], 683.002 * 106.89225128, 4e-6);
}

TEST(nothing_is_seen_outside_360_to_830) {
    float one[200];
    for (int i = 0; i < 200; i++) one[i] = 1;
    assert_near(luminance_cd_m2(one, 200, 150, 1), 0, 0);
    assert_near(luminance_cd_m2(one, 200, 900, 1), 0, 0);
    assert_near(luminance_cd_m2(one, 1, 555, 1), 0, 0); /* a single point has no width */
}

TEST(a_black_body_radiates_sigma_t4) {
    for (double kelvin = 1000; kelvin < 12000; kelvin *= 1.7) {
        double sum = 0; /* in ln(lambda): 10 nm to 1 mm */
        for (int i = 0; i < 20000; i++) {
            double nm = exp(log(10.0) + (i + 0.5) / 20000 * log(1e5));
            sum += black_body_radiance(nm, kelvin) * nm * log(1e5) / 20000;
        }
        assert_close(sum, STEFAN_BOLTZMANN * pow(kelvin, 4) / PI, 1e-4);
    }
}

TEST(illuminant_a_is_a_black_body_of_2856_kelvin) {
    double ratio = (double)spectral_row(560).illuminant_a / black_body_radiance(560, 2855.5);
    for (int nm = 380; nm <= 780; nm += 40)
        assert_close(spectral_row(nm).illuminant_a, ratio * black_body_radiance(nm, 2855.5), 2e-4);
}

TEST(d65_has_its_chromaticity) {
    float d65[SPECTRAL_COUNT], xyz[3], xy[2];
    double sum[3];
    for (int i = 0; i < SPECTRAL_COUNT; i++) d65[i] = spectral_table[i].d65;
    xyz_from_radiance(d65, SPECTRAL_COUNT, 360, 1, sum);
    for (int c = 0; c < 3; c++) xyz[c] = (float)sum[c];
    assert_close(sum[1], 1, 1e-5);
    assert_close(sum[0], 0.950471, 2e-5);
    assert_close(sum[2], 1.088828, 2e-5);
    xy_from_xyz(xyz, xy);
    assert_near(xy[0], 0.312727, 3e-6);
    assert_near(xy[1], 0.329023, 3e-6);
}

/* What wavelengths_sample draws from, nm^-1. */
static float wavelengths_pdf(float nm) {
    if (!(nm >= SPECTRAL_FIRST_NM && nm < SPECTRAL_LAST_NM)) return 0;
    int cell = (int)nm - SPECTRAL_FIRST_NM;
    return (wavelength_steps[cell + 1] - wavelength_steps[cell]) * 0x1p-24f;
}

TEST(wavelengths_cover_the_range_once) {
    double integral = 0;
    for (int i = 0; i < 47000; i++)
        integral += (double)wavelengths_pdf(360.005f + 0.01f * (float)i) * 0.01;
    assert_close(integral, 1, 1e-4);
    for (int i = 0; i <= 1000; i++) {
        Wavelengths w;
        wavelengths_sample(i < 1000 ? (float)i / 1000 : 0x1.fffffep-1f, &w);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            assert_true(w.nm[k] >= 360 && w.nm[k] <= 830);
            if (k) assert_true(w.nm[k] > w.nm[k - 1]);
            assert_true(w.xyz[1][k] >= 0 && isfinite(w.xyz[1][k]));
        }
    }
}

TEST(wavelengths_follow_their_density) {
    double histogram[47] = {0}, expected[47] = {0};
    for (int i = 0; i < OFFSETS; i++) {
        Wavelengths w;
        wavelengths_sample(((float)i + 0.5f) / OFFSETS, &w);
        for (int k = 0; k < SPECTRUM_LANES; k++) histogram[(int)((w.nm[k] - 360) / 10.0001f)]++;
    }
    for (int nm = 360; nm < 830; nm++)
        expected[(nm - 360) / 10] += (double)wavelengths_pdf((float)nm + 0.5f);
    for (int b = 0; b < 47; b++) assert_near(histogram[b] / (OFFSETS * 16.0), expected[b], 2e-4);
}

static float spike_nm, spike_width_nm;

static Spectrum spike(const Wavelengths *w) {
    Spectrum s = spectrum_all(0);
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        float t = 1 - fabsf(w->nm[k] - spike_nm) / spike_width_nm;
        s[k] = t > 0 ? t : 0;
    }
    return s;
}

TEST(spiky_spectra_are_integrated_without_bias) {
    spike_width_nm = 2;
    for (spike_nm = 380; spike_nm < 720; spike_nm += 17.3f) {
        double xyz[3], sum[3] = {0, 0, 0};
        estimate_xyz(spike, xyz);
        for (int i = 0; i < 4000; i++) {
            double nm = (double)spike_nm - 2 + (i + 0.5) / 1000;
            double t = 1 - fabs(nm - (double)spike_nm) / 2;
            SpectralRow row = spectral_row(nm);
            sum[0] += t * (double)row.x * 683.002e-3;
            sum[1] += t * (double)row.y * 683.002e-3;
            sum[2] += t * (double)row.z * 683.002e-3;
        }
        for (int c = 0; c < 3; c++) assert_near(xyz[c], sum[c], 1e-2 * (sum[1] + sum[c]) + 1e-3);
    }
}

TEST(one_offset_already_sees_the_luminance_of_daylight) {
    double squares = 0, xyz[3];
    estimate_xyz(curve_of_d65, xyz);
    assert_close(xyz[0], d65_white_xyz[0], 2e-5);
    assert_close(xyz[1], 1, 2e-5);
    assert_close(xyz[2], d65_white_xyz[2], 2e-5);
    for (int i = 0; i < 1000; i++) {
        Wavelengths w;
        float one[3] = {0, 0, 0};
        wavelengths_sample((float)i / 1000, &w);
        spectrum_add_xyz(&w, w.d65, one);
        squares += ((double)one[1] - 1) * ((double)one[1] - 1) / 1000;
    }
    assert_true(sqrt(squares) < 0.02);
}

TEST(rgb_reflectances_sum_to_one_and_stay_within_it) {
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        const SpectralRow *row = &spectral_table[i];
        assert_near((double)row->red + (double)row->green + (double)row->blue, 1, 2e-7);
        assert_true(row->red >= 0 && row->green >= 0 && row->blue >= 0);
        assert_true(row->red <= 1 && row->green <= 1 && row->blue <= 1);
    }
}

static float wanted_rgb[3];

static Spectrum emission_of_wanted(const Wavelengths *w) {
    return spectrum_from_rgb_emission(w, wanted_rgb);
}

TEST(rgb_survives_the_way_through_spectra) {
    srand(7);
    for (int i = 0; i < 24; i++) {
        double xyz[3];
        float back[3], seen[3];
        for (int c = 0; c < 3; c++)
            wanted_rgb[c] = i < 8 ? (float)(i >> c & 1) : (float)rand() / (float)RAND_MAX;
        estimate_xyz(emission_of_wanted, xyz);
        for (int c = 0; c < 3; c++) seen[c] = (float)xyz[c];
        rgb_from_xyz(seen, back);
        for (int c = 0; c < 3; c++) assert_near(back[c], wanted_rgb[c], 1e-4);
        assert_near(luminance_from_rgb(wanted_rgb), xyz[1], 1e-4);
    }
}

TEST(rec709_primaries_are_where_the_standard_has_them) {
    const float xy[3][2] = {{0.64f, 0.33f}, {0.30f, 0.60f}, {0.15f, 0.06f}};
    for (int p = 0; p < 3; p++) {
        float rgb[3] = {p == 0, p == 1, p == 2}, xyz[3], seen[2], back[3];
        xyz_from_rgb(rgb, xyz);
        xy_from_xyz(xyz, seen);
        assert_near(seen[0], xy[p][0], 1e-6);
        assert_near(seen[1], xy[p][1], 1e-6);
        rgb_from_xyz(xyz, back);
        for (int c = 0; c < 3; c++) assert_near(back[c], rgb[c], 1e-6);
    }
    float white[3] = {1, 1, 1}, xyz[3];
    xyz_from_rgb(white, xyz);
    for (int c = 0; c < 3; c++) assert_near(xyz[c], d65_white_xyz[c], 1e-6);
    assert_near(luminance_from_rgb((float[]){1, 0, 0}), 0.2126, 2e-4);
    assert_near(luminance_from_rgb((float[]){0, 1, 0}), 0.7152, 2e-4);
}

TEST(black_has_the_chromaticity_of_d65) {
    float xy[2];
    xy_from_xyz((float[]){0, 0, 0}, xy);
    assert_near(xy[0], 0.312727, 1e-5);
}

TEST(the_observer_is_the_published_table) {
    FILE *file = fopen(SHARED_DATA_DIR "/spectra/cie1931_2deg_cmf_1nm.csv", "r");
    if (!file) skip();
    char line[256];
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        double v[4];
        if (sscanf(line, "%lf,%lf,%lf,%lf", v, v + 1, v + 2, v + 3) != 4) continue;
        SpectralRow row = spectral_row(v[0]);
        assert_near(row.x, v[1], 5e-6 * v[1] + 1e-12);
        assert_near(row.y, v[2], 5e-6 * v[2] + 1e-12);
        assert_near(row.z, v[3], 5e-6 * v[3] + 1e-12);
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, SPECTRAL_COUNT);
}

TEST(a_curve_passes_through_its_points_and_holds_its_ends) {
    double nm[4] = {400, 500.5, 600, 700}, value[4] = {0.1, 0.5, 0.2, 0.9};
    static Curve curve;
    curve_from_points(nm, value, 4, &curve);
    assert_close(curve.value[0], 0.1, 1e-6);
    assert_close(curve.value[CURVE_COUNT - 1], 0.9, 1e-6);
    assert_close(curve.value[600 - 360], 0.2, 1e-6);
    assert_close(curve.value[650 - 360], 0.55, 1e-6);
    assert_close(curve.value[500 - 360], 0.1 + 0.4 * 100 / 100.5, 1e-6);
    for (int i = 0; i < 50; i++) {
        Wavelengths w;
        wavelengths_sample((float)i / 50, &w);
        Spectrum looked_up = curve_lookup(&curve, &w);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            int cell = (int)w.nm[k] - 360;
            float t = w.nm[k] - (float)(cell + 360);
            float next = cell + 1 < CURVE_COUNT ? curve.value[cell + 1] : 0;
            assert_near(looked_up[k], curve.value[cell] * (1 - t) + next * t, 1e-5);
        }
    }
}

static bool curve_read(const char *path, Curve *out, Error *err) {
    FileBytes bytes;
    ENDS_BY(arena_release) Arena arena = arena_reserve(1 << 20);
    bool ok = file_read(path, 1 << 16, &arena, &bytes, err) &&
              curve_parse((const char *)bytes.data, path, CURVE_NUMBERS, out, NULL, err);
    return ok;
}

TEST(a_curve_file_may_have_comments_and_a_header) {
    static Curve curve;
    const char *path = in_folder("curve.csv");
    write_text(path, "\xef\xbb\xbf# glass\nnm,transmittance\n\n400,0.5\r\n500 ; 0.75\n"
                     "700\t0.25");
    assert_done(curve_read(path, &curve, &err));
    remove(path);
    assert_close(curve.value[0], 0.5, 1e-6);
    assert_close(curve.value[450 - 360], 0.625, 1e-6);
    assert_close(curve.value[CURVE_COUNT - 1], 0.25, 1e-6);
}

TEST(a_bad_curve_file_is_refused_with_its_line) {
    const struct {
        const char *text, *message;
    } cases[] = {
        {"", "no rows of nm,value"},
        {"nm,value\n", "no rows of nm,value"},
        {"nm,value\n400,1\n400,2\n", "line 3: wavelength 400 nm after 400 nm: required: "
                                     "rising"},
        {"nm,value\nfour,1\n", "line 2: found \"four,1\", required: two numbers: nm,value"},
        {"400,1\n500\n", "line 2: found \"500\", required: two numbers"},
        {"400,1,\n500,1\n", "line 1: found \"400,1,\", required: two numbers"},
        {" 400\n500,1\n", "line 1: found \" 400\", required: two numbers"},
        {"0.4,1\n0.7,2\n", "wavelengths from 0.4 to 0.7 nm, required from 400 to 700"},
        {"900,1\n1e3,2\n", "wavelengths from 900 to 1000 nm, required from 400 to 700"},
        {"400,nan\n", "line 1: found \"400,nan\", required: two numbers: nm,value"},
        {"400,inf\n500,1\n", "line 1: found \"400,inf\", required: two numbers"},
        {"400,1\n500,0x1p7\n", "line 2: found \"500,0x1p7\", required: two numbers"},
        {"400,1\n500,1e999\n", "line 2: found \"500,1e999\", required: two numbers"},
        {"400,1\n500,5%\n", "line 2: found \"500,5%\", required: two numbers"},
        {"-5,1\n", "line 1: wavelength -5 nm with value 1: required: finite numbers, nm above "
                   "0"},
        {"400,1e31\n", "value 1e+31: required: finite numbers, nm above 0, up to 1e+12"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static Curve curve;
        char line[2048];
        const char *path = in_folder("curve.csv");
        write_text(path, cases[i].text);
        assert_false(curve_read(path, &curve, why()));
        remove(path);
        error_line(why(), line, sizeof line);
        if (!strstr(line, cases[i].message) || strncmp(line, path, strlen(path)) != 0)
            fail_msg("\"%s\" does not name the file and say \"%s\"", line, cases[i].message);
        assert_int_equal(why()->code, ERROR_INPUT);
    }
    assert_fails_as(curve_read("/nowhere/glass.csv", &(Curve){0}, &err), ERROR_INPUT,
                    "cannot be opened: No such file");
}

TEST(a_value_out_of_range_is_refused_with_its_line) {
    static Curve curve;
    char line[2048];
    const char *text = "nm,value\n400,0.5\n500,1.25\n600,-0.1\n700,0\n";
    static const char *const MESSAGES[] = {
        [CURVE_AMOUNTS] = "x.csv: line 4: holds -0.1; 0 or more is required",
        [CURVE_SHARES] = "x.csv: line 3: holds 1.25; 0 to 1 is required"};
    assert_done(curve_parse(text, "x.csv", CURVE_NUMBERS, &curve, NULL, &err));
    for (int range = CURVE_AMOUNTS; range <= CURVE_SHARES; range++) {
        assert_false(curve_parse(text, "x.csv", (CurveRange)range, &curve, NULL, why()));
        error_line(why(), line, sizeof line);
        assert_string_equal(line, MESSAGES[range]);
    }
    assert_done(curve_parse("400,0\n700,1\n", "x.csv", CURVE_SHARES, &curve, NULL, &err));
}

/* Rows 400 to 700 with .5, 80 or the like, as shares; what the header must make of them. */
TEST(a_header_is_read_by_its_words) {
    static const struct {
        const char *header, *row;
        double value;     /* at 550 nm; < 0: refused */
        const char *says; /* then, or of a unit that is not known */
    } cases[] = {
        {"nm,value", "%.9g,.5", 0.5, ""},
        {"nm,%R", "%.9g,80", 0.8, ""},
        {"nm,%R", "%.9g,.8", 0.008, ""},
        {"Wavelength (nm), Reflectance (%)", "%.9g,80", 0.8, ""},
        {"wavelength [nm];transmittance [%]", "%.9g;80", 0.8, ""},
        {"wavelength {nm}\tT {%}", "%.9g\t80", 0.8, ""},
        {"Wavelength, nm, Reflectance, %", "%.9g,80", 0.8, ""},
        {"wavelength_nm,reflectance_percent", "%.9g,80", 0.8, ""},
        {"lambda/nm R/%", "%.9g 80", 0.8, ""},
        {"Wavelength (nm) Total Reflectance (%)", "%.9g 80", 0.8, ""},
        {"\"Wavelength [nm]\",\"%T\"", "%.9g,80", 0.8, ""},
        {"nm,R per cent", "%.9g,80", 0.8, ""},
        {"nm,R (0-100)", "%.9g,80", 0.8, ""},
        {"nm,R [\xe2\x80\xb0]", "%.9g,80", 0.08, ""},
        {"# nm,%R", "%.9g,80", 0.8, ""},
        {"reflectance (%),wavelength (nm)", "80,%.9g", 0.8, ""},
        {"Reflexion [%];Wellenl\xc3\xa4nge [nm]", "80;%.9g", 0.8, ""},
        {"Wellenl\xe4nge [nm];Transmission [%]", "%.9g;80", 0.8, ""},
        {"nm, T, %", "%.9g, 80", 0.8, ""},
        {"\xce\xbb [nm],R(\xce\xbb)", "%.9g,.5", 0.5, ""},
        {"nm,Paint K", "%.9g,.5", 0.5, ""},
        {"nm,ABS plastic", "%.9g,.5", 0.5, ""},
        {"nm,a leaf", "%.9g,.5", 0.5, ""},
        {"nm,R (SCI)", "%.9g,.5", 0.5, ""},
        {"nm,R (furlongs)", "%.9g,.5", 0.5, "furlongs"},
        {"nm,50% grey", "%.9g,.5", -1, "may be a name or a unit"},
        {"nm,absorbance", "%.9g,.3", -1, "an absorbance A"},
        {"nm,Abs", "%.9g,.3", -1, "an absorbance A"},
        {"nm,A", "%.9g,.3", -1, "an absorbance A"},
        {"nm,OD", "%.9g,.3", -1, "an absorbance A"},
        {"wavelength (nm),optical density", "%.9g,.3", -1, "an absorbance A"},
        {"nm,absorptance (%)", "%.9g,3", -1, "what is absorbed"},
        {"nm,alpha (cm-1)", "%.9g,.3", -1, "what is absorbed"},
        {"nm,transmission loss (dB)", "%.9g,.3", -1, "what is absorbed"},
        {"nm,T (dB)", "%.9g,.3", -1, "a logarithm"},
        {"nm,log R", "%.9g,.3", -1, "a logarithm"},
        {"nm,n", "%.9g,.5", -1, "a refractive index"},
        {"nm,extinction coefficient k", "%.9g,.5", -1, "a refractive index"},
        {"nm,eps2", "%.9g,.5", -1, "a permittivity"},
        {"nm,counts", "%.9g,.5", -1, "values with a unit"},
        {"nm,radiance (W/sr/m2/nm)", "%.9g,.5", -1, "values with a unit"},
        {"nm,R x1000 (x1000)", "%.9g,.5", -1, "scaled"},
        {"wavenumber (cm-1),R", "%.9g,.5", -1, "no wavelengths"},
        {"eV,R", "%.9g,.5", -1, "no wavelengths"},
        {"nm,photon flux", "%.9g,.5", -1, "a number of photons"},
    };
    static Curve curve;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[400];
        size_t length = (size_t)snprintf(text, sizeof text, "%s\n", cases[i].header);
        CurveNotes notes;
        for (int nm = 400; nm <= 700; nm += 100) {
            const char *at = strstr(cases[i].row, "%.9g");
            length += (size_t)snprintf(text + length, sizeof text - length, "%.*s%d%s\n",
                                       (int)(at - cases[i].row), cases[i].row, nm, at + 4);
        }
        bool ok = curve_parse(text, "x.csv", CURVE_SHARES, &curve, &notes, why());
        if (ok != (cases[i].value >= 0)) fail_msg("%s", cases[i].header);
        if (ok && fabs((double)curve.value[550 - 360] - cases[i].value) > 1e-6)
            fail_msg("%s: %g", cases[i].header, (double)curve.value[550 - 360]);
        if (ok) assert_string_equal(notes.unknown, cases[i].says);
        else assert_error_has(why(), cases[i].says);
    }
}

/* Light of 0 at 400 and 1 at 700 nm, or an index of 0.9 and 6. */
TEST(a_header_gives_the_unit_of_wavelengths_and_the_order_of_n_and_k) {
    static const struct {
        const char *header;
        double nm; /* one of them in the header's unit */
    } units[] = {{"nm,value", 1},
                 {"wavelength (um),value", 1e-3},
                 {"\xc2\xb5m,value", 1e-3},
                 {"\xb5m,value", 1e-3},
                 {"Wavelength [microns];value", 1e-3},
                 {"wavelength (\xc3\x85),value", 10},
                 {"Angstrom,value", 10},
                 {"wavelength / A,photometer", 10},
                 {"wavelength (m),value", 1e-9},
                 {"Wavelength,value", 1}};
    static const struct {
        const char *header;
        int n; /* column, 0 to 2; -1: refused */
        int k;
    } orders[] = {{"nm,n,k", 1, 2},
                  {"nm,k,n", 2, 1},
                  {"k,n,nm", 1, 0},
                  {"n;k;wavelength (nm)", 0, 1},
                  {"wavelength extinction index", 2, 1},
                  {"Wavelength (nm),Refractive index n,Extinction coefficient k", 1, 2},
                  {"nm,imag,real", 2, 1},
                  {"nm,kappa,n", 2, 1},
                  {"nm,n(\xce\xbb),k(\xce\xbb)", 1, 2},
                  {"nm,foo,n", 2, 1},
                  {"# nm,k,n", 2, 1},
                  {"nm,silver,of 1972", 1, 2},
                  {"nm,eps1,eps2", -1, 0},
                  {"nm,e1,e2", -1, 0},
                  {"nm,Re(eps),Im(eps)", -1, 0},
                  {"nm,R,T", -1, 0},
                  {"nm,n (%),k (%)", -1, 0}};
    static Curve one, n, k;
    char text[400];
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        char mark = strchr(units[i].header, ';') ? ';' : ',';
        snprintf(text, sizeof text, "%s\n%.9g%c0\n%.9g%c1\n", units[i].header, 400 * units[i].nm,
                 mark, 700 * units[i].nm, mark);
        if (!curve_parse(text, "x.csv", CURVE_AMOUNTS, &one, NULL, why()) ||
            fabs((double)one.value[550 - 360] - 0.5) > 1e-6)
            fail_msg("%s", units[i].header);
    }
    for (size_t i = 0; i < sizeof orders / sizeof *orders; i++) {
        double row[2][3] = {{400, 400, 400}, {700, 700, 700}};
        for (int r = 0; r < 2 && orders[i].n >= 0; r++) {
            row[r][orders[i].n] = 0.9;
            row[r][orders[i].k] = 6;
        }
        snprintf(text, sizeof text, "%s\n%g %g %g\n%g %g %g\n", orders[i].header, row[0][0],
                 row[0][1], row[0][2], row[1][0], row[1][1], row[1][2]);
        bool ok = curve_parse_index(text, "x.csv", &n, &k, NULL, why());
        if (ok != (orders[i].n >= 0) ||
            (ok && (fabsf(n.value[9] - 0.9f) > 1e-6f || fabsf(k.value[9] - 6) > 1e-6f)))
            fail_msg("%s", orders[i].header);
    }
}

TEST(a_file_of_indices_has_three_columns_and_is_refused_with_its_line) {
    static Curve n, k;
    assert_done(curve_parse_index("nm,n,k\n400,0.5,2\n500 1 4\n700,1,4\n", "metal.csv", &n, &k,
                                  NULL, &err));
    assert_close(n.value[450 - 360], 0.75, 1e-6);
    assert_close(k.value[450 - 360], 3, 1e-6);
    assert_close(k.value[CURVE_COUNT - 1], 4, 1e-6);
    const struct {
        const char *text, *message;
    } cases[] = {
        {"nm,n,k\n", "no rows of nm,n,k"},
        {"nm,n,k\n400,1\n", "line 2: found \"400,1\", required: three numbers: nm,n,k"},
        {"400,1,0,2\n500,1,0,2\n", "line 1: found \"400,1,0,2\", required: three numbers"},
        {"400,-1,2\n", "line 1: wavelength 400 nm with n -1 and k 2: required: nm above 0, n"},
        {"400,1,-2\n", "with n 1 and k -2"},
        {"400,0,0\n", "not both 0"},
        {"400,101,0\n", "from 0 to 100"},
        {"400,1,nan\n", "line 1: found \"400,1,nan\", required: three numbers: nm,n,k"},
        {"500,1,0\n400,1,0\n", "line 2: wavelength 400 nm after 500 nm"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char line[2048];
        assert_false(curve_parse_index(cases[i].text, "metal.csv", &n, &k, NULL, why()));
        error_line(why(), line, sizeof line);
        if (!strstr(line, cases[i].message) || strncmp(line, "metal.csv", 9) != 0)
            fail_msg("\"%s\" does not name the file and say \"%s\"", line, cases[i].message);
    }
}

TEST(lane_operations_agree_with_loops) {
    Spectrum a, b;
    float sum = 0, most = -1e9f;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        a[i] = (float)((i * 7) % 16) - 5.5f;
        b[i] = (float)((i * 5) % 16) - 4.25f;
        sum += a[i];
        most = a[i] > most ? a[i] : most;
    }
    Spectrum high = spectrum_max(a, b), low = spectrum_min(a, b), held = spectrum_clamp(a, -1, 2);
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        assert_true(high[i] == (a[i] > b[i] ? a[i] : b[i]));
        assert_true(low[i] == (a[i] > b[i] ? b[i] : a[i]));
        assert_true(held[i] == (a[i] < -1 ? -1 : a[i] > 2 ? 2 : a[i]));
    }
    assert_near(spectrum_sum(a), sum, 1e-5);
    assert_near(spectrum_mean(a), sum / 16, 1e-6);
    assert_true(spectrum_max_lane(a) == most);
    assert_true(spectrum_is_finite(a));
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        Spectrum bad = a;
        bad[i] = i & 1 ? NAN : INFINITY;
        assert_false(spectrum_is_finite(bad));
        Spectrum hidden = spectrum_all(0);
        hidden[i] = NAN;
        assert_false(spectrum_is_zero(hidden));
        hidden[i] = 1e-30f;
        assert_false(spectrum_is_zero(hidden));
    }
    assert_true(spectrum_is_zero(spectrum_all(0)) && !spectrum_is_zero(spectrum_all(1e-30f)));
}

/* D65 lies at 6500 K times 1.4388 / 1.4380 (CIE 15); the table has it from 1 nm data. */
TEST(daylight_of_6504_kelvin_is_d65) {
    Curve curve;
    cct_curve(6500 * 1.4388 / 1.4380, &curve);
    for (int nm = 360; nm <= 830; nm += 10)
        assert_close(curve.value[nm - 360], spectral_row(nm).d65, 2e-3);
}

/* x and y of CIE 15's D50, D55, D75, and of illuminant A below 4000 K. */
TEST(a_colour_temperature_has_the_chromaticity_of_its_illuminant) {
    static const double white[][3] = {{2855.5, 0.44758, 0.40745},
                                      {5002.8, 0.34567, 0.35850},
                                      {5503.1, 0.33242, 0.34743},
                                      {7504.2, 0.29902, 0.31485}};
    for (int i = 0; i < 4; i++) {
        Curve curve;
        double xyz[3];
        cct_curve(white[i][0], &curve);
        xyz_from_radiance(curve.value, CURVE_COUNT, CURVE_FIRST_NM, 1, xyz);
        double sum = xyz[0] + xyz[1] + xyz[2];
        assert_close(xyz[1], 1, 1e-6);
        assert_close(xyz[0] / sum, white[i][1], 5e-4);
        assert_close(xyz[1] / sum, white[i][2], 5e-4);
    }
}

TEST_PROGRAM(make_folder, remove_folder)

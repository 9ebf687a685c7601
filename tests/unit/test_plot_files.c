/* SPDX-License-Identifier: Apache-2.0 */
/* panel plot and the page of panel report: pictures of a small synthetic panel, and errors. */
#include "panel_fixture.h"

#include <ctype.h>

#include "base/count.h"
#include "cli/panel/panel_commands.h"
#include "image/image.h"
#include "plot/panel/plot.h"

/* The leak sanitizer needs this: the font library keeps what it has found until the end. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libfontconfig";
}

static Fixture ips, reflects_nothing;

/* Small and coarse: what is drawn here need not be pretty. */
#define RECIPE_IPS \
    "{\"panel\": \"test IPS\", \"refractive_index\": 1.5, \"emission\": {" FIXTURE_SPECTRA \
    "\"gamma\": 2.2, \"gamma_drop\": 0.2, \"cosine_power\": [1.1, 1.6]," \
    "\"black_cd_m2\": 0.7, \"leak\": 3, \"levels\": [127, 255]}," \
    "\"reflection\": {\"coating\": 0.6, \"coating_blue\": 0.15, \"haze_share\": 0.8," \
    "\"haze_width\": 0.09, \"haze_power\": 1.8, \"floor_albedo\": 0.004," \
    "\"wavelengths_nm\": [450, 650], \"incidence_deg\": [20, 40, 60]}," \
    "\"instrument\": {\"theta_step_deg\": 4, \"phi_step_deg\": 15," \
    "\"brdf_theta_step_deg\": 2, \"brdf_phi_step_deg\": 15, \"fwhm_deg\": 2.5}}"

#define RECIPE_WITHOUT_REFLECTION \
    "{\"panel\": \"test <OLED> & co\", \"refractive_index\": 1.5, \"emission\": {" FIXTURE_SPECTRA \
    "\"gamma\": 2.2, \"gamma_drop\": 0.0, \"cosine_power\": [0.4, 0.4]," \
    "\"black_cd_m2\": 0.0, \"leak\": 0, \"levels\": [127, 255]}," \
    "\"instrument\": {\"theta_max_deg\": 70, \"theta_step_deg\": 5, \"phi_step_deg\": 15}}"

static int start(void **state) {
    (void)state;
    FitOptions options = fit_options_default();
    options.progress = PROGRESS_NONE;
    options.threads = 2;
    options.level = 5;
    fixture_start(&ips, RECIPE_IPS, &options);
    fixture_start(&reflects_nothing, RECIPE_WITHOUT_REFLECTION, &options);
    return 0;
}

static int end(void **state) {
    (void)state;
    fixture_end(&reflects_nothing);
    fixture_end(&ips);
    return 0;
}

/* Runs a command with these arguments; a list that ends in NULL. */
static bool run(const Command *command, Error *err, ...) {
    char *argv[24] = {(char *)command->name};
    int argc = 1;
    va_list list;
    va_start(list, err);
    for (char *a; (a = va_arg(list, char *)) && argc < 24; argc++) argv[argc] = a;
    va_end(list);
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 32);
    return command->run(argc, argv, &arena, err);
}

#define RUN_FAILS(code, part, ...) \
    assert_fails_as(run(&command_panel_plot, &err, __VA_ARGS__, NULL), code, part)
#define RUN_OK(...) assert_done(run(&command_panel_plot, &err, __VA_ARGS__, NULL))
#define REPORT_OK(...) assert_done(run(&command_panel_report, &err, __VA_ARGS__, NULL))

/* Tags nest, attributes are quoted, no stray & or <. Returns the number of elements. */
static int assert_well_formed(const char *p) {
    struct {
        const char *name;
        size_t length;
    } open[64];
    int depth = 0, elements = 0;
    while ((p = strchr(p, '<'))) {
        if (p[1] == '?' || p[1] == '!') {
            p = strchr(p, '>');
            assert_non_null(p);
            continue;
        }
        bool closes = p[1] == '/';
        const char *name = p + 1 + closes;
        size_t length = strcspn(name, " \t\r\n/>");
        p = name + length;
        for (char quote = 0; *p && (quote || *p != '>'); p++) {
            if (quote && *p == quote) quote = 0;
            else if (!quote && (*p == '"' || *p == '\'')) quote = *p;
            assert_true(*p != '<');
        }
        assert_int_equal(*p, '>');
        if (closes) {
            assert_true(depth > 0);
            depth--;
            assert_int_equal(open[depth].length, length);
            assert_memory_equal(open[depth].name, name, length);
        } else {
            elements++;
            if (p[-1] == '/') continue;
            assert_true(depth < 64);
            open[depth].name = name;
            open[depth++].length = length;
        }
    }
    assert_int_equal(depth, 0);
    return elements;
}

/* ---- pictures --------------------------------------------------------------------------- */

TEST(every_kind_draws_svg) {
    char kinds[] = PLOT_KINDS;
    for (char *kind = strtok(kinds, "|"); kind; kind = strtok(NULL, "|")) {
        if (!strcmp(kind, "uniformity")) continue; /* of another file */
        RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "k.svg"), "--kind", kind, "--measured",
               fixture_path(&ips, "MANIFEST.json"));
        const char *svg = read_text(fixture_path(&ips, "k.svg"), &ips.arena);
        assert_true(assert_well_formed(svg) > 50);
        assert_non_null(strstr(svg, "<svg "));
    }
}

/* An SVG's unit is half of a PNG's pixel. */
TEST(png_opens_as_large_as_the_drawing) {
    Image image;
    RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "s.png"), "--kind", "sections");
    RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "s.svg"), "--kind", "sections");
    assert_done(image_read(fixture_path(&ips, "s.png"), &ips.arena, &image, &err));
    const char *svg = read_text(fixture_path(&ips, "s.svg"), &ips.arena);
    assert_non_null(strstr(svg, arena_format(&ips.arena, "width=\"%d\"", image.width / 2)));
    assert_non_null(strstr(svg, arena_format(&ips.arena, "height=\"%d\"", image.height / 2)));
    const unsigned char *pixel = image.pixels;
    assert_int_equal(pixel[0], 255); /* light ground */
}

/* ---- the report ------------------------------------------------------------------------- */

TEST(the_report_stands_alone) {
    REPORT_OK(reflects_nothing.panel_path, "-o", fixture_path(&reflects_nothing, "r.html"),
              "--measured", fixture_path(&reflects_nothing, "MANIFEST.json"));
    const char *html =
        read_text(fixture_path(&reflects_nothing, "r.html"), &reflects_nothing.arena);
    for (const char *p = html; (p = strstr(p, "src=\"")); p += 5)
        assert_memory_equal(p, "src=\"data:image/svg+xml;base64,", 31);
    assert_null(strstr(html, "<link"));
    assert_null(strstr(html, "@import"));
    assert_non_null(strstr(html, "test &lt;OLED&gt; &amp; co"));
    assert_null(strstr(html, "<OLED>"));
    assert_non_null(strstr(html, "red 255"));
    assert_non_null(strstr(html, "largest error, %"));
    assert_non_null(strstr(html, "extrapolated"));
    assert_null(strstr(html, "BRDF in the plane"));
    assert_non_null(strstr(html, "Residual of the worst table"));
}

/* Angle brackets inside a script would end up as tags here: scripts are taken out first. */
TEST(the_report_is_well_formed) {
    REPORT_OK(ips.panel_path, "-o", fixture_path(&ips, "w.html"));
    char *html = (char *)read_bytes(fixture_path(&ips, "w.html"), &ips.arena).data;
    int scripts = 0;
    for (char *script = html; (script = strstr(script, "<script>")); scripts++) {
        char *after = strstr(script, "</script>");
        assert_non_null(after);
        memset(script, ' ', (size_t)(after - script) + strlen("</script>"));
    }
    assert_true(scripts > 0);
    for (char *meta = html; (meta = strstr(meta, "<meta "));)
        meta[1] = '!'; /* an element without an end in HTML */
    for (char *image = html; (image = strstr(image, "<img "));) image[1] = '!'; /* likewise */
    assert_true(assert_well_formed(html) > 1000);
    assert_non_null(strstr(html, "BRDF in the plane"));
}

/* ---- errors ----------------------------------------------------------------------------- */

TEST(a_wrong_command_line_says_what_is_wanted) {
    const char *svg = fixture_path(&ips, "e.svg"), *panel = ips.panel_path;
    RUN_FAILS(ERROR_USAGE, "luminanz", panel, "-o", svg, "--kind", "luminanz");
    RUN_FAILS(ERROR_USAGE, "contrast", panel, "-o", svg, "--kind", "luminanz");
    RUN_FAILS(ERROR_USAGE, "wants -o X.svg", panel);
    RUN_FAILS(ERROR_USAGE, ".svg or .png", panel, "-o", fixture_path(&ips, "e.pdf"));
    RUN_FAILS(ERROR_USAGE, "--measured MANIFEST.json", panel, "-o", svg, "--kind", "fit");
    assert_false(file_exists(svg));
}

TEST(what_a_panel_lacks_is_said) {
    const char *panel = reflects_nothing.panel_path;
    const char *svg = fixture_path(&reflects_nothing, "e.svg");
    RUN_FAILS(ERROR_INPUT, "has no reflection data, which is required for --kind brdf", panel, "-o",
              svg, "--kind", "brdf");
    assert_string_equal(why()->file, panel);
    RUN_FAILS(ERROR_INPUT, "its black emits nothing", panel, "-o", svg, "--kind", "contrast");
    RUN_FAILS(ERROR_INPUT, "", fixture_path(&ips, "none.panel"), "-o", svg);
    assert_false(file_exists(svg));
    RUN_OK(panel, "-o", svg);
}

/* A surface that was only lit: paper, a switched-off screen. */
TEST(a_panel_that_only_reflects_is_drawn) {
    FitOptions options = fit_options_default();
    const char *panel = fixture_path(&ips, "paper.panel"), *svg = fixture_path(&ips, "paper.svg");
    const char *manifest =
        fixture_file(&ips, "PAPER.json",
                     "{\"panel\": \"paper\", \"reflection\": {\"wavelengths_nm\": [450, 650],"
                     " \"incidence_deg\": [20, 40, 60], \"files\": \"brdf/i{incidence}.csv\"}}");
    options.progress = PROGRESS_NONE;
    options.level = 5;
    assert_done(fixture_try(&ips, manifest, &options, panel, NULL, NULL, &err));
    RUN_OK(panel, "-o", svg, "--measured", manifest);
    REPORT_OK(panel, "-o", fixture_path(&ips, "paper.html"), "--measured", manifest);
    RUN_FAILS(ERROR_INPUT, "has no emission data, which is required for --kind sections", panel,
              "-o", svg, "--kind", "sections");
}

TEST(a_target_that_cannot_be_written_leaves_nothing) {
    int before = folder_count(ips.folder);
    RUN_FAILS(ERROR_OUTPUT, "", ips.panel_path, "-o", fixture_path(&ips, "none/x.png"), "--kind",
              "reflectance");
    RUN_FAILS(ERROR_OUTPUT, "", ips.panel_path, "-o", fixture_path(&ips, "none/x.svg"), "--kind",
              "reflectance");
    assert_int_equal(folder_count(ips.folder), before);
}

TEST_PROGRAM(start, end)

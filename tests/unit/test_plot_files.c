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

#define NAMES_MAX 20000

typedef struct NameList {
    int count;
    char name[NAMES_MAX][24];
} NameList;

static int compare_names(const void *a, const void *b) {
    return strcmp(a, b);
}

/* What stands behind every `before` up to a quote or bracket, sorted. */
static NameList *names_behind(const char *text, const char *before) {
    NameList *list = ARENA_NEW(&ips.arena, NameList, 1);
    for (const char *p = text; (p = strstr(p, before));) {
        p += strlen(before);
        size_t length = strspn(p, "abcdefghijklmnopqrstuvwxyz0123456789-");
        if (length == 0 || length > 23 || (p[length] != '"' && p[length] != ')')) continue;
        assert_true(list->count < NAMES_MAX);
        memcpy(list->name[list->count++], p, length);
    }
    qsort(list->name, (size_t)list->count, sizeof *list->name, compare_names);
    return list;
}

/* Every #name that is used is somebody's id, and no id stands twice. */
static void assert_ids_are_whole(const char *text) {
    NameList *ids = names_behind(text, " id=\""), *used[2];
    used[0] = names_behind(text, "href=\"#");
    used[1] = names_behind(text, "url(#");
    assert_true(ids->count > 20 && used[0]->count > 20);
    for (int i = 1; i < ids->count; i++) assert_string_not_equal(ids->name[i], ids->name[i - 1]);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < used[k]->count; i++)
            if (!bsearch(used[k]->name[i], ids->name, (size_t)ids->count, sizeof *ids->name,
                         compare_names))
                fail_msg("nobody is #%s", used[k]->name[i]);
}

/* ---- pictures --------------------------------------------------------------------------- */

TEST(every_kind_draws_svg) {
    for (int kind = 0; kind < PLOT_KIND_COUNT; kind++) {
        if (kind == PLOT_FIT || kind == PLOT_UNIFORMITY || kind == PLOT_GREY_INVERSION ||
            kind == PLOT_HALO)
            continue; /* of other files */
        RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "k.svg"), "--kind",
               plot_kind_name((PlotKind)kind));
        const char *svg = read_text(fixture_path(&ips, "k.svg"), &ips.arena);
        assert_true(assert_well_formed(svg) > 100);
        assert_non_null(strstr(svg, "<svg "));
        assert_ids_are_whole(svg);
    }
}

TEST(names_of_kinds_agree_with_the_option) {
    char names[256] = "";
    for (int kind = 0; kind < PLOT_KIND_COUNT; kind++) {
        if (kind > 0) strcat(names, "|");
        strcat(names, plot_kind_name((PlotKind)kind));
    }
    assert_string_equal(names, PLOT_KINDS);
}

TEST(png_opens_with_the_size_asked_for) {
    Image image;
    RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "s.png"), "--size", "801x603", "--kind",
           "sections");
    assert_done(image_read(fixture_path(&ips, "s.png"), &ips.arena, &image, &err));
    assert_int_equal(image.width, 801);
    assert_int_equal(image.height, 603);
    const unsigned char *pixel = image.pixels;
    assert_int_equal(pixel[0], 255); /* light ground */
    RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "d.png"), "--size", "640x480", "--dark",
           "--kind", "luminance");
    assert_done(image_read(fixture_path(&ips, "d.png"), &ips.arena, &image, &err));
    pixel = image.pixels;
    assert_true(pixel[0] < 40);
}

TEST(the_fit_shows_samples_over_curves) {
    RUN_OK(ips.panel_path, "-o", fixture_path(&ips, "f.svg"), "--kind", "fit", "--measured",
           fixture_path(&ips, "MANIFEST.json"));
    assert_true(assert_well_formed(read_text(fixture_path(&ips, "f.svg"), &ips.arena)) > 500);
}

TEST(the_same_call_writes_the_same_bytes) {
    static const char *const NAMES[][2] = {
        {"1.svg", "2.svg"}, {"1.png", "2.png"}, {"1.html", "2.html"}};
    Fixture *fixture = &reflects_nothing;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            const char *name = fixture_path(fixture, NAMES[i][k]), *threads = k ? "2" : "1";
            if (i == 2) REPORT_OK(fixture->panel_path, "-o", name, "--threads", threads);
            else
                RUN_OK(fixture->panel_path, "-o", name, "--size", "640x480", "--kind", "luminance",
                       "--threads", threads);
        }
        FileBytes a = read_bytes(fixture_path(fixture, NAMES[i][0]), &fixture->arena);
        FileBytes b = read_bytes(fixture_path(fixture, NAMES[i][1]), &fixture->arena);
        assert_int_equal(a.size, b.size);
        assert_memory_equal(a.data, b.data, a.size);
    }
}

/* ---- the report ------------------------------------------------------------------------- */

TEST(the_report_stands_alone) {
    REPORT_OK(reflects_nothing.panel_path, "-o", fixture_path(&reflects_nothing, "r.html"),
              "--measured", fixture_path(&reflects_nothing, "MANIFEST.json"));
    const char *html =
        read_text(fixture_path(&reflects_nothing, "r.html"), &reflects_nothing.arena);
    assert_null(strstr(html, "src="));
    assert_null(strstr(html, "<link"));
    assert_null(strstr(html, "@import"));
    assert_non_null(strstr(html, "test &lt;OLED&gt; &amp; co"));
    assert_null(strstr(html, "<OLED>"));
    assert_non_null(strstr(html, "red 255"));
    assert_non_null(strstr(html, "largest error, %"));
    assert_non_null(strstr(html, "extrapolated"));
    assert_null(strstr(html, "Reflection</h2>"));
    assert_non_null(strstr(html, "Measured against fitted"));
    assert_ids_are_whole(html);
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
    assert_true(assert_well_formed(html) > 2000);
    assert_non_null(strstr(html, "Reflection</h2>"));
}

/* ---- errors ----------------------------------------------------------------------------- */

TEST(a_wrong_command_line_says_what_is_wanted) {
    const char *svg = fixture_path(&ips, "e.svg"), *panel = ips.panel_path;
    RUN_FAILS(ERROR_USAGE, "luminanz", panel, "-o", svg, "--kind", "luminanz");
    RUN_FAILS(ERROR_USAGE, "contrast", panel, "-o", svg, "--kind", "luminanz");
    RUN_FAILS(ERROR_USAGE, "wants -o X.svg", panel);
    RUN_FAILS(ERROR_USAGE, ".svg or .png", panel, "-o", fixture_path(&ips, "e.pdf"));
    RUN_FAILS(ERROR_USAGE, "--size is 20x20, required: 160 to 20000", panel, "-o", svg, "--size",
              "20x20");
    RUN_FAILS(ERROR_USAGE, "--measured MANIFEST.json", panel, "-o", svg, "--kind", "fit");
    assert_false(file_exists(svg));
}

TEST(what_a_panel_lacks_is_said) {
    const char *panel = reflects_nothing.panel_path;
    const char *svg = fixture_path(&reflects_nothing, "e.svg");
    RUN_FAILS(ERROR_INPUT, "has no reflection data, which is required for --kind brdf-map", panel,
              "-o", svg, "--kind", "brdf-map");
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
              "mirror");
    RUN_FAILS(ERROR_OUTPUT, "", ips.panel_path, "-o", fixture_path(&ips, "none/x.svg"), "--kind",
              "mirror");
    assert_int_equal(folder_count(ips.folder), before);
}

TEST_PROGRAM(start, end)

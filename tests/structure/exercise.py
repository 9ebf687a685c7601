# SPDX-License-Identifier: Apache-2.0
"""exercise.py [NAME ...] -- the recipes of CONTRIBUTING.md, followed in a copy of the project:
no other file changes, the copy builds, and the tests of its kind hold for what was added.
"""
import os
import shutil
import subprocess
import sys
import tempfile

from models import listed_files
from report import ROOT, Report, places, project_files

FILES = os.path.join(ROOT, "tests", "structure", "exercise")


class Exercise:
    """recipe: its title in CONTRIBUTING.md; most: files that it may list; copied: {file of
    FILES: folder}; edits: file, text that is there once, what stands before it from now on;
    targets: built; tests: run then."""

    def __init__(self, recipe, most, copied, edits, targets, tests):
        self.recipe, self.most, self.copied, self.edits = recipe, most, copied, edits
        self.targets, self.tests = targets, tests


EXERCISES = {
    "dust": Exercise(
        "A surface model", 6, {"dust.h": "shaders", "dust.c": "shaders"},
        [("shaders/bsdf.h", '#include "shaders/glazing.h"\n', '#include "shaders/dust.h"\n'),
         ("shaders/bsdf.h", "    MODEL(DISPLAY, display,",
          "    MODEL(DUST, dust, Dust)" + " " * 68 + "\\\n"),
         ("CMakeLists.txt", "glazing.c metallic_roughness.c", "dust.c "),
         ("src/surface/surface.c", "    } else {\n        set_metallic_roughness(site, surface);",
          "    } else if (m->specular <= 0 && site->metallic <= 0 && site->alpha >= 1)"
          " {\n"
          "        bsdf_be_dust(&surface->bsdf)->grain = spectrum_all(0.3f) * "
          "site->base_color;\n"),
         ("tests/unit/test_shaders.c", "static int make_models(void **state)",
          "static void add_dust(void)\n{\n    Model *model = &models[model_count++];\n"
          '    *model = (Model){.name = "dust", .width = 1};\n'
          "    bsdf_be_dust(&model->bsdf)->grain = ramp(0.05f, 0.3f);\n}\n\n"),
         ("tests/unit/test_shaders.c", "    add_plastics();\n    add_metals();",
          "    add_dust();\n")],
        ["test_shaders", "path"], ["test_shaders"]),
    # The cosine between the eye's ray and the normal.
    "facing": Exercise(
        "A frame layer", 3, {},
        [("src/film/film_sample.h", "    int   part_id;         /*",
          "    float facing;          /* cosine of the ray to the normal, 0 to 1 */\n"),
         ("src/film/layers.h", "    LAYER(ROUNDED, 26,",
          '    LAYER(FACING, 28, FRAME, "facing", "V", mean, FACING)' + " " * 38 + "\\\n"),
         ("src/film/layers.h", '    SUMS(EMITTED, "emitted",',
          '    SUMS(FACING, "facing", "V", LAYER_FACING, AT(facing))' + " " * 38 + "\\\n"),
         ("src/kernel/tile.c", "    sample->part_id = features.part_id;",
          "    sample->facing = fabsf(vec3_dot(features.normal, result->direction));\n")],
        ["test_film", "test_film_merge", "kernel"], ["test_film", "test_film_merge"]),
    # Soot on a material: a share of its base colour is gone.
    "soot": Exercise(
        "A layer of a glTF material", 3, {},
        [("src/scene/scene.h", "    MaterialOverlay *overlay;  /* NULL: none */",
          "    float soot;                /* [0, 1] */\n"),
         ("src/scene/check/material_layers.c", '    {LAYER("KHR_materials_sheen", NULL,',
          '    {LAYER("KHR_materials_soot", NULL,\n'
          '           {"sootFactor", RULE_NUMBER, .max = 1, OF(Material, soot, 0)})},\n'),
         ("src/surface/surface.c", "    if (m->overlay) set_overlay(site, surface, model);",
          "    model->base_color *= spectrum_all(1 - m->soot);\n")],
        ["test_scene_errors", "path"], ["test_scene_errors"]),
    # The width of an eye's pupil.
    "eyes": Exercise(
        "A key of REVIEW.json", 3, {},
        [("src/review/request/request.h", "    ReviewEyeKind kind;\n",
          "    double        pupil_mm; /* 0: of the light */\n"),
         ("src/review/request/request_eyes.c", '    TEXT("proposed_from",',
          '    NUMBER("pupil_mm", RECORD_OPEN, pupil_mm, 1, 9, "Of the pupil, mm."),\n'),
         ("tests/unit/records/review.json", '"proposed_from":', '"pupil_mm": 4, ')],
        ["test_record"], ["test_record"]),
    # The steps of a grey scale between a symbol and its background.
    "grey_steps": Exercise(
        "A quantity of a review", 2, {"ask_grey_steps.c": "src/review"},
        [("src/review/quantity.h", "    Q(STROKE_RATIO, stroke_ratio)",
          "    Q(GREY_STEPS, grey_steps)" + " " * 50 + "\\\n")],
        ["test_findings", "test_profile", "test_judge"],
        ["test_findings", "test_profile", "test_judge"]),
    # White's luminance over the hemisphere.
    "white_mean": Exercise(
        "A derived figure of a panel", 3, {},
        [("src/panel/figures/panel_figure.h", "/* White's luminance over that of black",
          "/* White's, the mean over the hemisphere with the cosine. */\n"
          "double panel_figure_white_mean(const Panel *panel);\n\n"),
         ("src/panel/figures/panel_figure.c", "static double contrast_at(",
          "double panel_figure_white_mean(const Panel *panel) {\n"
          "    return (double)panel_mean_luminance(panel, PANEL_WHITE);\n}\n\n"),
         ("src/cli/panel/panel_facts.c", '    put(out, "white_cd_m2", white.xyz[1]);',
          '    put(out, "white_mean_cd_m2", panel_figure_white_mean(panel));\n'),
         ("src/cli/panel/panel_facts.c", '    {.key = "display.white_xy",',
          '    COLUMN_DIGITS("display.white_mean_cd_m2", "white, mean", "cd/m2", 4),\n')],
        ["test_panel_report"], ["test_panel_report"]),
    # White alone, over a logarithmic axis.
    "white_alone": Exercise(
        "A chart of a panel", 1, {},
        [("src/plot/panel/emission_charts.c", "static void add_contrast(PlotCharts",
          "static void add_white(PlotCharts *charts, const PlotData *s) {\n"
          "    Chart *chart = chart_new(CHART_AXES, \"White alone\", \"θ\", \"Luminance, cd/m²\","
          "\n                             s->arena);\n"
          "    chart->x.high = 80;\n    chart->y = (ChartAxis){1, 1000, .is_log = true};\n"
          "    chart_series(chart, \"White\", (Stroke){INK_TEXT, 1.9, DASH_NONE});\n"
          "    for (int deg = 0; deg <= 80; deg++)\n"
          "        chart_point(chart, deg, white_at(s, radians_from_degrees(deg), 0));\n"
          "    chart->caption = \"White's luminance.\";\n    plot_add(charts, chart);\n}\n\n"),
         ("src/plot/panel/emission_charts.c", "if (plot_wants(kind, PLOT_CONTRAST))",
          "if (plot_wants(kind, PLOT_SECTIONS)) add_white(charts, data);\n    ")],
        ["test_panel_report"], ["test_panel_report"]),
    # The width of a symbol's strokes.
    "stroke_arcmin": Exercise(
        "A figure of a case", 7, {},
        [("src/review/verdict.h", "    double  stroke_ratio; ",
          "    double  stroke_arcmin; /* width of its strokes */\n"),
         ("src/review/verdict.c", "c.height_arcmin = c.stroke_ratio =", "c.stroke_arcmin = "),
         ("src/review/run/cases.c", "    c->stroke_ratio = symbol_stroke_ratio(look->symbol);",
          "    c->stroke_arcmin = c->height_arcmin * symbol_stroke_ratio(look->symbol);\n"),
         ("src/review/output/case_json.c", 'LATER("stroke_ratio", FIGURE,',
          '    LATER("stroke_arcmin", FIGURE, ReviewCase, stroke_arcmin),\n'),
         ("assets/schemas/json_answers.md", "`height_arcmin`, `stroke_ratio` (stroke",
          "`stroke_arcmin`, "),
         ("tests/unit/test_review_output.c", '"stroke_ratio", "rests_on",', '"stroke_arcmin", '),
         ("assets/pages/card.html", "    {{#height_arcmin}}\n",
          "    {{#stroke_arcmin}}\n    <dt>Stroke</dt><dd>{{stroke_arcmin|figure}} arc minutes"
          "</dd>\n    {{/stroke_arcmin}}\n")],
        ["test_review_page", "test_review_output"], ["test_review_page", "test_review_output"]),
}


def git(folder, *words):
    own = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], env=own,
                          cwd=folder, capture_output=True, text=True, check=True).stdout


def copy_project(folder):
    for name in project_files():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        shutil.copy(os.path.join(ROOT, name), path)
    git(folder, "init", "-q")
    git(folder, "add", "-A")
    git(folder, "commit", "-q", "-m", "as it is")


def edit(report, folder, exercise):
    for name, place in exercise.copied.items():
        shutil.copy(os.path.join(FILES, name), os.path.join(folder, place))
    for name, there, before in exercise.edits:
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        found = places(there, text)
        report.claim(len(found) == 1, f"{name}: {len(found)} times {there!r}")
        with open(path, "w", encoding="utf-8") as file:
            at = found[0].start() if found else 0
            file.write(text[:at] + before + text[at:])


def run(report, folder, *words):
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    printed = done.stdout + done.stderr
    return report.claim(done.returncode == 0, f"{' '.join(words)}: {printed[-800:]}")


def perform(report, name, exercise, folder):
    edit(report, folder, exercise)
    changed = {line[3:] for line in git(folder, "status", "--porcelain").splitlines()}
    listed = {path.replace("NAME", name) for path in listed_files(exercise.recipe)}
    report.claim(changed == listed, f"{name}: changed are {sorted(changed)}, listed "
                                    f"{sorted(listed)}")
    report.claim(len(changed) <= exercise.most, f"{name}: {len(changed)} files")
    if run(report, folder, "cmake", "--build", ".build/release", "-j2", "--target",
           *exercise.targets):
        for test in exercise.tests:
            run(report, folder, f".build/release/{test}")
    git(folder, "checkout", "-q", "-f", "HEAD")
    git(folder, "clean", "-q", "-f", "-d", "-e", ".build")


def main():
    report = Report()
    names = sys.argv[1:] or list(EXERCISES)
    with tempfile.TemporaryDirectory() as folder:
        copy_project(folder)
        if run(report, folder, "cmake", "--preset", "release"):
            for name in names:
                perform(report, name, EXERCISES[name], folder)
        run(report, folder, sys.executable, "tests/structure/models.py")
    report.finish()


if __name__ == "__main__":
    main()

/* SPDX-License-Identifier: Apache-2.0 */
/* The models of other projects: whole ones load, faulty ones are reported. Skipped, and said
 * so, where the shared data are not there. */
#include "fixture.h"

#include <dirent.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "scene/load/scene_load.h"

#define CORPUS SHARED_DATA_DIR "/gltf"

typedef struct Walk {
    void (*visit)(const char *path, void *data);
    void *data;
} Walk;

static void walk_folder(const char *folder, const Walk *walk) {
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        char path[1024];
        struct stat info;
        snprintf(path, sizeof path, "%s/%s", folder, entries[i]->d_name);
        const char *ending = path_ending(path);
        bool is_dot = entries[i]->d_name[0] == '.';
        free(entries[i]);
        if (is_dot || stat(path, &info) != 0) continue;
        if (S_ISDIR(info.st_mode)) walk_folder(path, walk);
        else if (!strcmp(ending, ".gltf") || !strcmp(ending, ".glb")) walk->visit(path, walk->data);
    }
    if (count >= 0) free(entries);
}

static void need_corpus(void) {
    if (file_exists(CORPUS)) return;
    print_message("skipped: no shared data at %s\n", CORPUS);
    skip();
}

/* How a file was taken: its problems by kind, and the first error. */
typedef struct Verdict {
    int errors, warnings;
    char message[1024];
    uint32_t triangles;
} Verdict;

static Verdict verdict_of(const char *path) {
    Verdict verdict = {0};
    Scene *scene;
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)4 << 30);
    Problems problems = problems_start(&arena);
    if (scene_load(&(SceneOptions){.paths = &path, .path_count = 1}, &arena, &problems, &scene,
                   why())) {
        verdict.triangles = scene->triangle_count;
        scene_close(scene);
    } else {
        snprintf(verdict.message, sizeof verdict.message, "%s", why()->text);
    }
    verdict.errors = problems.error_count;
    verdict.warnings = problems.count - problems.error_count;
    return verdict;
}

typedef struct Tally {
    const char *codes; /* README.md of src/scene/check */
    int whole, faulty, refused, warned, exceptions;
} Tally;

/* Errors of a report, with warnings of what README.md of src/scene/check says is refused; and of
 * those how many it says do not matter. */
static int errors_of(const json_t *document, const char *codes, int *no_matter) {
    const json_t *messages = json_object_get(json_object_get(document, "issues"), "messages");
    const json_t *message;
    size_t i;
    int count = 0;
    *no_matter = 0;
    json_array_foreach(messages, i, message) {
        char row[128];
        const char *code = json_string_value(json_object_get(message, "code"));
        json_int_t severity = json_integer_value(json_object_get(message, "severity"));
        snprintf(row, sizeof row, "| `%s` | refused |", code);
        if (severity > 1 || (severity == 1 && !strstr(codes, row))) continue;
        snprintf(row, sizeof row, "| `%s` | no matter |", code);
        count++;
        *no_matter += strstr(codes, row) != NULL;
    }
    return count;
}

/* Beside each model of the validator lies its report. */
static void visit_reported(const char *path, void *data) {
    Tally *tally = data;
    char report[1100];
    snprintf(report, sizeof report, "%s.report.json", path);
    json_auto_t *document = json_load_file(report, 0, NULL);
    assert_true(json_is_array(json_object_get(json_object_get(document, "issues"), "messages")));
    int no_matter, errors = errors_of(document, tally->codes, &no_matter);
    bool is_whole = errors == 0;
    Verdict verdict = verdict_of(path);
    bool is_right = is_whole ? verdict.errors == 0
                             : verdict.errors + verdict.warnings > 0 || errors == no_matter;
    tally->whole += is_whole;
    tally->faulty += !is_whole;
    tally->refused += verdict.errors > 0;
    tally->warned += !is_whole && !verdict.errors && verdict.warnings;
    tally->exceptions += !is_right;
    if (!is_right)
        print_message("%s: %s %s\n", path, is_whole ? "whole but refused:" : "faulty but silent",
                      verdict.message);
}

TEST(the_validator_s_verdicts_are_ours) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 20);
    Tally tally = {.codes = read_text(PROJECT_DIR "/src/scene/check/README.md", &arena)};
    need_corpus();
    walk_folder(CORPUS "/validator-corpus", &(Walk){visit_reported, &tally});
    print_message("validator corpus: %d whole models load, %d faulty: %d refused, %d warned of\n",
                  tally.whole, tally.faulty, tally.refused, tally.warned);
    assert_true(tally.whole > 0 && tally.faulty > 0);
    assert_int_equal(tally.exceptions, 0);
}

/* What is wrong with the faulty models among the others; every other one must load. */
static const struct {
    const char *name, *text;
} REFUSED[] = {
    {"/MissingBin/BoxTextured.gltf", "cannot be opened: No such file"},
    {"/IncorrectVertexArrays/Cube.gltf", "takes bytes 504 to 936 of a buffer of 514"},
    {"/TestNoRootNode/NoScene.gltf", "is 0, but there are 0 in scenes"},
    {"/tests/issue-416.gltf", "a version like \"2.0\" is required"},
    {"/BoundsChecking/integer-out-of-bounds.gltf", "is 1e+300, an integer"},
    {"/BoundsChecking/invalid-buffer-index.gltf", "is 1, but there is 1 in buffers"},
    {"/BoundsChecking/invalid-buffer-view-index.gltf", "is 0, but there are 0 in buffers"},
    {"/BoundsChecking/invalid-primitive-indices.gltf", "is 1, but there is 1 in accessors"},
};

static const char *wanted_refusal(const char *path) {
    for (size_t i = 0; i < sizeof REFUSED / sizeof *REFUSED; i++)
        if (strstr(path, REFUSED[i].name)) return REFUSED[i].text;
    return NULL;
}

static void visit_other(const char *path, void *data) {
    Tally *tally = data;
    const char *wanted = wanted_refusal(path);
    Verdict verdict = verdict_of(path);
    bool is_right = wanted ? strstr(verdict.message, wanted) != NULL : verdict.errors == 0;
    tally->whole += !wanted;
    tally->refused += wanted != NULL;
    tally->exceptions += !is_right;
    if (!is_right) print_message("%s: %s\n", path, verdict.message);
}

TEST(other_importers_models_load_or_are_refused_by_name) {
    static const char *const FOLDERS[] = {"tinygltf", "assimp", "3dc", "compressed"};
    Tally tally = {0};
    need_corpus();
    for (int i = 0; i < 4; i++) {
        char folder[1024];
        snprintf(folder, sizeof folder, CORPUS "/%s", FOLDERS[i]);
        walk_folder(folder, &(Walk){visit_other, &tally});
    }
    print_message("other models: %d load, %d are refused for the reason they should\n", tally.whole,
                  tally.refused);
    assert_int_equal(tally.refused, sizeof REFUSED / sizeof *REFUSED);
    assert_int_equal(tally.exceptions, 0);
}

TEST(the_vehicles_load_whole) {
    need_corpus();
    Verdict cessna = verdict_of(CORPUS "/cockpit/c172p_cockpit.glb");
    assert_int_equal(cessna.errors + cessna.warnings, 0);
    assert_int_equal(cessna.triangles, 123636);
    Verdict car = verdict_of(CORPUS "/cockpit/torcs_car8-trb1.glb");
    assert_int_equal(car.errors, 0);
    assert_int_equal(car.triangles, 4029);
}

TEST_PROGRAM(NULL, NULL)

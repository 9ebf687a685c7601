/* SPDX-License-Identifier: Apache-2.0 */
/* What decides a sample's value is in a render's identity, and nothing else; two identities say
 * where they differ. */
#include "fixture.h"

#include "base/count.h"
#include "cli/render/render_identity.h"
#include "render/identity.h"
#include "cli/render/render_resume.h"

/* ---- what is in it ----------------------------------------------------------------------- */

/* Everything that an identity is made of. */
typedef struct Subject {
    RenderRequest request;
    Scene scene;
    SceneCamera camera;
    Kernel kernel;
    const char *inputs[2];
    uint64_t hashes[2];
    Texture texture;
    unsigned char pixels[4];
    Display display;
    SceneOverride content;
} Subject;

static void fill(Subject *s) {
    *s = (Subject){
        .request = {.render = {.width = 64,
                               .height = 36,
                               .max_bounces = 64,
                               .layers = LAYER_DEPTH | LAYER_ID,
                               .end_sample = 10}},
        .camera = {.is_perspective = true, .yfov = 0.5f, .world_from_camera = transform_identity()},
        .kernel = {.isa = "sse2"},
        .inputs = {"a/scene.gltf", "panels/ips.panel"},
        .hashes = {1, 2},
        .display = {.name = "cluster", .panel_path = "panels/ips.panel", .level = 1},
        .content = {.material = "cluster", .value = "map.png"}};
    s->request.scene.contents = &s->content;
    s->request.scene.content_count = 1;
    s->texture.image = (Image){1, 1, IMAGE_RGBA8, s->pixels};
    s->scene.inputs = s->inputs;
    s->scene.input_hashes = s->hashes;
    s->scene.input_count = 2;
    s->scene.textures = &s->texture;
    s->scene.texture_count = 1;
    s->scene.displays = &s->display;
    s->scene.display_count = 1;
    s->scene.environment = (Environment){.kind = ENVIRONMENT_SKY,
                                         .daylight = daylight_input_default(DAYLIGHT_CLEAR),
                                         .forward = {0, 0, -1}};
    s->scene.environment.daylight.has_time = true;
    s->scene.environment.daylight.when = (SkyTime){2026, 6, 21, 8, 30, 0, 2};
}

typedef struct Change {
    const char *difference; /* the beginning; NULL: none */
    void (*make)(Subject *s);
} Change;

static void seed(Subject *s) {
    s->request.render.seed = 7;
}
static void size(Subject *s) {
    s->request.render.width = 65;
}
static void bounces(Subject *s) {
    s->request.render.max_bounces = 1;
}
static void learnt(Subject *s) {
    s->request.field_hash = 0xabc;
}
static void layers(Subject *s) {
    s->request.render.layers |= LAYER_UV;
}
static void isa(Subject *s) {
    s->kernel.isa = "avx2";
}
static void content(Subject *s) {
    s->hashes[0] = 0xabc;
}
static void one_less(Subject *s) {
    s->scene.input_count = 1;
}
static void picture(Subject *s) {
    s->pixels[3] = 1;
}
static void level(Subject *s) {
    s->display.level = nextafterf(1, 2);
}
static void panel(Subject *s) {
    s->display.panel_path = "other/oled.panel";
}
static void shown(Subject *s) {
    s->content.value = "night.png";
}
static void field(Subject *s) {
    s->camera.yfov = nextafterf(0.5f, 1);
}
static void place(Subject *s) {
    s->camera.world_from_camera.origin.y = 1;
}
static void flat(Subject *s) {
    s->camera.is_perspective = false;
}
static void round_view(Subject *s) {
    s->camera.fisheye = FISHEYE_EQUISOLID;
}
static void kind(Subject *s) {
    s->scene.environment.kind = ENVIRONMENT_NONE;
}
static void air(Subject *s) {
    s->scene.environment.daylight.turbidity += 1e-13;
}
static void minute(Subject *s) {
    s->scene.environment.daylight.when.minute++;
}
static void ground(Subject *s) {
    s->scene.environment.daylight.floor = FLOOR_SEA;
}
static void billows(Subject *s) {
    s->scene.environment.daylight.cloud_relief_m = 300;
}
static void moon(Subject *s) {
    s->scene.environment.daylight.no_moon = true;
}
static void sun(Subject *s) {
    s->scene.environment.has_sun = true;
}
static void heading(Subject *s) {
    s->scene.environment.heading = 1;
}
static void samples(Subject *s) {
    s->request.render.first_sample = 5;
}
static void more(Subject *s) {
    s->request.render.end_sample = 500;
}
static void crop(Subject *s) {
    s->request.render.crop = (FilmRect){0, 0, 3, 3};
}
static void noise(Subject *s) {
    s->request.render.noise = 0.1;
}
static void threads(Subject *s) {
    s->request.render.threads = 9;
}
static void sky_threads(Subject *s) {
    s->scene.environment.daylight.threads = 9;
}
static void output(Subject *s) {
    s->request.output = "b.exr";
}
static void folder(Subject *s) {
    s->inputs[0] = "/elsewhere/scene.gltf";
}
static void far(Subject *s) {
    s->camera.zfar = 5;
}

static const Change changes[] = {
    {"isa: sse2 there, avx2 here", isa},
    {"size: 64x36 there, 65x36 here", size},
    {"seed: 0 there, 7 here", seed},
    {"max bounces: 64 there, 1 here", bounces},
    {"field: none there, 0000000000000abc here", learnt},
    {"layers: uv here, not there", layers},
    {"input 0: scene.gltf 0000000000000001 there, scene.gltf 0000000000000abc here", content},
    {"input 1: ips.panel 0000000000000002 there, none here", one_less},
    {"decoded pictures: ", picture},
    {"content 0: cluster=map.png there, cluster=night.png here", shown},
    {"display 0: cluster, level 1, ips.panel 0000000000000002 there, cluster, level "
     "1.00000012, ips.panel 0000000000000002 here",
     level},
    {"display 0: cluster, level 1, ips.panel 0000000000000002 there, cluster, level 1, "
     "oled.panel here",
     panel},
    {"environment: sky there, none here", kind},
    {"when: 2026-06-21T08:30:0+2h there, 2026-06-21T08:31:0+2h here", minute},
    {"turbidity: 2.5 there, 2.500000000000", air},
    {"ground: land there, sea here", ground},
    {"cloud relief m: none there, 300 here", billows},
    {"moon: in its place there, left out here", moon},
    {"sun: not set there, set here", sun},
    {"heading: 0 there, 1 here", heading},
    {"camera: perspective there, orthographic here", flat},
    {"camera: perspective there, fisheye, equisolid here", round_view},
    {"camera yfov: 0.5 there, 0.50000006 here", field},
    {"camera origin: 0 0 0 there, 0 1 0 here", place},
    {NULL, samples},
    {NULL, more},
    {NULL, crop},
    {NULL, noise},
    {NULL, threads},
    {NULL, sky_threads},
    {NULL, output},
    {NULL, folder},
    {NULL, far},
};

static const char *identity_of(Subject *s, Arena *arena) {
    return render_identity(&s->request, &s->scene, &s->camera, &s->kernel, arena);
}

MEMORY_TEST(what_decides_a_sample_is_in_it_and_nothing_else) {
    Subject one;
    fill(&one);
    const char *there = identity_of(&one, arena);
    const char *begin =
        arena_format(arena, "version\t%s\nsources\t%s\nisa\tsse2\nray tracer\tEmbree ",
                     PARHELION_VERSION, SOURCES_HASH);
    assert_ptr_equal(strstr(there, begin), there);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        Subject other;
        fill(&other);
        changes[i].make(&other);
        const char *wanted = changes[i].difference;
        const char *here = identity_of(&other, arena);
        const char *found = identity_difference(there, here, arena);
        if (!wanted != !found || (wanted && strncmp(found, wanted, strlen(wanted)) != 0))
            fail_msg("change %zu: \"%s\", required: \"%s\"", i, found ? found : "none",
                     wanted ? wanted : "none");
    }
}

MEMORY_TEST(a_name_cannot_begin_a_line) {
    Subject one;
    fill(&one);
    one.display.name = "x\nseed\t9";
    assert_non_null(strstr(identity_of(&one, arena), "display 0\tx?seed?9, level 1, "));
}

/* ---- comparing --------------------------------------------------------------------------- */

MEMORY_TEST(the_first_line_that_differs_is_named) {
    static const struct {
        const char *there, *here, *text;
    } cases[] = {
        {"", "", NULL},
        {"a\t1\nb\t2\n", "a\t1\nb\t2\n", NULL},
        {"a\t1\nb\t2\n", "a\t1\nb\t3\n", "b: 2 there, 3 here"},
        {"a\t1\nb\t2\n", "a\t9\nb\t3\n", "a: 1 there, 9 here"},
        {"a\t1\nb\t2\n", "a\t1\n", "b: 2 there, none here"},
        {"a\t1\n", "a\t1\nb\t2\n", "b: none there, 2 here"},
        {"a\t1\nx\t5\nb\t2\n", "a\t1\nb\t2\n", "x: 5 there, none here"},
        {"a\t1\nb\t2\n", "a\t1\nx\t5\nb\t2\n", "x: none there, 5 here"},
        {"a\t1\n", "a\t11\n", "a: 1 there, 11 here"},
        {"a\t1\n", "aa\t1\n", "a: 1 there, none here"},
        {"a\t\n", "a\t1\n", "a:  there, 1 here"},
        {"a", "a\t1\n", "a: none there, 1 here"}, /* from a file: anything may come */
        {"a\t1", "a\t1\n", NULL},
        {"\n\n", "a\t1\n", "a: none there, 1 here"},
        {"layers\txyz,display.mirror,uv\n", "layers\txyz,display,uv\n",
         "layers: display.mirror there, not here; display here, not there"},
        {"layers\txyz,id,uv\n", "layers\tuv\n", "layers: xyz,id there, not here"},
        {"layers\t\n", "layers\tuv\n", "layers: uv here, not there"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *text = identity_difference(cases[i].there, cases[i].here, arena);
        if (!text != !cases[i].text || (text && strcmp(text, cases[i].text) != 0))
            fail_msg("case %zu: \"%s\"", i, text ? text : "none");
    }
}

/* ---- a checkpoint of another program ----------------------------------------------------- */

MEMORY_TEST(another_version_is_refused_by_name) {
    Error err = {0};
    const char *path = in_folder("a.checkpoint");
    Film *film = film_create(2, 1, (FilmRect){0, 0, 2, 1}, 0, NULL, arena);
    FilmSample sample = {.xyz = {1, 1, 1}};
    film_add_sample(film, 0, 0, &sample);
    film_add_sample(film, 1, 0, &sample);
    Checkpoint what = {
        .path = path, .identity = "version\t0.0.9\nseed\t0\n", .done = film_part_of(film, 0, 1)};
    assert_true(checkpoint_write(&what, film, *arena, &err));
    const RenderRequest request = {.cli = {.quiet = true},
                                   .checkpoint = path,
                                   .resumes = true,
                                   .render = {.crop = {0, 0, 2, 1}, .end_sample = 9}};
    const Checkpoint *found;
    const char *here = "version\t" PARHELION_VERSION "\nseed\t0\n";
    bool done = render_find_checkpoint(&request, here, arena, &found, &err);
    bool same = render_find_checkpoint(&request, what.identity, arena, &found, &err);
    unlink(path);
    assert_false(done);
    assert_int_equal(err.code, ERROR_MACHINE);
    assert_string_equal(err.file, path);
    assert_string_equal(
        err.text,
        "was made by another program or instruction set: version: 0.0.9 there, " PARHELION_VERSION
        " here — go on where it was made, or by its --isa; "
        "leave out --resume to begin anew");
    assert_true(same && found);
}

MEMORY_TEST(an_instruction_set_is_another_program_and_a_seed_is_not) {
    static const struct {
        Change change;
        bool is_same;
    } cases[] = {{{NULL, isa}, false}, {{NULL, seed}, true}, {{NULL, content}, true}};
    Subject one;
    fill(&one);
    const char *there = identity_of(&one, arena);
    assert_true(identity_same_program(there, there));
    assert_false(identity_same_program(there, "version\t0\n"));
    for (int i = 0; i < COUNT_OF(cases); i++) {
        Subject other;
        fill(&other);
        cases[i].change.make(&other);
        assert_int_equal(identity_same_program(there, identity_of(&other, arena)),
                         cases[i].is_same);
    }
}

TEST_PROGRAM(make_folder, remove_folder)

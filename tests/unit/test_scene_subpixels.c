/* SPDX-License-Identifier: Apache-2.0 */
/* A display's "subpixels": what is read, of the scene and of its panel, and what is said of
 * wrong ones. */
#include "panel_fixture.h"

#include "base/count.h"
#include "gltf_maker.h"

#define PLACE "/materials/0/extensions/PARHELION_display"
#define DIVIDED(body)                                                                          \
    "'extensionsUsed':['PARHELION_display'],'materials':[{'name':'cluster','extensions':{"     \
    "'PARHELION_display':{'panel':'none.panel','subpixels':" body "}}}]"

static const FaultCase FAULTS[] = {
    {DIVIDED("{}"), PLACE "/subpixels", "\"layout\" is missing"},
    {DIVIDED("'stripe'"), PLACE "/subpixels", "is \"stripe\", an object is required"},
    {DIVIDED("{'layout':'delta'}"), PLACE "/subpixels/layout",
     "is \"delta\", one of stripe|pentile|none is required"},
    {DIVIDED("{'layout':3}"), PLACE "/subpixels/layout",
     "is 3, one of stripe|pentile|none is required"},
    {DIVIDED("{'layout':'stripe','fill':0}"), PLACE "/subpixels/fill",
     "is 0, a number from 0.01 to 1 is required"},
    {DIVIDED("{'layout':'stripe','fill':1.5}"), PLACE "/subpixels/fill",
     "is 1.5, a number from 0.01 to 1"},
    {DIVIDED("{'layout':'stripe','fill':'full'}"), PLACE "/subpixels/fill", "is \"full\", a n"},
    {DIVIDED("{'layout':'stripe','columns':8}"), PLACE "/subpixels/columns",
     "is there without \"rows\""},
    {DIVIDED("{'layout':'pentile','rows':8}"), PLACE "/subpixels/rows",
     "is there without \"columns\""},
    {DIVIDED("{'layout':'pentile','rows':8,'columns':0}"), PLACE "/subpixels/columns",
     "is 0, an integer from 1 to 65536"},
    {DIVIDED("{'layout':'pentile','rows':2.5,'columns':8}"), PLACE "/subpixels/rows",
     "is 2.5, an integer from 1 to 65536"},
    {DIVIDED("{'layout':'none','fill':1}"), PLACE "/subpixels/fill",
     "is there beside the layout \"none\""},
    {DIVIDED("{'layout':'none','columns':9,'rows':4}"), PLACE "/subpixels/rows",
     "is there beside the layout \"none\""},
    {DIVIDED("{'layout':'pentile','fil':1}"), PLACE "/subpixels/fil",
     "nearest known one is 'fill'"},
    {DIVIDED("{'layout':'stripe'}"), PLACE "/panel",
     "its \"subpixels\" need \"columns\" and \"rows\" where neither panel nor content tells "
     "them"},
};

TEST_WITH(every_fault_is_named_with_its_place, maker_reset, NULL)
{
    maker_expect_faults(FAULTS, COUNT_OF(FAULTS), NULL, 0);
}

/* A PNG of 3 x 2 pixels. */
#define SCREEN                                                                                 \
    "data:image/png;base64,"                                                                   \
    "iVBORw0KGgoAAAANSUhEUgAAAAMAAAACCAIAAAASFvFNAAAAEElEQVR42mP438AAQQxwFgBf0gj7"             \
    "ZoGl2gAAAABJRU5ErkJggg=="

/* Of a display that shows it; its panel is not there, which is reported. */
static const Display *shown(const char *body)
{
    Found found = maker_survey_file(maker_gltf(NULL, 0,
        maker_format("'extensionsUsed':['PARHELION_display'],'images':[{'uri':'" SCREEN "'}],"
                     "'textures':[{'source':0}],'materials':[{'name':'cluster','extensions':{"
                     "'PARHELION_display':{'panel':'none.panel','content':{'index':0}%s}}}]",
                     body)));
    assert_int_equal(found.problems.count, 1);
    assert_non_null(maker_find(&found, PLACE "/panel", "display \"cluster\": "));
    return &found.scene->displays[0];
}

TEST_WITH(pixels_are_the_contents_unless_they_are_counted, maker_reset, NULL)
{
    const Subpixels *own = shown(",'subpixels':{'layout':'pentile'}")->subpixels;
    assert_int_equal(own->layout, SUBPIXELS_PENTILE);
    assert_near(own->fill, 1, 0);
    assert_int_equal(own->pixels[0], 3);
    assert_int_equal(own->pixels[1], 2);
    const Subpixels *counted =
        shown(",'subpixels':{'layout':'stripe','fill':0.5,'columns':9,'rows':4}")->subpixels;
    assert_int_equal(counted->layout, SUBPIXELS_STRIPE);
    assert_near(counted->fill, 0.5, 0);
    assert_int_equal(counted->pixels[0], 9);
    assert_int_equal(counted->pixels[1], 4);
    assert_null(shown("")->subpixels);
    assert_null(shown(",'subpixels':{'layout':'none'}")->subpixels);
}

/* ---- the panel's ------------------------------------------------------------------------- */

/* Panels that state the number of their pixels, that do not, and that state no sub-pixels. */
enum { COUNTED, UNCOUNTED, EVEN, PANELS };
static Fixture panels[PANELS];

#define WHITE "\"emission\": {\"white\": \"white.csv\"}"

static int start(void **state)
{
    static const char *const manifests[PANELS] = {
        "{" WHITE ", \"pixels\": [1920, 720],"
        "\"subpixels\": {\"layout\": \"pentile\", \"fill\": 0.6}}",
        "{" WHITE ", \"subpixels\": {\"layout\": \"stripe\"}}",
        "{" WHITE ", \"pixels\": [1920, 720]}"};
    FitOptions options = fit_options_default();
    options.level = 2;
    options.force = true;
    for (int i = 0; i < PANELS; i++) {
        fixture_folder(&panels[i]);
        fixture_file(&panels[i], "white.csv",
                     "theta,phi,X,Y,Z\n0,0,95,100,108\n50,0,60,70,75\n");
        fixture_read(&panels[i], fixture_file(&panels[i], "MANIFEST.json", manifests[i]));
        fixture_fit(&panels[i], &options);
    }
    return maker_start(state);
}

static int end(void **state)
{
    for (int i = 0; i < PANELS; i++) fixture_end(&panels[i]);
    return maker_end(state);
}

/* A display of this panel on a screen of 3 x 2 pixels; members: of its extension, behind its
 * content. NULL: a material of the core that --panel makes one. */
static Found with_panel(int panel, const char *members)
{
    const char *material =
        members ? arena_format(&maker.arena,
                               "'extensionsUsed':['PARHELION_display'],'materials':[{'name':"
                               "'cluster','extensions':{'PARHELION_display':{%s}}}]", members)
                : "'materials':[{'name':'cluster','emissiveTexture':{'index':0}}]";
    const char *path = maker_gltf(NULL, 0, arena_format(&maker.arena,
                                  "'images':[{'uri':'" SCREEN "'}],'textures':[{'source':0}],"
                                  "%s", material));
    SceneOverride over = {.material = "cluster", .value = panels[panel].panel_path};
    SceneOptions  options = {.paths = &path, .path_count = 1, .panels = &over,
                             .panel_count = 1};
    return maker_survey(&options);
}

TEST_WITH(the_panels_sub_pixels_hold_unless_the_scene_says_other, maker_reset, NULL)
{
#define CONTENT "'content':{'index':0}"
#define SCENE_SAYS(text) CONTENT ",'subpixels':{" text "}"
    static const struct {
        int         panel;
        const char *members;
        Subpixels   wanted; /* SUBPIXELS_NONE: the display has none */
    } cases[] = {
        {COUNTED, CONTENT, {SUBPIXELS_PENTILE, 0.6f, {1920, 720}}},
        {COUNTED, "'level':1", {SUBPIXELS_PENTILE, 0.6f, {1920, 720}}},
        {COUNTED, NULL, {SUBPIXELS_PENTILE, 0.6f, {1920, 720}}},
        {COUNTED, SCENE_SAYS("'layout':'pentile','fill':0.6,'columns':1920,'rows':720"),
         {SUBPIXELS_PENTILE, 0.6f, {1920, 720}}},
        {COUNTED, SCENE_SAYS("'layout':'stripe','fill':0.5,'columns':9,'rows':4"),
         {SUBPIXELS_STRIPE, 0.5f, {9, 4}}},
        {COUNTED, SCENE_SAYS("'layout':'stripe'"), {SUBPIXELS_STRIPE, 1, {3, 2}}},
        {COUNTED, SCENE_SAYS("'layout':'none'"), {SUBPIXELS_NONE, 0, {0, 0}}},
        {UNCOUNTED, CONTENT, {SUBPIXELS_STRIPE, 1, {3, 2}}},
        {UNCOUNTED, NULL, {SUBPIXELS_STRIPE, 1, {3, 2}}},
        {EVEN, CONTENT, {SUBPIXELS_NONE, 0, {0, 0}}},
        {EVEN, SCENE_SAYS("'layout':'pentile'"), {SUBPIXELS_PENTILE, 1, {3, 2}}},
    };
    for (int i = 0; i < COUNT_OF(cases); i++) {
        Found found = with_panel(cases[i].panel, cases[i].members);
        for (int k = 0; k < found.problems.count; k++)
            if (found.problems.list[k].severity == SEVERITY_ERROR)
                fail_msg("row %d: %s", i, found.problems.list[k].message);
        const Subpixels *own = found.scene->displays[0].subpixels;
        assert_int_equal(own != NULL, cases[i].wanted.layout != SUBPIXELS_NONE);
        if (own) assert_memory_equal(own, &cases[i].wanted, sizeof *own);
    }
    Found found = with_panel(UNCOUNTED, "'level':1");
    assert_non_null(maker_find(&found, "", "neither panel nor content tells them"));
}

TEST_PROGRAM(start, end)

/* SPDX-License-Identifier: Apache-2.0 */
/* Our extensions in extras, as an object or as a text of JSON: read as the extension is, and
 * what is wrong with them reported where it stands. */
#include "check.h"

#include "base/count.h"
#include "gltf_maker.h"

#define PLACE "/materials/0/extras/PARHELION_display"
#define MARKED(value) \
    "'materials':[{'name':'cluster','extras':{'PARHELION_display':" value ",'note':7}}]"
#define ALSO(extension) \
    "'extensionsUsed':['PARHELION_display'],'materials':[{'extensions':{'PARHELION_display':" extension \
    "},'extras':{'PARHELION_display':{'panel':'none.panel'}}}]"
#define Q "\\\"" /* a quotation mark inside a text */
#define IN_TEXT(members) "'{" Q "panel" Q ":" Q "none.panel" Q members "}'"

static const FaultCase FAULTS[] = {
    {MARKED("{'panel':'none.panel'}"), PLACE "/panel", "display \"cluster\": "},
    {MARKED("{'panel':'none.panel','level':-1}"), PLACE "/level", "is -1, a number of at least 0"},
    {MARKED("{'panel':'none.panel','level':'high'}"), PLACE "/level",
     "is \"high\", a number of at least 0"},
    {MARKED("{'panell':'none.panel'}"), PLACE "/panell",
     "unknown key; the nearest known one is 'panel'"},
    {MARKED("{'panel':'none.panel','content':{'index':0}}"), PLACE "/content/index",
     "is 0, but there are 0 in textures"},
    {MARKED("{'panel':'none.panel','content':3}"), PLACE "/content", "is 3, an object"},
    {MARKED("{'panel':'../../none.panel'}"), PLACE "/panel", "--root"},
    {MARKED("{}"), PLACE, "\"panel\" is missing"},
    {MARKED("7"), PLACE, "is 7, an object is required"},
    {MARKED("null"), PLACE, "is null, an object is required"},
    {MARKED("[{'panel':'none.panel'}]"), PLACE, "is an array of 1, an object is required"},
    /* as texts */
    {MARKED(IN_TEXT("")), PLACE "/panel", "display \"cluster\": "},
    {MARKED(IN_TEXT("," Q "level" Q ":-1")), PLACE "/level", "is -1, a number of at least 0"},
    {MARKED(IN_TEXT("," Q "levl" Q ":1")), PLACE "/levl", "nearest known one is 'level'"},
    {MARKED("'none.panel'"), PLACE, "is a text that is no JSON object: not valid JSON"},
    {MARKED("''"), PLACE, "is a text that is no JSON object: not valid JSON"},
    {MARKED("'{" Q "panel" Q ":'"), PLACE, "is a text that is no JSON object: not valid JSON"},
    {MARKED("'{" Q "level" Q ":1," Q "level" Q ":2}'"), PLACE, "stands twice in one object"},
    {MARKED("'[1,2]'"), PLACE, "is an array of 2, an object is required"},
    {MARKED("'" Q "text" Q "'"), PLACE, "is \"text\", an object is required"},
    /* both, and elsewhere */
    {ALSO("{'panel':'none.panel'}"), PLACE, "stands in extras and in extensions; one is required"},
    {ALSO("{}"), PLACE, "stands in extras and in extensions; one is required"},
    {"'materials':[{'extras':{'PARHELION_dispaly':{}}}]", "/materials/0/extras/PARHELION_dispaly",
     "names no extension for a material"},
    {"'nodes':[{'extras':{'PARHELION_display':'{}'}}]", "/nodes/0/extras/PARHELION_display",
     "has no meaning on a node and is skipped"},
    {"'scenes':[{'extras':{'PARHELION_display':{}}}]", "/scenes/0/extras/PARHELION_display",
     "has no meaning on a scene and is skipped"},
    /* the others */
    {"'scenes':[{'extras':{'PARHELION_environment':{'type':'mist'}}}]",
     "/scenes/0/extras/PARHELION_environment/type", "is \"mist\", one of constant|hdri"},
    {"'materials':[{'extras':{'PARHELION_coating':{'stack':3}}}]",
     "/materials/0/extras/PARHELION_coating/stack", "is 3, a text is required"},
    {"'materials':[{'extras':{'PARHELION_glazing':{}}}]", "/materials/0/extras/PARHELION_glazing",
     "\"layers\" is missing"},
    {"'materials':[{'extras':{'PARHELION_spectrum':{'baseColor':1}}}]",
     "/materials/0/extras/PARHELION_spectrum/baseColor", "is 1, a text is required"},
    {"'materials':[{'extras':{'PARHELION_display':{'panel':'none.panel'},"
     "'PARHELION_glazing':{'layers':[{'thickness_m':0.002,'ior':1.5}]}}}]",
     "/materials/0/extras/PARHELION_glazing", "stands beside PARHELION_display"},
};

TEST_WITH(every_fault_is_named_with_its_place, maker_reset, NULL) {
    maker_expect_faults(FAULTS, COUNT_OF(FAULTS), NULL, 0);
}

/* What is said besides the panel that is not there: nothing, of extensionsUsed neither. */
static const Display *shown(const char *members) {
    Found found = maker_survey_file(maker_gltf(NULL, 0, members));
    for (int i = 0; i < found.problems.count; i++)
        if (!strstr(found.problems.list[i].message, "display \"cluster\""))
            fail_msg("%s: %s", found.problems.list[i].path, found.problems.list[i].message);
    assert_int_equal(found.scene->display_count, 1);
    assert_int_equal(found.scene->extension_count, 1);
    assert_string_equal(found.scene->extensions[0], "PARHELION_display");
    return &found.scene->displays[0];
}

TEST_WITH(a_display_is_the_same_whichever_way_it_is_written, maker_reset, NULL) {
#define LIST "'panel':'none.panel','level':0.25,'max_level':2"
    static const char *const ways[] = {
        "'extensionsUsed':['PARHELION_display'],'materials':[{'name':'cluster','extensions':"
        "{'PARHELION_display':{" LIST "}}}]",
        MARKED("{" LIST "}"),
        MARKED(IN_TEXT("," Q "level" Q ":0.25," Q "max_level" Q ":2")),
    };
    for (int i = 0; i < COUNT_OF(ways); i++) {
        const Display *display = shown(ways[i]);
        const char *name = strrchr(display->panel_path, '/');
        assert_string_equal(name ? name + 1 : display->panel_path, "none.panel");
        assert_near(display->level, 0.25, 0);
    }
}

TEST_WITH(a_scenes_light_is_read_from_extras, maker_reset, NULL) {
    const Scene *scene = maker_load(NULL, 0,
                                    "'scene':0,'scenes':[{'extras':{'PARHELION_environment':'{" Q
                                    "type" Q ":" Q "constant" Q "," Q "luminance" Q ":250}'}}]");
    assert_int_equal(scene->environment.kind, ENVIRONMENT_CONSTANT);
    assert_near(scene->environment.luminance_cd_m2, 250, 0);
}

/* Extras of others are nobody's business, whatever they look like. */
TEST_WITH(other_extras_say_nothing, maker_reset, NULL) {
    Found found = maker_survey_file(
        maker_gltf(NULL, 0,
                   "'materials':[{'extras':{'display':'{','PARHELION':[1],'parhelion_display':3}},"
                   "{'extras':['PARHELION_display']},{'extras':'PARHELION_display'}]"));
    assert_int_equal(found.problems.count, 0);
    assert_int_equal(found.scene->display_count, 0);
}

TEST_PROGRAM(maker_start, maker_end)

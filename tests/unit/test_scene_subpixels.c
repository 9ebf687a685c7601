/* A display's "subpixels": what is read, and what is said of wrong ones. */
#include "check.h"
#include "gltf_maker.h"

typedef struct SubpixelFault {
    const char *members, *place, *text;
} SubpixelFault;

#define PLACE "/materials/0/extensions/PARHELION_display"
#define DIVIDED(body)                                                                          \
    "'extensionsUsed':['PARHELION_display'],'materials':[{'name':'cluster','extensions':{"     \
    "'PARHELION_display':{'panel':'none.panel','subpixels':" body "}}}]"

static const SubpixelFault FAULTS[] = {
    {DIVIDED("{}"), PLACE "/subpixels", "\"layout\" is missing"},
    {DIVIDED("'stripe'"), PLACE "/subpixels", "is \"stripe\", an object is wanted"},
    {DIVIDED("{'layout':'delta'}"), PLACE "/subpixels/layout",
     "is \"delta\", one of stripe|pentile is wanted"},
    {DIVIDED("{'layout':3}"), PLACE "/subpixels/layout",
     "is 3, one of stripe|pentile is wanted"},
    {DIVIDED("{'layout':'stripe','fill':0}"), PLACE "/subpixels/fill",
     "is 0, a number from 0.01 to 1 is wanted"},
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
    {DIVIDED("{'layout':'pentile','fil':1}"), PLACE "/subpixels/fil", "is \"fill\" meant?"},
    {DIVIDED("{'layout':'stripe'}"), PLACE "/panel",
     "its \"subpixels\" need \"columns\" and \"rows\" where no content tells them"},
};

TEST_WITH(every_fault_is_named_with_its_place, maker_reset, NULL)
{
    for (size_t i = 0; i < sizeof FAULTS / sizeof *FAULTS; i++) {
        const SubpixelFault *fault = &FAULTS[i];
        maker_reset(state);
        Found found = maker_survey_file(maker_gltf(NULL, 0, fault->members));
        if (!maker_find(&found, fault->place, fault->text))
            fail_msg("no problem at %s says \"%s\" for %s", fault->place, fault->text,
                     fault->members);
    }
}

/* A PNG of 3 x 2 pixels. */
#define PICTURE                                                                                \
    "data:image/png;base64,"                                                                   \
    "iVBORw0KGgoAAAANSUhEUgAAAAMAAAACCAIAAAASFvFNAAAAEElEQVR42mP438AAQQxwFgBf0gj7"             \
    "ZoGl2gAAAABJRU5ErkJggg=="

/* Of a display that shows it; its panel is not there, which is told. */
static const Display *shown(const char *body)
{
    char text[2048];
    snprintf(text, sizeof text,
             "'extensionsUsed':['PARHELION_display'],'images':[{'uri':'" PICTURE "'}],"
             "'textures':[{'source':0}],'materials':[{'name':'cluster','extensions':{"
             "'PARHELION_display':{'panel':'none.panel','content':{'index':0}%s}}}]",
             body);
    Found found = maker_survey_file(maker_gltf(NULL, 0, text));
    assert_int_equal(found.problems.count, 1);
    assert_non_null(maker_find(&found, PLACE "/panel", "display \"cluster\": "));
    return &found.scene->displays[0];
}

TEST_WITH(pixels_are_the_contents_unless_they_are_counted, maker_reset, NULL)
{
    (void)state;
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
}

int main(void)
{
    return run_cases(maker_start, maker_end);
}

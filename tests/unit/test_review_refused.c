/* SPDX-License-Identifier: Apache-2.0 */
/* test_review_refused.c -- what is wrong in REVIEW.json is said in one line: where, what was
 * found, what was required. */
#include "review_fixture.h"

static int start(void **state) {
    if (make_folder(state)) return -1;
    review_files();
    write_text(in_folder("empty.epw"), "");
    return 0;
}

/* The good document with `from` replaced by `to` is refused at `place` with `words`. */
typedef struct Wrong {
    const char *from, *to, *place, *words;
} Wrong;

static void check_all(const Wrong *wrong, int count, Arena arena) {
    for (int i = 0; i < count; i++) {
        Arena scratch = arena;
        ReviewRequest r;
        const Wrong *w = &wrong[i];
        char *text = review_changed(review_good, w->from, w->to, &scratch);
        if (review_read(text, &scratch, &r, why())) fail_msg("%s was taken", w->to);
        assert_told(ERROR_INPUT, w->place, w->words);
    }
}

#define CHECK_ALL(wrong) check_all(wrong, (int)(sizeof(wrong) / sizeof *(wrong)), test_arena(state))

/* ---- keys -------------------------------------------------------------------------------- */

TEST(unknown_keys_are_refused_with_the_nearest_known_one) {
    static const Wrong wrong[] = {
        {"'profile'", "'profil'", "/profil", "the nearest known one is 'profile'"},
        {"'camera':1", "'kamera':1", "/eyes/second/kamera", "'camera'"},
        {"'age_years'", "'age'", "/observer/age", "'age_years'"},
        {"'direction'", "'directions'", "/gaze/1/directions", "'direction'"},
        {"'uv'", "'vu'", "/symbols/speed/vu", "'uv'"},
        {"'normal'", "'norm'", "/levels/auto/sensor/norm", "'normal'"},
        {"'table_lx'", "'table'", "/levels/auto/table", "'table_lx'"},
        {"'contrast'", "'contrasts'", "/precision/contrasts", "'contrast'"},
        {"'worst'", "'wurst'", "/frames/wurst", "'worst'"},
        {"'lights'", "'light'", "/conditions/1/light", "'lights'"},
        {"'azimuth_deg':[", "'azimut_deg':[", "/conditions/2/sweep/sun/azimut_deg",
         "'azimuth_deg'"},
        {"'sky':'sky'", "'skies':'sky'", "/conditions/2/sweep/skies", "'sky'"},
        {"'step_minutes'", "'step_minute'", "/conditions/3/sweep/step_minute", "'step_minutes'"},
        {"'turbidity'", "'turbidty'", "/conditions/3/environment/turbidty",
         "nearest known one is 'turbidity'"},
    };
    CHECK_ALL(wrong);
}

TEST(what_must_be_there_is_asked_for) {
    static const Wrong wrong[] = {
        {"'scene':['a.gltf','b%20c.gltf'],", "", "", "key 'scene' is missing"},
        {"'profile':'iso-15008',", "", "", "key 'profile' is missing"},
        {"'name':'noon',", "", "/conditions/0", "key 'name' is missing"},
        {"'display':'node:screen',", "", "/symbols/text", "key 'display' is missing"},
        {"'name':'road',", "", "/gaze/1", "key 'name' is missing"},
        {",'table_lx':[[0,0.02],[100,0.1],[10000,1]]", "", "/levels/auto",
         "key 'table_lx' is missing"},
        {"'sensor':{'position_m':[0,1,2],'normal':[0,3,4]},", "", "/levels/auto",
         "key 'sensor' is missing"},
        {"'where':[48,11],", "", "/conditions/3/sweep", "key 'where' is missing"},
        {",'elevation_deg':[5,5,1]", "", "/conditions/2/sweep/sun",
         "key 'elevation_deg' is missing"},
        {"'half_size_m':[0.1,0.2,0],", "", "/eyes/box", "key 'half_size_m' is missing"},
    };
    CHECK_ALL(wrong);
}

/* ---- values ------------------------------------------------------------------------------ */

TEST(eyes_are_checked) {
    static const Wrong wrong[] = {
        {"'camera':1", "'camera':1.5", "/eyes/second/camera",
         "is 1.5, required: a whole "
         "number"},
        {"'camera':1", "'camera':-1", "/eyes/second/camera", "required: a number from 0"},
        {"'camera':1", "'camera':null", "/eyes/second/camera",
         "is null, required: a camera's name or its index"},
        {"'camera':'eye'", "'camera':''", "/eyes/driver/camera",
         "is an empty text, required: some words"},
        {"'camera':1", "'camera':1,'position_m':[0,0,0]", "/eyes/second",
         "is said in several ways, required: one of 'camera'"},
        {"'camera':1", "", "/eyes/second", "is nowhere, required: one of 'camera'"},
        {"'camera':1", "'camera':1,'grid':[1,1,1]", "/eyes/second", "is a box without a centre"},
        {"'position_m':[-1,2,3]", "'position_m':[-1,2]", "/eyes/tall/position_m",
         "has 2 values, required: 3"},
        {"'position_m':[-1,2,3]", "'position_m':[-1,2,'x']", "/eyes/tall/position_m",
         "required: only numbers"},
        {"'position_m':[-1,2,3]", "'position_m':5", "/eyes/tall/position_m",
         "is a number, required: an array of numbers"},
        {"[2,3,1]", "[2,3,2]", "/eyes/box/grid",
         "has 2 points along an axis without length, required: 1 there"},
        {"[2,3,1]", "[2,3.5,1]", "/eyes/box/grid", "is 3.5, required: whole numbers"},
        {"[2,3,1]", "[2,99,1]", "/eyes/box/grid", "is 99, required: a number from 1 to 33"},
        {"[0.1,0.2,0]", "[-0.1,0.2,0]", "/eyes/box/half_size_m", "is -0.1, required:"},
        {"'grid':[2,3,1]", "'ellipse_m':[1,1,1]", "/eyes/box/ellipse_m",
         "stands beside 'half_size_m', required: one"},
        {"'half_size_m':[0.1,0.2,0]", "'ellipse_m':[1,1,1]", "/eyes/box/grid",
         "is a box's, not an ellipse's"},
        {"'grid':[2,3,1]", "'tilt_deg':5", "/eyes/box/tilt_deg",
         "is an ellipse's: 'ellipse_m' is missing"},
        {"'half_size_m':[0.1,0.2,0],'grid':[2,3,1]", "'ellipse_m':[1,-1,1]", "/eyes/box/ellipse_m",
         "is -1, required:"},
        {"'half_size_m':[0.1,0.2,0],'grid':[2,3,1]", "'ellipse_m':[1,1,1],'tilt_deg':99",
         "/eyes/box/tilt_deg", "is 99, required: a number from -90 to 90"},
        {"'forward':[0,0,-2]", "'forward':[0,2,0]", "/forward", "is vertical, required:"},
        {"'forward':[0,0,-2]", "'forward':[0,0,0]", "/forward",
         "is the zero vector, required: a direction"},
        {"'age_years':60", "'age_years':200", "/observer/age_years",
         "is 200, required: a number from 10 to 100"},
        {"'at':'symbols'", "'at':'symbol'", "/gaze/0/at", "is 'symbol', required: 'symbols'"},
        {"'at':'symbols'", "'at':'symbols','direction':[0,0,1]", "/gaze/0",
         "has both, "
         "required:"},
        {"'at':'symbols'", "'name':'x'", "/gaze/0", "has neither, required: one of 'at'"},
        {"'tall','driver'", "'tal','driver'", "/gaze/1/eyes/0",
         "is 'tal', required: a name of 'eyes': did you mean tall?"},
        {"'tall','driver'", "7", "/gaze/1/eyes/0", "is a number, required: a text"},
        {"'name':'road'", "'name':'symbols'", "/gaze/1", "is the second gaze named 'symbols'"},
    };
    CHECK_ALL(wrong);
}

TEST(symbols_are_checked) {
    static const Wrong wrong[] = {
        {"[0.1,0.2,0.3,0.4]", "[0.3,0.2,0.1,0.4]", "/symbols/speed/uv",
         "is [0.3, 0.2, 0.1, 0.4], required: [left, top, right, bottom]"},
        {"[0.1,0.2,0.3,0.4]", "[0.1,0.4,0.3,0.4]", "/symbols/speed/uv", "top below bottom"},
        {"[0.1,0.2,0.3,0.4]", "[0.1,0.2,1.3,0.4]", "/symbols/speed/uv",
         "is 1.3, required: a number from 0 to 1"},
        {"'light-on-dark'", "'light on dark'", "/symbols/speed/polarity",
         "is 'light on dark', required: another word: did you mean light-on-dark?"},
        {"'find':'text'", "'find':'digits'", "/symbols/text/find", "is 'digits', required:"},
        {",'find':'text'", "", "/symbols/text",
         "says no place on its display, required: 'uv', 'mask' or 'find'"},
        {"'mask':'p.png'", "'mask':'p.png','find':'text'", "/symbols/drawn",
         "has both 'find' and 'mask', required: one of them"},
        {"'content':'p.png'", "'content':'q.png'", "/symbols/speed/content",
         "q.png', which cannot be read; required: a file"},
        {"'speed':{", "'':{", "/symbols", "has a member with an empty name, required: a name"},
        {"'speed':{", "'text':{", "line 1", "not valid JSON: duplicate object key"},
    };
    CHECK_ALL(wrong);
}

TEST(files_are_checked) {
    static const Wrong wrong[] = {
        {"'a.gltf','b", "'none.gltf','b", "/scene/0",
         "none.gltf', which cannot be read; required: a file"},
        {"'a.gltf','b%20c.gltf'", "7", "/scene/0", "is a number, required: a file's path"},
        {"['a.gltf','b%20c.gltf']", "'a.gltf'", "/scene", "is a text, required: an array"},
        {"'a.gltf','b%20c.gltf'", "", "/scene", "has 0 values, required: 1 to 256"},
        {"'a.gltf','b", "'http:a.gltf','b", "/scene/0",
         "has the scheme 'http:', required: a relative path"},
        {"'a.gltf','b", "'/etc/passwd','b", "/scene/0", "a path relative to the file"},
        {"'a.gltf','b", "'../../a.gltf','b", "/scene/0", "leaves the parent of the folder"},
        {"'a.gltf','b", "'a%2.gltf','b", "/scene/0", "%2"},
        {"'somebody':['a.gltf']", "'somebody':[]", "/with/somebody", "has 0 values"},
    };
    CHECK_ALL(wrong);
}

TEST(levels_are_checked) {
    static const Wrong wrong[] = {
        {"'*':0.04", "'*':-1", "/levels/night/*", "is -1, required: a level from 0 to 1"},
        {"'*':0.04", "'*':25", "/levels/night/*", "is 25, required: a level from 0 to 1"},
        {"[10000,1]", "[10000,1.5]", "/levels/auto/table_lx/2/1", "required: a level from 0 to 1"},
        {"'*':0.04", "'*':'dim'", "/levels/night/*", "is a text, required: a number"},
        {"{'*':0.04,'cluster':0.1}", "{}", "/levels/night", "has 0 members, required: 1"},
        {"{'*':0.04,'cluster':0.1}", "0.04", "/levels/night",
         "is a number, required: an "
         "object"},
        {"[0,3,4]", "[0,0,0]", "/levels/auto/sensor/normal", "is the zero vector"},
        {"[100,0.1]", "[0,0.1]", "/levels/auto/table_lx/1",
         "is at 0 lx behind 0 lx, required: more lx"},
        {"[100,0.1]", "[100,0.01]", "/levels/auto/table_lx/1",
         "falls from level 0.02 to 0.01, required: one that does not fall"},
        {"[100,0.1]", "[100]", "/levels/auto/table_lx/1", "has 1 values, required: 2"},
        {"[100,0.1]", "[100,'x']", "/levels/auto/table_lx/1", "required: only numbers"},
        {"[100,0.1]", "7", "/levels/auto/table_lx/1", "is a number, required: an array of numbers"},
        {"[10000,1]", "[1e9,1]", "/levels/auto/table_lx/2",
         "is 1e+09, required: a number from 0 to 1e+07"},
        {"[[0,0.02],[100,0.1],[10000,1]]", "[]", "/levels/auto/table_lx", "has 0 values"},
    };
    CHECK_ALL(wrong);
}

TEST(the_rest_is_checked) {
    static const Wrong wrong[] = {
        {"'profile':'iso-15008'", "'profile':''", "/profile",
         "is an empty text, required: some words"},
        {"'contrast':0.02", "'contrast':0", "/precision/contrast", "is 0, required:"},
        {"'contrast':0.02", "'contrast':0.02,'clear':0.01", "/precision/clear",
         "is 0.01, required: at least 'contrast', 0.02"},
        {"'contrast':0.02", "'clear':2", "/precision/clear", "is 2, required:"},
        {"'seed':7", "'seed':-1", "/precision/seed", "is -1, required:"},
        {"'seed':7", "'seed':1.5", "/precision/seed", "is 1.5, required: a whole number"},
        {"'seed':7", "'seed':'x'", "/precision/seed", "is a text, required: a number"},
        {"[640,360]", "[640,0]", "/frames/size", "is 0, required: a number from 1 to 16384"},
        {"[640,360]", "[640.5,360]", "/frames/size", "required: whole numbers"},
        {"'worst':2", "'worst':2.5", "/frames/worst", "is 2.5, required: a whole number"},
        {"'title':'All of it'", "'title':7", "/title", "is a number, required: a text"},
    };
    CHECK_ALL(wrong);
}

/* ---- conditions -------------------------------------------------------------------------- */

TEST(conditions_are_checked) {
    static const Wrong wrong[] = {
        {"'name':'night'", "'name':'noon'", "/conditions/1/name",
         "is 'noon' as that of condition 0, required: another name"},
        {"'level':'night'", "'level':'nigth'", "/conditions/1/level",
         "is 'nigth', required: a name of 'levels': did you mean night?"},
        {"'with':'somebody'", "'with':'nobody'", "/conditions/0/with",
         "is 'nobody', required: a name of 'with'"},
        {"'with':{'somebody':['a.gltf']},", "", "/conditions/0/with",
         "is 'somebody', but the file has no 'with'"},
        {"{'text':'dark-on-light'}", "{'txt':'dark-on-light'}", "/conditions/1/polarity/txt",
         "unknown symbol; did you mean text?"},
        {"{'text':'dark-on-light'}", "'dark'", "/conditions/1/polarity",
         "is 'dark', "
         "required:"},
        {"'contents':{'cluster':'p.png'}", "'contents':{'cluster':'q.png'}",
         "/conditions/0/contents/cluster", "cannot be read"},
        {"'weather':'clear'", "'weather':'rain'", "/conditions/3/sweep/weather",
         "is 'rain', required: 'clear' or a weather file .epw"},
        {"{'name':'any sun'", "7,{'name':'any sun'", "/conditions/2",
         "is a number, required: an object"},
    };
    CHECK_ALL(wrong);
}

TEST(environments_are_checked_as_in_a_scene) {
    static const Wrong wrong[] = {
        {"'type':'sky','when'", "'type':'mist','when'", "/conditions/0/environment/type",
         "\"mist\", one of constant|hdri|cie|perez|sky is required"},
        {"'when':'2026-06-21T12:00+02:00',", "", "/conditions/0/environment", "has no sun"},
        {"'where':[48.14,11.58,520],", "'where':[148,11],", "/conditions/0/environment/where/0",
         "is 148, a latitude"},
        {"'turbidity':4", "'turbidity':99", "/conditions/3/environment/turbidity",
         "is 99, a number from 1 to 30 is required"},
        {"'type':'sky','when':'2026-06-21T12:00+02:00','where':[48.14,11.58,520],",
         "'type':'hdri','uri':'none.exr',", "/conditions/0/environment/uri", "none.exr"},
        {"'type':'sky','turbidity':4", "'type':'constant','luminance':1",
         "/conditions/3/environment/type", "is not 'sky', which is required"},
        {"'heading_deg':30}", "'heading_deg':30},'heading_deg':4", "/conditions/0/heading_deg",
         "stands in 'environment' as well, required: once"},
        {"'heading_deg':30}", "'forward':[0,0,1]}", "/conditions/0/environment/forward",
         "stands in a condition, required: at the top of the file"},
        {"'turbidity':4", "'turbidity':4,'heading_deg':7", "/conditions/3/environment/heading_deg",
         "headings of its own, required: none"},
    };
    CHECK_ALL(wrong);
}

TEST(sweeps_are_checked) {
    static const Wrong wrong[] = {
        {"[0,360,90]", "[0,360]", "/conditions/2/sweep/sun/azimuth_deg",
         "has 2 values, required: 3"},
        {"[0,360,90]", "[0,360,0]", "/conditions/2/sweep/sun/azimuth_deg",
         "has a step of 0, required: at least 0.0001"},
        {"[0,360,90]", "[90,0,10]", "/conditions/2/sweep/sun/azimuth_deg",
         "goes from 90 to 0, which is empty; required: [first, last, step]"},
        {"[0,360,90]", "[0,360,7]", "/conditions/2/sweep/sun/azimuth_deg",
         "does not come from 0 to 360 in steps of 7, required: a step such as 7.05882"},
        {"[0,360,90]", "[0,360,500]", "/conditions/2/sweep/sun/azimuth_deg", "such as 360"},
        {"[0,360,90]", "[-100,300,90]", "/conditions/2/sweep/sun/azimuth_deg", "such as 100"},
        {"[0,360,90]", "[-100,300,100]", "/conditions/2/sweep/sun/azimuth_deg",
         "spans 400 degrees, required: at most 360"},
        {"[0,360,90]", "[0,360,0.001]", "/conditions/2/sweep/sun/azimuth_deg",
         "has 360001 values, required: at most 100000"},
        {"[0,360,90],'elevation_deg':[5,5,1]", "[0,360,0.01],'elevation_deg':[0,80,0.01]",
         "/conditions/2/sweep/sun", "suns, required: at most 10000000"},
        {"[5,5,1]", "[-60,5,1]", "/conditions/2/sweep/sun/elevation_deg",
         "is -60, required: a number from -18 to 90"},
        {"'sky':'sky'", "'sky':'cie'", "/conditions/2/sweep/sky", "is 'cie', required:"},
        {"'sky':'sky'", "'year':2026", "/conditions/2/sweep",
         "has both, required: one of 'sun' and 'year'"},
        {"'year':2026,", "", "/conditions/3/sweep", "has neither, required: one of"},
        {"'year':2026", "'year':2026.5", "/conditions/3/sweep/year",
         "required: a whole "
         "number"},
        {"'year':2026", "'year':26", "/conditions/3/sweep/year", "is 26, required:"},
        {"'where':[48,11]", "'where':[480,11]", "/conditions/3/sweep/where", "is no place"},
        {"'where':[48,11]", "'where':[48]", "/conditions/3/sweep/where",
         "has 1 values, required: 2 to 3"},
        {"'step_minutes':30", "'step_minutes':0", "/conditions/3/sweep/step_minutes",
         "is 0, required: a number from 0.5 to 1440"},
        {"[0,90],'weather'", "[0,360],'weather'", "/conditions/3/sweep/headings_deg",
         "holds 0 and 360, required: each heading once"},
        {"[0,90],'weather'", "[],'weather'", "/conditions/3/sweep/headings_deg",
         "has 0 values, required: 1"},
        {"'night':true", "'night':1", "/conditions/3/sweep/night",
         "is a number, required: true or false"},
        {"'sweep':{'year'", "'heading_deg':1,'sweep':{'year'", "/conditions/3/heading_deg",
         "stands beside the sweep of a year, required: 'headings_deg' in it"},
    };
    CHECK_ALL(wrong);
}

/* ---- weather ----------------------------------------------------------------------------- */

TEST(a_weather_file_is_there) {
    static const Wrong wrong[] = {
        {"'weather':'clear','night'", "'weather':'none.epw','night'", "/conditions/3/sweep/weather",
         "none.epw', which cannot be read"},
        {"'weather':'clear','night'", "'weather':'empty.epw','night'", "",
         "is empty, required: an EPW weather file"},
    };
    CHECK_ALL(wrong);
}

/* The station's place serves where none is said; air and ground come from one source. */
ARENA_TEST(a_weather_year_brings_its_place) {
    ReviewRequest r;
    const char *shared = SHARED_DATA_DIR "/solar/NLD_Amsterdam062400_IWEC.epw";
    if (access(shared, R_OK)) {
        print_message("skipped: no shared data\n");
        skip();
    }
    FileBytes bytes = read_bytes(shared, &arena);
    write_bytes(in_folder("year.epw"), bytes.data, bytes.size);
    char *text = review_changed(review_good, "'where':[48,11],", "", &arena);
    text = review_changed(text, "\"weather\":\"clear\",\"night\"", "'weather':'year.epw','night'",
                          &arena);
    assert_fails_as(review_read(text, &arena, &r, &err), ERROR_INPUT,
                    "stands beside a weather file, required: one of them");
    assert_string_equal(why()->path, "/conditions/3/environment");
    text = review_changed(text,
                          "\"environment\":{\"type\":\"sky\",\"turbidity\":4,"
                          "\"sun\":{\"azimuth_deg\":0,\"elevation_deg\":9,"
                          "\"illuminance_lx\":1}},",
                          "", &arena);
    assert_done(review_read(text, &arena, &r, &err));
    assert_int_equal(r.weather_count, 1);
    assert_int_equal(r.conditions[3].weather_id, 0);
    assert_near(r.conditions[3].where.latitude_deg, 52.3, 1e-9);
    assert_int_equal(r.weathers[0].weather.count, 8760);
    assert_true(r.weathers[0].clock.rows > 1000);
}

/* ---- the file as a whole ----------------------------------------------------------------- */

TEST(what_is_no_document_is_refused) {
    static const struct {
        const char *text, *words;
    } wrong[] = {{"", "not valid JSON"},
                 {"[]", "is an array, required: an object"},
                 {"{} x", "not valid JSON"},
                 {"{}", "key 'scene' is missing"}};
    for (int i = 0; i < 4; i++) {
        Arena arena = test_arena(state);
        ReviewRequest r;
        assert_fails_as(review_read(wrong[i].text, &arena, &r, &err), ERROR_INPUT, wrong[i].words);
    }
    Arena arena = test_arena(state);
    ReviewRequest r;
    Problems problems = problems_start(&arena);
    assert_false(review_request_read(in_folder("none.json"), NULL, &arena, &problems, &r, why()));
    assert_text_has(why()->file, "none.json");
}

TEST_PROGRAM(start, clear_folder)

/* SPDX-License-Identifier: Apache-2.0 */
/* Limits as data: those that are shipped, and what is said of wrong ones. */
#include "fixture.h"

#include "base/count.h"
#include "review/profile.h"
#include "review/profile_table.h"

static const Profile *load(const char *name, Arena *arena) {
    const Profile *profile = NULL;
    if (!profile_load(name, arena, &profile, why())) fail_msg("%s: %s", name, why()->text);
    return profile;
}

/* The one limit of that kind in that light that counts; NULL when there is none. */
static const ProfileLimit *asked(const Profile *profile, LimitKind kind, Ambient ambient) {
    const ProfileLimit *found = NULL;
    for (int i = 0; i < profile->limit_count; i++) {
        const ProfileLimit *limit = &profile->limits[i];
        if (limit->kind != kind || limit->is_advice || !limit->ambients[ambient]) continue;
        assert_null(found);
        found = limit;
    }
    return found;
}

ARENA_TEST(every_profile_loads_and_says_where_it_was_read) {
    static const char *const NAMES[] = {"as8034",       "iso-15008",  "iso-9241-7", "j1757-1",
                                        "mil-l-85762a", "nureg-0700", "un-r46"};
    assert_int_equal(profile_count, COUNT_OF(NAMES));
    for (int i = 0; i < profile_count; i++) {
        const Profile *p = load(NAMES[i], &arena);
        assert_string_equal(profile_table[i].name, NAMES[i]);
        assert_string_equal(p->id, NAMES[i]);
        assert_true(p->title[0] && p->edition[0] && p->ambient_source[0]);
        assert_true(p->limit_count > 0 || p->fact_count > 0);
        assert_true(isnan(p->increment_most_pct)); /* a house's own: none was read */
        for (int k = 0; k < p->limit_count; k++) {
            const ProfileLimit *l = &p->limits[k];
            assert_true(l->source[0] && l->name[0] && l->value > 0);
            if (!l->read_in_the_standard)
                assert_non_null(strstr(l->source, "not read in the standard"));
        }
        for (int k = 0; k < p->fact_count; k++)
            assert_true(p->facts[k].source[0] &&
                        (p->facts[k].text[0] || isfinite(p->facts[k].value)));
    }
    assert_string_equal(profile_names(&arena),
                        "as8034, iso-15008, iso-9241-7, j1757-1, mil-l-85762a, nureg-0700, "
                        "un-r46");
}

ARENA_TEST(shipped_limits_are_the_known_ones) {
    const double car[AMBIENT_COUNT] = {5, 5, 3, 2}, monitor[AMBIENT_COUNT] = {5, 2, 3, 2};
    const Profile *iso = load("iso-15008", &arena), *un = load("un-r46", &arena);
    for (int a = 0; a < AMBIENT_COUNT; a++) {
        assert_near(asked(iso, LIMIT_CONTRAST_RATIO, (Ambient)a)->value, car[a], 0);
        assert_near(asked(un, LIMIT_CONTRAST_RATIO, (Ambient)a)->value, monitor[a], 0);
        assert_near(asked(iso, LIMIT_CHARACTER_HEIGHT, (Ambient)a)->value, 12, 0);
    }
    assert_near(asked(load("iso-9241-7", &arena), LIMIT_CONTRAST_RATIO, AMBIENT_DAY)->value, 3, 0);
    const Profile *nureg = load("nureg-0700", &arena);
    const ProfileLimit *small = asked(nureg, LIMIT_MODULATION, AMBIENT_DAY);
    assert_near(asked(nureg, LIMIT_CONTRAST_RATIO, AMBIENT_DAY)->value, 6, 0);
    assert_true(small->slope.has_slope && small->read_in_the_standard);
    assert_near(small->value + small->slope.per_arcmin * (small->slope.reference_arcmin - 15), 0.65,
                1e-12);
    const Profile *mil = load("mil-l-85762a", &arena);
    assert_near(asked(mil, LIMIT_LUMINANCE_CONTRAST, AMBIENT_SUN)->value, 2, 0);
    assert_null(asked(mil, LIMIT_LUMINANCE_CONTRAST, AMBIENT_NIGHT));
    assert_int_equal(load("j1757-1", &arena)->limit_count, 0);
    assert_int_equal(load("as8034", &arena)->limit_count, 0);
}

ARENA_TEST(light_tells_the_ambient) {
    const Profile *p = load("iso-15008", &arena);
    assert_int_equal(profile_ambient(p, 0, false), AMBIENT_NIGHT);
    assert_int_equal(profile_ambient(p, p->night_below_lx * 0.999, false), AMBIENT_NIGHT);
    assert_int_equal(profile_ambient(p, p->night_below_lx, false), AMBIENT_TWILIGHT);
    assert_int_equal(profile_ambient(p, p->twilight_below_lx * 0.999, false), AMBIENT_TWILIGHT);
    assert_int_equal(profile_ambient(p, p->twilight_below_lx, false), AMBIENT_DAY);
    assert_int_equal(profile_ambient(p, 60000, false), AMBIENT_DAY);
    assert_int_equal(profile_ambient(p, 20, true), AMBIENT_SUN);
}

/* ---- a house's own ----------------------------------------------------------------------- */

#define AMBIENT \
    "\"ambient\": {\"night_below_lx\": 4, \"twilight_below_lx\": 90, " \
    "\"source\": \"own\", \"read_in_the_standard\": false}"
#define HEAD "\"title\": \"Our cars\", \"edition\": \"7\", " AMBIENT
#define READ "\"source\": \"rule 7\", \"read_in_the_standard\": true"
#define LIMIT(more) "{" HEAD ", \"limits\": [{" more "}]}"
#define CONTRAST "\"kind\": \"contrast_ratio\", \"unit\": \"1\", "

static const char *write_profile(const char *text) {
    const char *path = in_folder("house.json");
    write_text(path, text);
    return path;
}

ARENA_TEST(a_house_has_its_own) {
    const Profile *p = load(
        write_profile("{" HEAD ", \"veil\": true, \"threshold_increment_max_pct\": 15, "
                      "\"limits\": ["
                      "{\"ambient\": [\"day\", \"sun\"], " CONTRAST "\"value\": 4, " READ "},"
                      "{\"ambient\": \"any\", \"kind\": \"stroke_ratio\", \"unit\": \"1\", "
                      "\"value\": 0.2, \"bound\": \"most\", \"advice\": true, " READ "}],"
                      "\"facts\": [{\"name\": \"n\", \"value\": -3, \"unit\": \"lx\", " READ "}]}"),
        &arena);
    assert_true(p->uses_veil && p->increment_most_pct == 15);
    assert_string_equal(p->title, "Our cars");
    assert_int_equal(p->limit_count, 2);
    assert_string_equal(p->limits[0].name, "contrast ratio, day, sun");
    assert_string_equal(p->limits[1].name, "stroke ratio at most");
    assert_true(p->limits[1].is_upper && p->limits[1].is_advice && !p->limits[0].is_upper);
    assert_false(p->limits[0].ambients[AMBIENT_NIGHT]);
    assert_true(p->limits[0].ambients[AMBIENT_SUN] && p->limits[1].ambients[AMBIENT_NIGHT]);
    assert_near(p->facts[0].value, -3, 0);
    assert_true(p->night_below_lx == 4 && p->twilight_below_lx == 90);
}

typedef struct Wrong {
    const char *text, *place, *said;
} Wrong;

static const Wrong WRONG[] = {
    {"{" HEAD ", \"limits\": []", "line 1", "not valid JSON"},
    {"[]", "", "is an array, required: an object"},
    {"{" HEAD ", \"limits\": [], \"limit\": 1}", "/limit", "the nearest known one is 'limits'"},
    {"{" HEAD "}", "", "key 'limits' is missing"},
    {"{" HEAD ", \"limits\": {}}", "/limits", "is an object, required: an array of objects"},
    {"{" HEAD ", \"limits\": [7]}", "/limits/0", "is a number, required: an object"},
    {"{" HEAD ", \"limits\": [], \"veil\": \"yes\"}", "/veil",
     "is a text, required: true or false"},
    {"{" HEAD ", \"limits\": [], \"threshold_increment_max_pct\": 0}",
     "/threshold_increment_max_pct", "is 0, required: a number above 0"},
    {"{\"edition\": \"7\", \"limits\": []}", "", "key 'title' is missing"},
    {"{\"title\": \"\", \"edition\": \"7\", \"limits\": []}", "/title", "is an empty text"},
    {"{\"title\": 4, \"edition\": \"7\"}", "/title", "is a number, required: a text"},
    {"{\"title\": \"a\", \"edition\": \"7\", \"limits\": []}", "", "key 'ambient' is missing"},
    {"{\"title\": \"a\", \"edition\": \"7\", \"ambient\": {\"night_below_lx\": 9, "
     "\"twilight_below_lx\": 9, " READ "}, \"limits\": []}",
     "/ambient/twilight_below_lx", "is 9, required: more than night_below_lx, 9"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": -5, " READ), "/limits/0/value",
     "is -5, required: a number above 0"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 0, " READ), "/limits/0/value",
     "is 0, required: a number above 0"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": \"5\", " READ), "/limits/0/value",
     "is a text, required: a number"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST READ), "/limits/0", "key 'value' is missing"},
    {LIMIT("\"ambient\": \"dusk\", " CONTRAST "\"value\": 5, " READ), "/limits/0/ambient",
     "is 'dusk', required: another word: "},
    {LIMIT("\"ambient\": [], " CONTRAST "\"value\": 5, " READ), "/limits/0/ambient",
     "required: night, twilight, day, sun or any, or an array of them"},
    {LIMIT("\"ambient\": [\"day\", 3], " CONTRAST "\"value\": 5, " READ), "/limits/0/ambient",
     "required: night, twilight, day, sun or any, or an array of them"},
    {LIMIT(CONTRAST "\"value\": 5, " READ), "/limits/0", "key 'ambient' is missing"},
    {LIMIT("\"ambient\": \"day\", \"kind\": \"contrast_ration\", \"unit\": \"1\", "
           "\"value\": 5, " READ),
     "/limits/0/kind", "did you mean contrast_ratio?"},
    {LIMIT("\"ambient\": \"day\", \"kind\": \"character_height\", \"unit\": \"deg\", "
           "\"value\": 5, " READ),
     "/limits/0/unit", "is 'deg', required: 'arcmin' for character_height"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"source\": \"x\""), "/limits/0",
     "key 'read_in_the_standard' is missing"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"read_in_the_standard\": true"),
     "/limits/0", "key 'source' is missing"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"bound\": \"upper\", " READ),
     "/limits/0/bound", "is 'upper', required: another word: there are least, most"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"colour\": 1, " READ),
     "/limits/0/colour", "unknown key"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"slope\": {\"per_arcmin\": 1, "
           "\"reference_arcmin\": 20, \"heights_arcmin\": [17, 10]}, " READ),
     "/limits/0/slope/heights_arcmin", "is [17, 10], required: [LOW, HIGH] with LOW < HIGH"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"slope\": {\"per_arcmin\": -1, "
           "\"reference_arcmin\": 20, \"heights_arcmin\": [10, 17]}, " READ),
     "/limits/0/slope/per_arcmin", "is -1, required: a number above 0"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 5, \"slope\": {\"per_arcmin\": 1, "
           "\"reference_arcmin\": 2, \"heights_arcmin\": [1, 9]}, " READ),
     "/limits/0/slope", "leads to a limit of -2 at 9 arc minutes, required: one above 0"},
    {LIMIT("\"ambient\": \"day\", \"kind\": \"modulation\", \"unit\": \"1\", \"value\": 30, " READ),
     "/limits/0/value", "is 30, required: less than 1"},
    {LIMIT(
         "\"ambient\": \"day\", \"kind\": \"gaze_veil\", \"unit\": \"cd/m2\", \"value\": 30, "
         "\"slope\": {\"per_arcmin\": 1, \"reference_arcmin\": 20, \"heights_arcmin\": [10, 17]}, " READ),
     "/limits/0/slope", "is by the height of characters, required: none of gaze_veil"},
    {LIMIT("\"ambient\": \"day\", \"kind\": \"threshold_increment\", \"unit\": \"%\", "
           "\"value\": 9, \"bound\": \"least\", " READ),
     "/limits/0/bound", "is 'least', required: 'most' of threshold_increment"},
    {"{" HEAD ", \"threshold_increment_max_pct\": 5, \"limits\": [{\"ambient\": \"night\", "
     "\"kind\": \"threshold_increment\", \"unit\": \"%\", \"value\": 9, " READ "}]}",
     "/threshold_increment_max_pct", "beside a limit of threshold_increment, required: one"},
    {LIMIT("\"ambient\": \"day\", " CONTRAST "\"value\": 1e999, " READ), "line 1",
     "not valid JSON"},
    {"", "line 1", "not valid JSON"},
    {"{" HEAD ", \"limits\": [], \"facts\": [{\"name\": \"n\", \"value\": 3, " READ "}]}",
     "/facts/0", "required: a value with its unit, a text, or all three"},
    {"{" HEAD ", \"limits\": [], \"facts\": [{\"text\": \"n\", " READ "}]}", "/facts/0",
     "key 'name' is missing"},
};

ARENA_TEST(wrong_files_are_told_where_they_are_wrong) {
    for (int i = 0; i < COUNT_OF(WRONG); i++) {
        const char *path = write_profile(WRONG[i].text);
        const Profile *profile = NULL;
        if (profile_load(path, &arena, &profile, why())) fail_msg("taken: %s", WRONG[i].text);
        assert_null(profile);
        assert_string_equal(why()->file, path);
        assert_told(ERROR_INPUT, WRONG[i].place, WRONG[i].said);
    }
}

ARENA_TEST(what_is_not_there_is_told_with_what_is) {
    const Profile *profile = NULL;
    assert_fails_as(profile_load("iso-1500", &arena, &profile, &err), ERROR_INPUT,
                    "there is no profile \"iso-1500\"");
    assert_non_null(strstr(why()->text, "iso-15008, iso-9241-7"));
    assert_false(profile_load(in_folder("none.json"), &arena, &profile, why()));
    assert_string_equal(why()->file, in_folder("none.json"));
    assert_int_equal(why()->code, ERROR_INPUT);
    assert_null(profile);
}

TEST_PROGRAM(make_folder, clear_folder)

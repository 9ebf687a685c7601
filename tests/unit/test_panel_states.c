/* SPDX-License-Identifier: Apache-2.0 */
/* Panel files of several states: joined, opened by name, and what is refused. */
#include "fixture.h"

#include "base/file.h"
#include "base/file_write.h"
#include "panel/fit/panel_states.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_open.h"
#include "panel_bytes.h"

#define SHARED PROJECT_DIR "/assets/panels/ips_cluster.panel"
#define PRIVATE PROJECT_DIR "/assets/panels/oled_centre.panel"

static const PanelStateFile TWO[] = {{"shared", SHARED}, {"private", PRIVATE}};

static Panel *opened(const char *path, Arena *arena)
{
    Panel *panel;
    if (!panel_open(path, arena, &panel, why())) fail_msg("%s: %s", path, why()->text);
    return panel;
}

/* To the bit, of white, grey and black at several angles. */
static void assert_same_light(const Panel *a, const Panel *b)
{
    static const float CODES[][3] = {{255, 255, 255}, {90, 120, 20}, {0, 0, 0}};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 8; k++) {
            float x[3], y[3];
            Vec3  to = vec3_normalize(vec3(0.2f * (float)k - 0.5f, 0.1f * (float)k, 1));
            assert_int_equal(panel_emission_xyz(a, to, CODES[i], x),
                             panel_emission_xyz(b, to, CODES[i], y));
            assert_memory_equal(x, y, sizeof x);
        }
}

ARENA_TEST(each_state_is_the_panel_that_it_was)
{
    const char *path = in_folder("two.panel");
    int         state;
    assert_done(panel_states_join(TWO, 2, path, &arena, &err));
    Panel *first = opened(path, &arena), *own = opened(SHARED, &arena);
    Panel *second = opened(in_folder("two.panel#private"), &arena);
    Panel *other = opened(PRIVATE, &arena);
    Panel *named = opened(in_folder("two.panel#shared"), &arena);
    assert_int_equal(panel_info_states(own, &state), 0);
    assert_int_equal(panel_info_states(first, &state), 2);
    assert_int_equal(state, 0);
    assert_string_equal(panel_info_state_name(first, 0), "shared");
    assert_int_equal(panel_info_states(second, &state), 2);
    assert_int_equal(state, 1);
    assert_string_equal(panel_info_state_name(second, 1), "private");
    assert_same_light(first, own);
    assert_same_light(named, own);
    assert_same_light(second, other);
    Panel *list[] = {first, second, own, other, named};
    for (int i = 0; i < 5; i++) panel_close(list[i]);
    remove(path);
}

static void assert_refused(const PanelStateFile *states, int count, const char *why_not,
                           Arena *arena)
{
    const char *path = in_folder("no.panel");
    assert_false(panel_states_join(states, count, path, arena, why()));
    if (!strstr(why()->text, why_not)) fail_msg("%s", why()->text);
    assert_false(file_exists(path));
}

ARENA_TEST(what_is_no_state_is_refused)
{
    const char *path = in_folder("two.panel");
    Panel      *panel;
    assert_done(panel_states_join(TWO, 2, path, &arena, &err));
    assert_false(panel_open(in_folder("two.panel#secret"), &arena, &panel, why()));
    assert_non_null(strstr(why()->text, "has no state 'secret', required: shared, private"));
    assert_false(panel_open(SHARED "#private", &arena, &panel, why()));
    assert_non_null(strstr(why()->text,
                           "required: no state: this file has one only"));
    const PanelStateFile again[] = {{"a", path}, {"b", PRIVATE}};
    const PanelStateFile same[] = {{"a", SHARED}, {"a", PRIVATE}};
    const PanelStateFile odd[] = {{"a b", SHARED}, {"b", PRIVATE}};
    assert_refused(again, 2, "has states already", &arena);
    assert_refused(same, 2, "two have one name", &arena);
    assert_refused(odd, 2, "a name is none", &arena);
    remove(path);
}

/* A file under the whole name comes before a state. */
ARENA_TEST(a_file_with_that_name_is_that_file)
{
    const char *odd = in_folder("two.panel#private");
    FileBytes   bytes;
    assert_done(file_read(SHARED, 1 << 24, &arena, &bytes, &err));
    assert_done(file_write(odd, bytes.data, bytes.size, &err));
    Panel *panel = opened(odd, &arena), *own = opened(SHARED, &arena);
    assert_same_light(panel, own);
    panel_close(panel);
    panel_close(own);
    remove(odd);
}

/* Each byte of the names and of the table of contents changed, and the checksum made to fit:
 * refused, or read as a panel all the same; never worse. */
ARENA_TEST(damaged_states_do_no_harm)
{
    const char *path = in_folder("two.panel");
    FileBytes   bytes;
    assert_done(panel_states_join(TWO, 2, path, &arena, &err));
    ARENA_NEW(&arena, uint64_t, 0);
    assert_done(file_read(path, 1 << 24, &arena, &bytes, &err));
    remove(path);
    PanelHeader header;
    memcpy(&header, bytes.data, sizeof header);
    unsigned char *data = (unsigned char *)(size_t)bytes.data;
    size_t         at = sizeof header + (header.section_count - 2) * sizeof(PanelSection);
    PanelSection   names;
    memcpy(&names, data + at, sizeof names);
    assert_int_equal(names.kind, PANEL_STATES);
    int refused = 0, tried = 0;
    for (size_t i = 0; i < names.size + 2 * sizeof names; i += 5) {
        size_t where = i < names.size ? names.offset + i : at + i - names.size;
        Arena  room = arena;
        Panel *panel;
        unsigned char before = data[where];
        data[where] ^= 0x91;
        repair_checksum(data, bytes.size);
        PanelOpenArgs args = {data, bytes.size, "x", "private"};
        refused += !panel_open_state(&args, &room, &panel, why());
        data[where] = before;
        tried++;
    }
    assert_true(refused > tried / 2);
}

TEST_PROGRAM(make_folder, clear_folder)

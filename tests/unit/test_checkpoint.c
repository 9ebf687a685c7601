/* SPDX-License-Identifier: Apache-2.0 */
/* What a checkpoint keeps is what it gives back; whatever is not whole is refused in one line
 * that says why. */
#include "film_fixture.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "film/film_state.h"
#include "film/pixels.h"
#include "render/checkpoint.h"

enum { WIDTH = 7, HEIGHT = 5, FIRST = 3, SAMPLES = 40 };

static const FilmRect crop = {1, 2, 6, 5};

static int make_checkpoint_path(void **state) {
    return make_path(state, "a.checkpoint");
}

/* ---- films ------------------------------------------------------------------------------- */

static const char *const group_names[] = {"sun", "lamp", "sky"};
static const FilmLights groups = {3, group_names};
static const FilmLight one_light[] = {{1, {1, 1, 1}}};

/* Small and huge, negative ones too, and some that are dropped. */
static FilmSample sample_of(int x, int y, uint32_t index) {
    uint32_t random = hash_combine((uint32_t)(y * WIDTH + x), index);
    FilmSample s = {.sample_index = index, .hit = random_unit(&random) < 0.9f};
    for (int i = 0; i < 3; i++) {
        float sign = random_unit(&random) < 0.1f ? -1 : 1;
        s.xyz[i] = sign * powf(10, 12 * random_unit(&random) - 6);
        s.position[i] = random_unit(&random) - 0.5f;
    }
    if (random_unit(&random) < 0.02f) s.xyz[1] = NAN;
    s.lights = one_light;
    s.light_count = 1;
    s.part_id = (int)(4 * random_unit(&random));
    s.display_id = (int)(3 * random_unit(&random)) - 1;
    return s;
}

static Film *make_film(unsigned layers, Arena *arena) {
    Film *film = film_create(WIDTH, HEIGHT, crop, layers, &groups, arena);
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++)
            for (uint32_t i = FIRST; i < FIRST + SAMPLES; i++) {
                FilmSample sample = sample_of(x, y, i);
                film_add_sample(film, x, y, &sample);
            }
    return film;
}

static void assert_same_films(const Film *a, const Film *b) {
    FilmDropped x = film_dropped(a), y = film_dropped(b);
    size_t pixels = (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
    assert_true(x.count > 0);
    assert_int_equal(x.count, y.count);
    assert_int_equal(x.kept, y.kept);
    assert_memory_equal(x.first, y.first, sizeof x.first);
    assert_int_equal(a->stride, b->stride);
    Arena room = arena_reserve((size_t)1 << 28);
    char *of_a = arena_alloc(&room, a->stride, 16, pixels);
    char *of_b = arena_alloc(&room, b->stride, 16, pixels);
    film_gather(a, 0, pixels, of_a);
    film_gather(b, 0, pixels, of_b);
    assert_memory_equal(of_a, of_b, pixels * a->stride);
    arena_release(&room);
}

/* ---- rows -------------------------------------------------------------------------------- */

MEMORY_TEST(packed_rows_hold_every_bit) {
    for (int i = 0; i < 2; i++) {
        unsigned layers = i ? LAYER_ALL : 0;
        Film *film = make_film(layers, arena);
        Film *again = film_create(WIDTH, HEIGHT, crop, layers, &groups, arena);
        unsigned char *row = ARENA_NEW(arena, unsigned char, film_packed_bytes_max(film));
        size_t bytes = 0;
        PixelSums *sums = film_sums(film, 2, 3);
        sums->xyz[0] = -((Fixed)sums->samples << 96); /* the most that may be */
        sums->xyz[1] = (Fixed)sums->samples << 96;
        film_sums(film, 3, 3)->xyz[0] = -1;
        for (int y = crop.y0; y < crop.y1; y++) {
            size_t size = film_pack_row(film, y, row, *arena);
            assert_int_equal(size, film_packed_bytes(film, y, *arena));
            PackedRow packed = {row, size};
            assert_done(film_unpack_row(again, y, packed, SAMPLES, *arena, &err));
            bytes += size;
        }
        assert_true(bytes < 15 * film_pixel_bytes(film) * 2 / 3);
        again->dropped = film->dropped;
        assert_same_films(film, again);
    }
}

MEMORY_TEST(rows_that_no_film_packs_are_refused) {
    Film *film = make_film(0, arena);
    Film *to = film_create(WIDTH, HEIGHT, crop, 0, &groups, arena);
    size_t max = film_packed_bytes_max(film);
    unsigned char *row = ARENA_NEW(arena, unsigned char, max);
    size_t size = film_pack_row(film, 3, row, *arena);
    for (size_t cut = 0; cut < size; cut++) {
        assert_fails_with(film_unpack_row(to, 3, (PackedRow){row, cut}, SAMPLES, *arena, &err),
                          "damaged sums: row 3 is not as a film packs it");
    }
    row[0] = 17;
    assert_fails(film_unpack_row(to, 3, (PackedRow){row, size}, SAMPLES, *arena, &err), "");
    film_pack_row(film, 3, row, *arena);
    assert_fails_with(film_unpack_row(to, 3, (PackedRow){row, size}, 7, *arena, &err),
                      "damaged sums: pixel 1,3 has sums that 7 samples cannot have made");
}

/* ---- files ------------------------------------------------------------------------------- */

static Checkpoint description(const Film *film) {
    Checkpoint what = {.path = path,
                       .identity = "version\t1\nseed\t9\n",
                       .done = film_part_of(film, FIRST, FIRST + SAMPLES),
                       .seconds = 12.5,
                       .has_features = true};
    what.done.asked_end = 1000;
    what.done.paths = 1;
    what.done.camera_rays = 2;
    what.done.bounce_rays = 3;
    what.done.shadow_rays = 4;
    return what;
}

static void write_one(Arena *arena) {
    Film *film = make_film(0, arena);
    Checkpoint what = description(film);
    assert_done(checkpoint_write(&what, film, *arena, &err));
}

MEMORY_TEST(what_is_kept_comes_back) {
    Checkpoint found;
    Film *film = make_film(LAYER_ALL, arena);
    Checkpoint what = description(film);
    assert_false(checkpoint_is_there(path));
    assert_done(checkpoint_write(&what, film, *arena, &err));
    assert_true(checkpoint_is_there(path));
    assert_done(checkpoint_open(path, arena, &found, &err));
    assert_string_equal(found.identity, what.identity);
    assert_true(found.has_features && found.seconds == 12.5);
    assert_int_equal(found.done.first_sample, FIRST);
    assert_int_equal(found.done.end_sample, FIRST + SAMPLES);
    assert_int_equal(found.done.asked_end, 1000);
    assert_memory_equal(&found.done.crop, &crop, sizeof crop);
    assert_memory_equal(&found.done.dropped, &what.done.dropped, sizeof what.done.dropped);
    assert_true(found.done.paths == 1 && found.done.camera_rays == 2 &&
                found.done.bounce_rays == 3 && found.done.shadow_rays == 4);
    Film *again = film_create(WIDTH, HEIGHT, crop, LAYER_ALL, &groups, arena);
    assert_done(checkpoint_load(&found, again, *arena, &err));
    assert_same_films(film, again);
}

MEMORY_TEST(it_fits_the_same_pixels_and_as_many_samples_or_more) {
    Error err = {0};
    Checkpoint found;
    write_one(arena);
    assert_true(checkpoint_open(path, arena, &found, &err));
    FilmPart wanted = {.crop = crop, .first_sample = FIRST, .end_sample = FIRST + SAMPLES};
    assert_true(checkpoint_fits(&found, &wanted, &err));
    wanted.end_sample = 5000;
    assert_true(checkpoint_fits(&found, &wanted, &err));
    wanted.end_sample = FIRST + SAMPLES - 1;
    assert_false(checkpoint_fits(&found, &wanted, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(err.file, path);
    assert_string_equal(err.text, "has samples 3:43 of every pixel already, more than the 3:42 "
                                  "that are asked for — ask for 40 or more");
    wanted.first_sample = 0;
    assert_false(checkpoint_fits(&found, &wanted, &err));
    assert_string_equal(err.text, "is of other samples: from 3 there, from 0 here");
    wanted.crop.x1--;
    assert_false(checkpoint_fits(&found, &wanted, &err));
    assert_string_equal(err.text, "is of other pixels: 1,2,6,5 there, 1,2,5,5 here");
}

/* The file's bytes, and them with a checksum that is right. */
static FileBytes read_file(Arena *arena) {
    FileBytes bytes;
    assert_done(file_read(path, 1 << 20, arena, &bytes, &err));
    return bytes;
}

static void put_file(const unsigned char *bytes, size_t size, bool with_checksum) {
    FILE *file = fopen(path, "wb");
    uint64_t checksum = XXH3_64bits(bytes, size - 8);
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, with_checksum ? size - 8 : size, file),
                     with_checksum ? size - 8 : size);
    if (with_checksum) assert_int_equal(fwrite(&checksum, 1, 8, file), 8);
    assert_int_equal(fclose(file), 0);
}

/* Opens and loads; the error is one line. */
static bool goes_on(Arena scratch, Error *err) {
    Checkpoint found;
    Film *film = film_create(WIDTH, HEIGHT, crop, 0, &groups, &scratch);
    bool done =
        checkpoint_open(path, &scratch, &found, err) && checkpoint_load(&found, film, scratch, err);
    if (!done) {
        assert_int_equal(err->code, ERROR_INPUT);
        assert_string_equal(err->file, path);
        assert_null(strchr(err->text, '\n'));
    }
    return done;
}

MEMORY_TEST(every_prefix_is_refused) {
    Error err;
    write_one(arena);
    FileBytes bytes = read_file(arena);
    assert_in_range(bytes.size, 1000, 20000);
    for (size_t size = bytes.size; size-- > 0;) {
        assert_int_equal(truncate(path, (off_t)size), 0);
        if (goes_on(*arena, &err)) fail_msg("%zu of %zu bytes are taken", size, bytes.size);
        const char *wanted = size < 8 ? "is not a checkpoint" : "is cut off: has ";
        if (strncmp(err.text, wanted, strlen(wanted)) != 0)
            fail_msg("%zu bytes: %s", size, err.text);
    }
    put_file(bytes.data, bytes.size, false);
    assert_true(goes_on(*arena, &err));
}

MEMORY_TEST(every_changed_byte_is_refused) {
    Error err;
    uint32_t random = 1;
    write_one(arena);
    FileBytes bytes = read_file(arena);
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    setvbuf(file, NULL, _IONBF, 0);
    for (size_t i = 0; i < 2 * bytes.size; i++) {
        size_t at = i / 2;
        int change =
            i % 2 ? 1 << (int)(8 * random_unit(&random)) : 1 + (int)(255 * random_unit(&random));
        fseek(file, (long)at, SEEK_SET);
        fputc(bytes.data[at] ^ change, file);
        if (goes_on(*arena, &err)) fail_msg("byte %zu xor %d is taken", at, change);
        fseek(file, (long)at, SEEK_SET);
        fputc(bytes.data[at], file);
    }
    fclose(file);
    assert_true(goes_on(*arena, &err));
}

/* Offsets of the head's members (checkpoint.c). */
enum {
    AT_ORDER = 8,
    AT_VERSION = 12,
    AT_BYTES = 16,
    AT_IDENTITY = 24,
    AT_CROP = 40,
    AT_FIRST = 64,
    AT_ASKED = 72,
    AT_DROPPED = 112,
    AT_SECONDS = 120,
    AT_KEPT = 224,
    HEAD_BYTES = 232
};

MEMORY_TEST(each_fault_has_its_line) {
    static const struct {
        size_t at;
        uint32_t value;
        bool with_checksum;
        const char *text;
    } cases[] = {
        {0, 0, true, "is not a checkpoint"},
        {AT_ORDER, 0x04030201, true, "is a checkpoint of a machine of another byte order"},
        {AT_VERSION, 2, true, "is a checkpoint of format version 2, this program reads version 1"},
        {AT_BYTES, 100, true, "is damaged: has "},
        {AT_BYTES, 1 << 30, true, "is cut off: has "},
        {AT_IDENTITY, 1 << 20, true, "is damaged: its identity cannot be"},
        {AT_CROP, 6, true, "is damaged: its crop cannot be"},
        {AT_CROP + 8, 8, true, "is damaged: its crop cannot be"},
        {AT_CROP + 12, 6, true, "is damaged: its crop cannot be"},
        {AT_CROP + 4, 0xffffffff, true, "is damaged: its crop cannot be"},
        {AT_FIRST, FIRST + SAMPLES, true, "is damaged: its range of samples cannot be"},
        {AT_ASKED, 4, true, "is damaged: its range of samples cannot be"},
        {AT_DROPPED, 0, true, "is damaged: its list of dropped samples cannot be"},
        {AT_KEPT, 9, true, "is damaged: its list of dropped samples cannot be"},
        {AT_SECONDS + 4, 0xfff00000, true, "is damaged: its duration cannot be"},
        {AT_FIRST, 4, false, "is damaged: its bytes have the checksum "},
        {HEAD_BYTES + 17, 0xffffffff, true, "is damaged: its size of a row cannot be"},
        {HEAD_BYTES + 17 + 4, 0x20202020, true, "damaged sums: row 2 is not as a film packs it"},
        {AT_FIRST, FIRST + SAMPLES - 1, true, "damaged sums: pixel 1,2 has sums that 1 samples"},
    };
    Error err;
    write_one(arena);
    FileBytes bytes = read_file(arena);
    unsigned char *copy = ARENA_NEW(arena, unsigned char, bytes.size);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        memcpy(copy, bytes.data, bytes.size);
        memcpy(copy + cases[i].at, &cases[i].value, 4);
        put_file(copy, bytes.size, cases[i].with_checksum);
        if (goes_on(*arena, &err)) fail_msg("case %zu is taken", i);
        if (strncmp(err.text, cases[i].text, strlen(cases[i].text)) != 0)
            fail_msg("case %zu: %s", i, err.text);
    }
    put_file(bytes.data, bytes.size, true);
    assert_true(goes_on(*arena, &err));
}

MEMORY_TEST(what_is_no_file_is_no_checkpoint) {
    Checkpoint found;
    unlink(path);
    assert_fails_with(checkpoint_open(path, arena, &found, &err),
                      "cannot be opened: No such file or directory");
    assert_int_equal(mkfifo(path, 0600), 0); /* nobody waits for its writer */
    assert_false(checkpoint_is_there(path));
    assert_fails_with(checkpoint_open(path, arena, &found, &err), "is not a checkpoint");
    unlink(path);
    assert_false(checkpoint_is_there(test_folder()));
    assert_fails_with(checkpoint_open(test_folder(), arena, &found, &err), "is not a checkpoint");
}

/* ---- a full disk ------------------------------------------------------------------------- */

MEMORY_TEST(a_full_disk_leaves_the_old_one_untouched) {
    Error err;
    struct rlimit kept, little;
    write_one(arena);
    FileBytes old = read_file(arena);
    Film *film = make_film(LAYER_ALL, arena);
    Checkpoint what = description(film);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &kept), 0);
    for (rlim_t room = 0; room < old.size; room += old.size / 7 + 1) {
        little = (struct rlimit){room, kept.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &little), 0);
        bool done = checkpoint_write(&what, film, *arena, &err);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &kept), 0);
        assert_false(done);
        assert_int_equal(err.code, ERROR_OUTPUT);
        assert_string_equal(err.text, "cannot be written: File too large");
        FileBytes now = read_file(arena);
        assert_int_equal(now.size, old.size);
        assert_memory_equal(now.data, old.data, old.size);
    }
    assert_int_equal(files_in_folder(), 1); /* the old one */
}

TEST_PROGRAM(make_checkpoint_path, remove_path)

/* SPDX-License-Identifier: Apache-2.0 */
/* Parts of a film: in any split, order and grouping they make the same bits as one film; what
 * does not make a whole, or is damaged, is refused by name. */
#include "film_fixture.h"

#include <fcntl.h>
#include <sys/mman.h>

#include "film/film_add.h"
#include "film/film_frame.h"
#include "film/film_merge.h"
#include "film/film_quarter.h"
#include "film/pixels.h"

enum { WIDTH = 9, HEIGHT = 23, SAMPLES = 40 };

static const FilmRect whole = {0, 0, WIDTH, HEIGHT};

static int make_part_path(void **state) {
    return make_path(state, "part.exr");
}

/* ---- films ------------------------------------------------------------------------------- */

static const char *const group_names[] = {"sun", "lamp", "sky"};
static const FilmLights groups = {3, group_names};

static int random_below(uint32_t *state, int end) {
    return (int)(random_unit(state) * (float)end) % end;
}

/* What depends on the pixel and the sample alone: over 18 powers of ten, negative ones too, and
 * some that are dropped. */
static FilmSample sample_of(int x, int y, uint32_t index) {
    uint32_t random = hash_combine((uint32_t)(y * WIDTH + x), index);
    FilmSample s = {.sample_index = index, .hit = random_unit(&random) < 0.9f};
    for (int i = 0; i < 3; i++) {
        s.xyz[i] =
            powf(10, -6 + 18 * random_unit(&random)) * (random_unit(&random) < 0.1f ? -1 : 1);
        s.position[i] = 100 * random_unit(&random) - 50;
        s.normal[i] = 2 * random_unit(&random) - 1;
        s.albedo[i] = random_unit(&random);
        s.emitted[i] = 500 * random_unit(&random);
        s.white[i] = 900 * random_unit(&random);
        s.black[i] = random_unit(&random);
    }
    s.depth = random_unit(&random) < 0.02f ? INFINITY : 10 * random_unit(&random);
    s.uv[0] = random_unit(&random);
    s.part_id = random_below(&random, 5);
    s.display_id = random_unit(&random) < 0.5f ? random_below(&random, 3) : -1;
    s.theta = random_unit(&random);
    s.phi = 6 * random_unit(&random);
    if (random_unit(&random) < 0.004f) s.xyz[1] = NAN;
    return s;
}

/* Shares of it by any number of groups, one sign each; what is left over is rounding's. */
static void light(FilmSample *s, FilmLight lights[3], uint32_t *random) {
    s->lights = lights;
    s->light_count = random_below(random, 4);
    for (int k = 0; k < s->light_count; k++) {
        lights[k].group = (k + (int)s->sample_index) % 3;
        for (int i = 0; i < 3; i++) lights[k].xyz[i] = s->xyz[i] / (float)s->light_count;
    }
}

static Film *make_film(FilmRect crop, uint32_t first, uint32_t end, unsigned layers, Arena *arena) {
    Film *film = film_create(WIDTH, HEIGHT, crop, layers, &groups, arena);
    for (int y = crop.y0; y < crop.y1; y++)
        for (int x = crop.x0; x < crop.x1; x++)
            for (uint32_t i = first; i < end; i++) {
                FilmSample sample = sample_of(x, y, i);
                uint32_t random = hash_combine(i, (uint32_t)(y * WIDTH + x));
                FilmLight lights[3];
                light(&sample, lights, &random);
                film_add_sample(film, x, y, &sample);
            }
    return film;
}

/* All pixels as files have them. */
static PixelSums *gathered(const Film *film, Arena *arena) {
    size_t count = film_index(film, film->crop.x0, film->crop.y1);
    PixelSums *pixels = arena_alloc(arena, film->stride, _Alignof(PixelSums), count);
    film_gather(film, 0, count, pixels);
    return pixels;
}

static void assert_same_films(const Film *a, const Film *b) {
    Arena room = arena_reserve((size_t)1 << 28);
    size_t bytes = film_index(a, a->crop.x0, a->crop.y1) * a->stride;
    assert_int_equal(a->stride, b->stride);
    assert_memory_equal(gathered(a, &room), gathered(b, &room), bytes);
    arena_release(&room);
    assert_memory_equal(&a->dropped, &b->dropped, sizeof a->dropped);
}

/* A whole film cut at random edges, in random order. */
typedef struct Cut {
    FilmRect crop;
    uint32_t first, end;
} Cut;

static int cut_up(Cut cuts[27], uint32_t *random) {
    int xs[] = {0, 1 + random_below(random, 3), 4 + random_below(random, 4), WIDTH};
    int ys[] = {0, 1 + random_below(random, 9), 10 + random_below(random, 10), HEIGHT};
    int is[] = {0, 1 + random_below(random, 14), 15 + random_below(random, 20), SAMPLES};
    for (int i = 0; i < 27; i++) {
        int x = i % 3, y = i / 3 % 3, s = i / 9;
        Cut cut = {{xs[x], ys[y], xs[x + 1], ys[y + 1]}, (uint32_t)is[s], (uint32_t)is[s + 1]};
        int place = random_below(random, i + 1);
        cuts[i] = cuts[place];
        cuts[place] = cut;
    }
    return 27;
}

/* ---- exactness --------------------------------------------------------------------------- */

ARENA_TEST(parts_in_any_split_and_order_make_the_same_bits) {
    uint32_t random = 1;
    Film *expected = make_film(whole, 0, SAMPLES, LAYER_ALL, &arena);
    assert_true(expected->dropped.count > FILM_DROPPED_KEPT);
    for (int round = 0; round < 5; round++) {
        Arena scratch = arena;
        Cut cuts[27];
        int count = cut_up(cuts, &random);
        Film *sum = film_create(WIDTH, HEIGHT, whole, LAYER_ALL, &groups, &scratch);
        for (int i = 0; i < count; i++) {
            Film *part = make_film(cuts[i].crop, cuts[i].first, cuts[i].end, LAYER_ALL, &scratch);
            assert_done(film_add_pixels(sum, part->crop, gathered(part, &scratch),
                                        cuts[i].end - cuts[i].first, &err));
            film_add_dropped(sum, &part->dropped);
        }
        assert_same_films(sum, expected);
    }
}

/* (a + b) + c against a + (b + c). */
ARENA_TEST(grouping_makes_no_difference) {
    Film *expected = make_film(whole, 0, SAMPLES, LAYER_DEPTH, &arena);
    for (int left = 0; left < 2; left++) {
        Film *part[] = {make_film(whole, 0, 7, LAYER_DEPTH, &arena),
                        make_film(whole, 7, 30, LAYER_DEPTH, &arena),
                        make_film(whole, 30, SAMPLES, LAYER_DEPTH, &arena)};
        Film *inner = part[left ? 0 : 1], *outer = part[left ? 2 : 0];
        Film *added = part[left ? 1 : 2];
        assert_done(film_add_pixels(inner, whole, gathered(added, &arena), SAMPLES, &err));
        film_add_dropped(inner, &added->dropped);
        assert_done(film_add_pixels(outer, whole, gathered(inner, &arena), SAMPLES, &err));
        film_add_dropped(outer, &inner->dropped);
        assert_same_films(outer, expected);
    }
}

/* Also at the edges, where there is half a pair. */
ARENA_TEST(a_quarter_has_the_samples_of_two_by_two_pixels) {
    static const FilmRect odd = {2, 3, WIDTH, HEIGHT - 3};
    Film *film = make_film(odd, 0, SAMPLES, LAYER_ALL, &arena);
    Film *quarter = film_quarter(film, 3, &arena);
    uint64_t kept = 0;
    assert_int_equal(quarter->width, (odd.x1 - odd.x0 + 1) / 2);
    assert_int_equal(quarter->height, (odd.y1 - odd.y0 + 1) / 2);
    for (int y = 0; y < quarter->height; y++)
        for (int x = 0; x < quarter->width; x++) {
            FilmRect two = {odd.x0 + 2 * x, odd.y0 + 2 * y, odd.x0 + 2 * x + 2, odd.y0 + 2 * y + 2};
            Arena scratch = arena;
            Film *sum =
                film_create(WIDTH, HEIGHT, (FilmRect){0, 0, 1, 1}, LAYER_ALL, &groups, &scratch);
            PixelSums *pixels = gathered(film, &scratch), *one = NULL;
            for (int v = two.y0; v < two.y1 && v < odd.y1; v++)
                for (int u = two.x0; u < two.x1 && u < odd.x1; u++) {
                    one = (PixelSums *)(void *)((char *)pixels +
                                                film_index(film, u, v) * film->stride);
                    assert_done(film_add_pixels(sum, sum->crop, one, SAMPLES, &err));
                }
            assert_memory_equal(gathered(sum, &scratch),
                                (char *)gathered(quarter, &scratch) +
                                    film_index(quarter, x, y) * film->stride,
                                film->stride);
            kept += film_sums(quarter, x, y)->samples;
        }
    assert_int_equal(kept, film_kept_samples(film));
}

/* ---- through files ----------------------------------------------------------------------- */

static void write_part(const Film *film, const FilmPart *part, Arena scratch) {
    FrameImage frame = film_to_frame(film, 0, &scratch);
    film_part_attach(&frame, film, part, &scratch);
    assert_done(frame_write(path, &frame, &err));
}

static bool read_part(Film *to, FilmPart *part, Arena scratch, Error *err) {
    FilmPartReader from;
    bool ok = true;
    if (!film_part_open(path, &scratch, &from, err)) return false;
    if (from.part.layers != to->layers || from.part.crop.x1 > WIDTH || from.part.crop.y1 > HEIGHT)
        ok = error_set(err, ERROR_INPUT, "not the part that was written");
    while (ok && from.next_y < from.part.crop.y1) ok = film_part_add_band(&from, to, scratch, err);
    *part = from.part;
    film_part_close(&from);
    return ok;
}

/* One by one: the bytes between members are nobody's. */
static void assert_same_parts(const FilmPart *a, const FilmPart *b) {
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(&a->crop, &b->crop, sizeof a->crop);
    assert_int_equal(a->layers, b->layers);
    assert_int_equal(a->first_sample, b->first_sample);
    assert_int_equal(a->end_sample, b->end_sample);
    assert_int_equal(a->asked_end, b->asked_end);
    assert_true(a->dropped.count == b->dropped.count);
    assert_int_equal(a->dropped.kept, b->dropped.kept);
    assert_memory_equal(a->dropped.first, b->dropped.first, sizeof a->dropped.first);
    assert_true(a->paths == b->paths && a->camera_rays == b->camera_rays);
    assert_true(a->bounce_rays == b->bounce_rays && a->shadow_rays == b->shadow_rays);
}

ARENA_TEST(files_carry_every_bit) {
    static const unsigned layers[] = {0, LAYER_ALL, LAYER_UV | LAYER_DISPLAY_CONTRAST};
    static const FilmRect crops[] = {{0, 0, WIDTH, HEIGHT}, {2, 3, 7, 22}, {8, 22, 9, 23}};
    for (int i = 0; i < 9; i++) {
        Film *film = make_film(crops[i % 3], 3, SAMPLES, layers[i / 3], &arena);
        Film *back = film_create(WIDTH, HEIGHT, crops[i % 3], layers[i / 3], &groups, &arena);
        FilmPart part = film_part_of(film, 3, SAMPLES), found;
        part.asked_end = 99;
        part.paths = 1;
        part.camera_rays = 1ull << 63;
        part.bounce_rays = 3;
        part.shadow_rays = 4;
        write_part(film, &part, arena);
        assert_done(read_part(back, &found, arena, &err));
        assert_same_films(back, film);
        assert_string_equal(found.name, path);
        assert_int_equal(found.lights.count, layers[i / 3] & LAYER_LIGHT ? 3 : 0);
        for (int k = 0; k < found.lights.count; k++)
            assert_string_equal(found.lights.names[k], group_names[k]);
        assert_same_parts(&found, &part);
    }
}

/* More than one band: rows of 1.1 MB, of which 48 (three chunks) fit into 64 MB. */
ARENA_TEST(long_parts_are_read_in_bands) {
    enum { WIDE = 5000, HIGH = 64 };
    FilmRect all = {0, 0, WIDE, HIGH};
    Film *film = film_create(WIDE, HIGH, all, 0, &groups, &arena);
    Film *back = film_create(WIDE, HIGH, all, 0, &groups, &arena);
    for (int p = 0; p < WIDE * HIGH; p += 97) {
        FilmSample sample = sample_of(p % WIDTH, p % HEIGHT, 0);
        film_add_sample(film, p % WIDE, p / WIDE, &sample);
    }
    FilmPart part = film_part_of(film, 0, 1);
    FilmPartReader from;
    int bands = 0;
    write_part(film, &part, arena);
    assert_done(film_part_open(path, &arena, &from, &err));
    for (; from.next_y < HIGH; bands++) assert_done(film_part_add_band(&from, back, arena, &err));
    film_part_close(&from);
    assert_int_equal(bands, 2);
    assert_same_films(back, film);
}

/* Bytes of the displays' sums that the system has lent. */
static size_t lent_bytes(const Film *film) {
    static unsigned char lent[1 << 16];
    size_t page = (size_t)sysconf(_SC_PAGESIZE), count = 0;
    uintptr_t begin = (uintptr_t)film->displays / page * page;
    uintptr_t end = (uintptr_t)film_displays_at(film, film_index(film, 0, film->height));
    assert_in_range((end - begin) / page, 1000, sizeof lent - 1);
    assert_int_equal(mincore((void *)begin, end - begin, lent), 0);
    for (size_t i = 0; i < (end - begin + page - 1) / page; i++) count += lent[i] & 1;
    return count * page;
}

/* Rows 20 to 23 of 64 show a display. The arena was used before. */
ARENA_TEST(sums_of_displays_take_memory_where_a_display_is_seen) {
    enum { WIDE = 500, HIGH = 64, SHOWN = 4 };
    FilmRect all = {0, 0, WIDE, HIGH};
    Arena scratch = arena;
    memset(ARENA_NEW(&scratch, char, 1 << 28), 255, 1 << 28);
    Film *film = film_create(WIDE, HIGH, all, LAYER_ALL, &groups, &arena);
    Film *back = film_create(WIDE, HIGH, all, LAYER_ALL, &groups, &arena);
    FilmSample sample = sample_of(1, 1, 0);
    for (int p = 0; p < WIDE * HIGH; p++) {
        sample.display_id = p / WIDE / SHOWN == 20 / SHOWN ? 1 : -1;
        film_add_sample(film, p % WIDE, p / WIDE, &sample);
    }
    FilmPart part = film_part_of(film, 0, 1);
    FilmPartReader from;
    write_part(film, &part, arena);
    assert_done(film_part_open(path, &arena, &from, &err));
    while (from.next_y < HIGH) assert_done(film_part_add_band(&from, back, arena, &err));
    film_part_close(&from);
    assert_same_films(back, film);
    size_t shown = SHOWN * WIDE * (size_t)film->display_numbers * sizeof(Fixed);
    assert_in_range(lent_bytes(film), shown, shown + 3 * 65536);
    assert_in_range(lent_bytes(back), shown, shown + 3 * 65536);
}

/* The names are what strangers read: a sample of Y = 1 is 2^48 steps, in word 1. */
ARENA_TEST(words_have_the_names_that_the_header_says) {
    static const char *const names[] = {"xyz.Y.0",   "xyz.Y.1",          "xyz.Z.3",       "samples",
                                        "part.id",   "display.sample",   "odd.samples",   "odd.X.1",
                                        "depth.Z.1", "squares.R.high.0", "direction.Z.0", "uv.V.1"};
    static const uint32_t values[] = {0, 1 << 16, 0xffffffffu, 1, 4, 0xffffffffu,
                                      1, 2 << 16, 3 << 16,     0, 0, 5 << 16};
    static const FilmRect one = {0, 0, 1, 1};
    Film *film = film_create(1, 1, one, LAYER_ALL, &groups, &arena);
    FilmSample sample = {.sample_index = 16,
                         .xyz = {2, 1, -1},
                         .hit = true,
                         .depth = 3,
                         .uv = {0, 5},
                         .part_id = 4,
                         .display_id = -1};
    film_add_sample(film, 0, 0, &sample);
    FilmPart part = film_part_of(film, 16, 17);
    ExrReader *reader;
    const ExrWords *found, wanted = {"film", 12, names, NULL, 0, NULL, NULL};
    uint32_t read[12];
    write_part(film, &part, arena);
    assert_done(exr_reader_open(path, &reader, &err));
    assert_done(exr_reader_words(reader, "film", &found, &err));
    assert_int_equal(found->count * 4, film->stride);
    assert_done(exr_reader_read_words(reader, &wanted, 0, 1, read, &err));
    for (int i = 0; i < 12; i++)
        if (read[i] != values[i]) fail_msg("%s is %x, not %x", names[i], read[i], values[i]);
    exr_reader_destroy(reader);
}

/* ---- damage ------------------------------------------------------------------------------ */

typedef struct Written {
    Film *film;
    FilmPart part;
    FileBytes bytes;
} Written;

static Written write_small(unsigned layers, Arena *arena) {
    static const FilmRect crop = {2, 3, 6, 20};
    Written w = {.film = make_film(crop, 0, 4, layers, arena)};
    w.part = film_part_of(w.film, 0, 4);
    write_part(w.film, &w.part, *arena);
    assert_done(file_read(path, 1 << 24, arena, &w.bytes, &err));
    return w;
}

/* Overwrites bytes of the part's file in place. */
static void patch(size_t at, const void *bytes, size_t size) {
    int file = open(path, O_WRONLY);
    assert_int_equal(pwrite(file, bytes, size, (off_t)at), size);
    close(file);
}

ARENA_TEST(a_flipped_bit_is_refused_or_changes_nothing) {
    Written w = write_small(LAYER_DEPTH, &arena);
    uint32_t random = 5;
    int refused = 0;
    for (int i = 0; i < 1500; i++) {
        Arena scratch = arena;
        Error err = {0};
        FilmPart found;
        Film *back = film_create(WIDTH, HEIGHT, whole, LAYER_DEPTH, &groups, &scratch);
        size_t at = (size_t)random_below(&random, (int)w.bytes.size);
        unsigned char flipped = w.bytes.data[at] ^ (unsigned char)(1u << (i & 7));
        patch(at, &flipped, 1);
        if (!read_part(back, &found, scratch, &err)) {
            refused++;
            assert_true(err.text[0] && !strchr(err.text, '\n'));
        } else {
            Film *sum = film_create(WIDTH, HEIGHT, whole, LAYER_DEPTH, &groups, &scratch);
            film_add_pixels(sum, w.film->crop, gathered(w.film, &scratch), 4, &err);
            film_add_dropped(sum, &w.film->dropped);
            assert_same_films(back, sum);
            found.name = w.part.name;
            assert_memory_equal(&found, &w.part, sizeof found);
        }
        patch(at, w.bytes.data + at, 1);
    }
    print_message("%d of 1500 flipped bits are refused\n", refused);
    assert_true(refused > 700);
}

ARENA_TEST(every_prefix_is_refused) {
    Written w = write_small(LAYER_DEPTH, &arena);
    for (size_t size = w.bytes.size; size > 100; size -= size < 4000 ? 7 : 101) {
        Arena scratch = arena;
        Error err = {0};
        FilmPart found;
        Film *back = film_create(WIDTH, HEIGHT, whole, LAYER_DEPTH, &groups, &scratch);
        assert_int_equal(truncate(path, (off_t)(size - 1)), 0);
        if (read_part(back, &found, scratch, &err))
            fail_msg("%zu of %zu bytes were accepted", size - 1, w.bytes.size);
        assert_error_has(&err, "damaged");
    }
}

/* Puts `to` in place of `from` where it stands in the words' part. */
static void assert_refused(const Written *w, const char *from, const char *to,
                           const char *message) {
    size_t length = strlen(from);
    const char *words = memmem(w->bytes.data, w->bytes.size, "parhelion:askedSamples", 22);
    size_t before = (size_t)(words - (const char *)w->bytes.data);
    const char *place = memmem(words, w->bytes.size - before, from, length);
    Arena scratch = arena_reserve(1 << 22);
    Film *back = film_create(WIDTH, HEIGHT, whole, w->part.layers, &groups, &scratch);
    FilmPart found;
    if (!place || strlen(to) != length) fail_msg("no place for %s", to);
    size_t at = (size_t)(place - (const char *)w->bytes.data);
    patch(at, to, length);
    assert_fails(read_part(back, &found, scratch, &err), message);
    patch(at, from, length);
    arena_release(&scratch);
}

ARENA_TEST(what_is_said_of_the_sums_must_hold) {
    Written w = write_small(LAYER_DEPTH, &arena);
    assert_refused(&w, "0:4", "0:3", "damaged sums: parhelion:askedSamples cannot be read");
    assert_refused(&w, "0:4", "0:5", "damaged sums: their checksum is ");
    assert_refused(&w, "parhelion:askedSamples", "parhelion:askedSomples",
                   "damaged sums: parhelion:askedSamples cannot be read");
    assert_refused(&w, " bounce", " bouncy", "damaged sums: parhelion:cost cannot be read");
    assert_refused(&w, " shadow rays", " shadow rayz",
                   "damaged sums: parhelion:cost cannot be read");
    assert_refused(&w, "blocks of 16", "blocks of 17",
                   "its sums are of another version: \"1: sums");
    assert_refused(&w, "parhelion:checksum", "parhelion:chacksum",
                   "damaged sums: parhelion:checksum cannot be read");
    assert_refused(&w, "parhelion:layers", "parhelion:loyers",
                   "damaged sums: parhelion:layers cannot be read");
}

ARENA_TEST(names_of_lights_must_be_such_as_a_film_has) {
    Written w = write_small(LAYER_LIGHT, &arena);
    static const char *const bad[] = {"\nun\nlamp\nsky\n", "sky\nlamp\nsky\n", "sun\nlamp\nsky!"};
    for (int i = 0; i < 3; i++)
        assert_refused(&w, "sun\nlamp\nsky\n", bad[i],
                       "damaged sums: parhelion:lights cannot be read");
    assert_refused(&w, "sun\nlamp\nsky\n", "sun\nlamq\nsky\n", "damaged sums: their checksum is ");
    assert_refused(&w, "sun\nlamp\nsky\n", "sun\nl\nmp\nsky\n",
                   "damaged sums: 92 words a pixel, its layers have 104");
    assert_refused(&w, "parhelion:lights", "parhelion:lyghts",
                   "damaged sums: parhelion:lights cannot be read");
}

ARENA_TEST(the_checksum_knows_in_which_row_a_sum_stands) {
    const char *checksums[2];
    for (int y = 0; y < 2; y++) {
        Film *film = film_create(WIDTH, HEIGHT, whole, 0, &groups, &arena);
        FilmSample sample = sample_of(0, 0, 0);
        film_add_sample(film, 0, y, &sample);
        FilmPart part = film_part_of(film, 0, 1);
        FrameImage frame = film_to_frame(film, 0, &arena);
        film_part_attach(&frame, film, &part, &arena);
        const FrameImage words = {.attribute_count = frame.words->attribute_count,
                                  .attributes = (ExrAttribute *)frame.words->attributes};
        checksums[y] = frame_string(&words, "parhelion:checksum");
    }
    assert_string_not_equal(checksums[0], checksums[1]);
}

ARENA_TEST(another_set_of_layers_does_not_fit_the_words) {
    Film *film = film_create(WIDTH, HEIGHT, whole, LAYER_DEPTH, &groups, &arena);
    FilmPart part = film_part_of(film, 0, 1), found;
    FrameImage frame = film_to_frame(film, 0, &arena);
    film_part_attach(&frame, film, &part, &arena);
    ExrWords fewer = *frame.words;
    fewer.count -= 4;
    frame.words = &fewer;
    assert_done(frame_write(path, &frame, &err));
    assert_fails(read_part(film, &found, arena, &err),
                 "damaged sums: 56 words a pixel, its layers have 60");
    frame.words = NULL;
    assert_done(frame_write(path, &frame, &err));
    assert_fails(read_part(film, &found, arena, &err),
                 "carries no sums, only means: it cannot be merged");
}

ARENA_TEST(sums_that_no_samples_make_are_refused) {
    Film *sum = film_create(WIDTH, HEIGHT, whole, LAYER_UV, &groups, &arena);
    for (int i = 0; i < 7; i++) {
        Film *film = make_film(whole, 0, 3, LAYER_UV, &arena);
        PixelSums *pixel = film_sums(film, 4, 5);
        if (i == 0) pixel->xyz[1] = (Fixed)4 << 96;
        if (i == 1) pixel->odd_xyz[2] = -((Fixed)4 << 96);
        if (i == 2) pixel->layers[1] = (Fixed)1 << 126;
        if (i == 3) pixel->samples = 4;
        if (i == 4) pixel->hits = 4;
        if (i == 5) pixel->display_hits = 4;
        if (i == 6) pixel->odd_samples = 4;
        assert_fails(film_add_pixels(sum, whole, gathered(film, &arena), 3, &err),
                     "damaged sums: pixel 4,5 has sums that 3 samples cannot have");
    }
}

/* ---- do they make a whole ---------------------------------------------------------------- */

static FilmPart box(const char *name, FilmRect crop, uint32_t first, uint32_t end) {
    return (FilmPart){.name = name,
                      .width = WIDTH,
                      .height = HEIGHT,
                      .crop = crop,
                      .first_sample = first,
                      .end_sample = end,
                      .asked_end = end};
}

ARENA_TEST(parts_that_fill_a_box_are_a_whole) {
    uint32_t random = 9;
    for (int round = 0; round < 50; round++) {
        Cut cuts[27];
        FilmPart parts[27], all;
        int count = cut_up(cuts, &random);
        for (int i = 0; i < count; i++)
            parts[i] = box("a.exr", cuts[i].crop, cuts[i].first + 5, cuts[i].end + 5);
        assert_done(film_merge_check(parts, count, arena, &all, &err));
        assert_memory_equal(&all.crop, &whole, sizeof whole);
        assert_int_equal(all.first_sample, 5);
        assert_int_equal(all.end_sample, SAMPLES + 5);
        assert_int_equal(all.asked_end, SAMPLES + 5);
        parts[round % 26] = parts[26]; /* one is missing; another is there twice, at the end */
        assert_fails(film_merge_check(parts, count - 1, arena, &all, &err), "no part has samples ");
        assert_fails(film_merge_check(parts, count, arena, &all, &err), "are in a.exr as well");
    }
}

ARENA_TEST(overlaps_are_named) {
    FilmPart parts[] = {box("a.exr", (FilmRect){0, 0, 5, 6}, 0, 4),
                        box("b.exr", (FilmRect){5, 0, 9, 6}, 0, 4),
                        box("c.exr", (FilmRect){3, 2, 8, 9}, 3, 9)},
             all;
    Error err = {0};
    assert_true(film_merge_check(parts, 2, arena, &all, &err));
    assert_false(film_merge_check(parts, 3, arena, &all, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(err.file, "c.exr");
    assert_error_has(&err, "pixels 3,2,5,6, samples 3:4 are in a.exr as well — leave one");
}

ARENA_TEST(gaps_are_named) {
    static const FilmRect left = {0, 0, 4, HEIGHT}, right = {4, 0, WIDTH, HEIGHT};
    FilmPart all, parts[] = {box("a.exr", left, 0, 4), box("b.exr", right, 0, 4),
                             box("c.exr", left, 4, 8), box("d.exr", right, 6, 8)};
    Error err = {0};
    assert_false(film_merge_check(parts, 4, arena, &all, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(err.file, "");
    assert_error_has(&err, "no part has samples 4:6 of pixels 4,0,9,23 — add what `render "
                           "--samples 4:6 --crop 4,0,9,23` makes");
    assert_false(film_merge_check(parts, 3, arena, &all, &err));
    assert_error_has(&err, "no part has samples 4:8 of pixels 4,0,9,23");
    assert_false(film_merge_check(parts + 1, 2, arena, &all, &err));
    assert_error_has(&err, "no part has samples 0:4 of pixels 0,0,4,23");
    parts[0].asked_end = 4;
    parts[2].end_sample = 5;
    parts[3].first_sample = 4;
    parts[2].asked_end = 8;
    assert_false(film_merge_check(parts, 4, arena, &all, &err));
    assert_string_equal(err.file, "c.exr");
    assert_error_has(&err, "incomplete: it was stopped after samples 4:5 of 4:8 — render the "
                           "whole part");
}

/* Also when what it was requested to hold makes the range that all are to have. */
ARENA_TEST(a_part_that_was_stopped_may_be_filled_by_others) {
    FilmPart all,
        parts[] = {box("a.exr", whole, 0, 4), box("b.exr", whole, 4, 6), box("c.exr", whole, 6, 8)};
    Error err = {0};
    parts[1].asked_end = 8;
    assert_false(film_merge_check(parts, 2, arena, &all, &err));
    assert_string_equal(err.file, "b.exr");
    assert_error_has(&err, "stopped after samples 4:6 of 4:8");
    assert_true(film_merge_check(parts, 3, arena, &all, &err));
    assert_int_equal(all.end_sample, 8);
    parts[0].end_sample = parts[0].asked_end = 3; /* what is missing first is not b's fault */
    assert_false(film_merge_check(parts, 2, arena, &all, &err));
    assert_string_equal(err.file, "");
    assert_error_has(&err, "no part has samples 3:4 of pixels 0,0,9,23");
}

TEST_PROGRAM(make_part_path, remove_path)

/* SPDX-License-Identifier: Apache-2.0 */
/* The ground floor: numbers, vectors, samples, memory and messages. */
#include "fixture.h"

#include "base/arena.h"
#include "base/error.h"
#include "base/mathf.h"
#include "base/problems.h"
#include "base/sampler.h"
#include "base/sort.h"
#include "base/units.h"
#include "base/vec.h"

/* ---- mathf --------------------------------------------------------------------------- */

TEST(sine_and_cosine_are_within_their_stated_error) {
    double most = 0;
    for (int i = -400000; i <= 400000; i++) {
        float t = (float)i * 1e-5f, sine, cosine;
        sincos_turns(t, &sine, &cosine);
        most = fmax(most, fabs((double)sine - sin(2 * PI * (double)t)));
        most = fmax(most, fabs((double)cosine - cos(2 * PI * (double)t)));
    }
    assert_true(most < 1e-7);
    float sine, cosine;
    sincos_turns(0.25f, &sine, &cosine);
    assert_true(sine == 1 && fabsf(cosine) < 1e-15f);
    sincos_turns(-0x1p-149f, &sine, &cosine);
    assert_true(fabsf(sine) < 1e-15f && cosine == 1);
}

TEST(exponential_is_within_its_stated_error) {
    double most = 0;
    for (int i = -870000; i <= 880000; i++) {
        float x = (float)i * 1e-4f;
        most = fmax(most, fabs((double)exp_f(x) / exp((double)x) - 1));
    }
    assert_true(most < 2e-7);
    assert_true(exp_f(0) == 1 && exp_f(-1000) == 0 && isinf(exp_f(1000)) && isnan(exp_f(NAN)));
}

TEST(logarithm_is_within_its_stated_error) {
    double most = 0;
    for (uint32_t bits = 1; bits < 0x7f800000u; bits += 2039) {
        float x = float_from_bits(bits);
        double exact = log((double)x);
        most = fmax(most, fabs((double)log_f(x) - exact) / fmax(1, fabs(exact)));
    }
    assert_true(most < 2e-7);
    assert_true(log_f(1) == 0 && isinf(log_f(0)) && log_f(0) < 0);
}

TEST(powers_are_within_their_stated_error) {
    for (int e = -40; e <= 40; e++)
        for (int i = 1; i < 2000; i++) {
            float base = (float)i * 0.0021f, exponent = (float)e * 0.13f;
            double exact = pow((double)base, (double)exponent);
            double bound = 3e-7 * (1 + fabs((double)exponent * log((double)base)));
            assert_near((double)pow_f(base, exponent) / exact, 1, bound);
        }
    assert_true(pow_f(0, 2) == 0 && pow_f(-1, 2) == 0);
}

TEST(inverse_tangent_and_cosine_are_within_their_stated_error) {
    double most = 0;
    for (int i = 0; i < 200000; i++) {
        double angle = (i + 0.5) / 200000 * 2 * PI - PI, size = i % 7 == 0 ? 1e-20 : 3.7;
        float x = (float)(size * cos(angle)), y = (float)(size * sin(angle));
        most = fmax(most, fabs((double)atan2_f(y, x) - atan2((double)y, (double)x)));
    }
    for (int i = 0; i <= 200000; i++) {
        float c = (float)(i - 100000) * 1e-5f;
        most = fmax(most, fabs((double)acos_f(c) - acos((double)c)));
    }
    assert_true(most < 1e-6);
    assert_true(atan2_f(0, 0) == 0 && acos_f(2) == 0);
    assert_near(acos_f(-2), PI, 1e-6);
    assert_near(acos_f(1 - 0x1p-24f), acos(1 - 0x1p-24), 1e-9);
}

TEST(roots_and_clamps_hold_at_their_ends) {
    assert_true(safe_sqrtf(-1) == 0 && safe_sqrtf(4) == 2 && safe_sqrtf(NAN) == 0);
    assert_true(clampf(-1, 0, 1) == 0 && clampf(2, 0, 1) == 1 && clampf(0.5f, 0, 1) == 0.5f);
    assert_true(lerpf(2, 4, 0) == 2 && lerpf(2, 4, 1) == 4);
    for (uint32_t bits = 0; bits < 0x7f000000u; bits += 99991)
        assert_true(bits_from_float(float_from_bits(bits)) == bits);
    assert_near(degrees_from_radians(radians_from_degrees(73.5)), 73.5, 1e-12);
    assert_near(radians_from_degrees(180), PI, 0);
}

/* ---- vectors ------------------------------------------------------------------------- */

static Vec3 random_vector(uint32_t *seed) {
    float v[3];
    for (int i = 0; i < 3; i++) v[i] = 2 * unit_float(*seed = hash_u32(*seed + 1)) - 1;
    return vec3(v[0], v[1], v[2]);
}

static void assert_vector(Vec3 a, Vec3 b, double within) {
    assert_near(vec3_length(vec3_sub(a, b)), 0, within);
}

TEST(frames_are_orthonormal_and_right_handed) {
    uint32_t seed = 5;
    for (int i = 0; i < 10000; i++) {
        Vec3 z = vec3_normalize(random_vector(&seed));
        if (i == 0) z = vec3(0, 0, 1);
        if (i == 1) z = vec3(0, 0, -1);
        if (i == 2) z = vec3(0, 1, -0.0f);
        Frame f = frame_from_z(z);
        assert_vector(vec3_cross(f.x, f.y), f.z, 1e-6);
        assert_near(vec3_dot(f.x, f.y), 0, 1e-6);
        assert_near(vec3_length(f.x), 1, 1e-6);
        assert_near(vec3_length(f.y), 1, 1e-6);
        Vec3 v = random_vector(&seed);
        assert_vector(frame_to_world(&f, frame_to_local(&f, v)), v, 1e-6);
        assert_near(frame_to_local(&f, z).z, 1, 1e-6);
    }
}

static Transform random_transform(uint32_t *seed) {
    return (Transform){random_vector(seed), random_vector(seed), random_vector(seed),
                       random_vector(seed)};
}

TEST(composed_transforms_act_one_after_the_other) {
    uint32_t seed = 9;
    for (int i = 0; i < 1000; i++) {
        Transform a = random_transform(&seed), b = random_transform(&seed);
        Transform ab = transform_compose(&a, &b), one = transform_identity();
        Vec3 p = random_vector(&seed);
        assert_vector(transform_point(&ab, p), transform_point(&a, transform_point(&b, p)), 1e-5);
        assert_vector(transform_vector(&ab, p), transform_vector(&a, transform_vector(&b, p)),
                      1e-5);
        assert_vector(transform_point(&one, p), p, 0);
        assert_near(transform_determinant(&ab),
                    transform_determinant(&a) * transform_determinant(&b), 1e-4);
    }
}

TEST(transformed_normals_stay_normal_and_outside) {
    uint32_t seed = 21;
    for (int i = 0; i < 1000; i++) {
        Transform t = random_transform(&seed);
        Vec3 a = random_vector(&seed), b = random_vector(&seed), n = vec3_cross(a, b);
        Vec3 moved = transform_normal(&t, n);
        assert_near(vec3_dot(moved, transform_vector(&t, a)), 0, 1e-5);
        assert_near(vec3_dot(moved, transform_vector(&t, b)), 0, 1e-5);
        /* what lay on the outer side still does */
        assert_true(vec3_dot(moved, transform_vector(&t, n)) >= -1e-6f);
    }
}

TEST(the_zero_vector_has_no_direction) {
    assert_vector(vec3_normalize(vec3(0, 0, 0)), vec3(0, 0, 0), 0);
    assert_true(vec3_is_within(vec3(1, -2, 3), 3) && !vec3_is_within(vec3(1, -2, 3), 2.9f));
    assert_false(vec3_is_within(vec3(1, NAN, 3), INFINITY));
}

/* ---- sampler ------------------------------------------------------------------------- */

/* Every elementary interval of area 1 / count holds exactly one of the block's points. */
static void assert_net(int x, int dimension, uint32_t first, int log_count) {
    int count = 1 << log_count;
    for (int across = 0; across <= log_count; across++) {
        uint8_t hit[1024] = {0};
        for (int i = 0; i < count; i++) {
            Sampler sampler = sampler_start(3, x, 5, first + (uint32_t)i);
            Vec2 p = {0, 0};
            for (int d = 0; d <= dimension; d++) p = sampler_2d(&sampler);
            int column = (int)(p.x * (float)(1 << across));
            int row = (int)(p.y * (float)(count >> across));
            hit[row << across | column]++;
        }
        for (int i = 0; i < count; i++)
            if (hit[i] != 1)
                fail_msg("pixel %d, pair %d, block %u of %d: interval %d of 2^%d columns has %d", x,
                         dimension, first, count, i, across, hit[i]);
    }
}

TEST(every_pair_is_a_0_2_sequence_over_a_pixel_s_samples) {
    for (int x = 0; x < 6; x++)
        for (int dimension = 0; dimension < 5; dimension++)
            for (int log_count = 0; log_count <= 10; log_count += 2)
                for (uint32_t block = 0; block < 3; block++)
                    assert_net(x, dimension, block << log_count, log_count);
}

/* Chi-square of pairs of numbers on a 16 x 16 grid, as a standard normal deviate. */
static double grid_deviate(const double histogram[256], int count) {
    double chi2 = 0, expected = count / 256.0, v = 2.0 / (9 * 255);
    for (int i = 0; i < 256; i++)
        chi2 += (histogram[i] - expected) * (histogram[i] - expected) / expected;
    return (cbrt(chi2 / 255) - (1 - v)) / sqrt(v);
}

TEST(pairs_are_independent_of_each_other) {
    for (int other = 1; other < 8; other++) {
        double histogram[256] = {0};
        for (int pixel = 0; pixel < 4096; pixel++)
            for (uint32_t i = 0; i < 16; i++) {
                Sampler sampler = sampler_start(1, pixel % 64, pixel / 64, i);
                float a = sampler_2d(&sampler).x, b = 0;
                for (int d = 0; d < other; d++) b = sampler_2d(&sampler).x;
                histogram[(int)(a * 16) * 16 + (int)(b * 16)]++;
            }
        assert_true(grid_deviate(histogram, 65536) < 4);
    }
}

TEST(neighbouring_pixels_and_seeds_are_independent) {
    for (int step = 1; step < 5; step++) {
        double histogram[256] = {0};
        for (int x = 0; x < 256; x++)
            for (int y = 0; y < 256; y++) {
                Sampler a = sampler_start(7, x, y, 0);
                Sampler b = step < 3 ? sampler_start(7, x + (step == 1), y + (step == 2), 0)
                                     : sampler_start(7 + (uint32_t)step, x, y, 0);
                histogram[(int)(sampler_1d(&a) * 16) * 16 + (int)(sampler_1d(&b) * 16)]++;
            }
        assert_true(grid_deviate(histogram, 65536) < 4);
    }
}

TEST(numbers_depend_on_nothing_but_their_place) {
    for (uint32_t i = 0; i < 100; i++) {
        Sampler a = sampler_start(1, 10, 20, i), b = sampler_start(1, 10, 20, i);
        for (int d = 0; d < 10; d++) {
            Vec2 p = sampler_2d(&a), q = sampler_2d(&b);
            assert_true(p.x == q.x && p.y == q.y);
            assert_true(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
        }
    }
    assert_true(unit_float(0xffffffffu) < 1);
}

TEST(two_pairs_at_once_are_two_pairs) {
    for (uint32_t i = 0; i < 100; i++) {
        Sampler a = sampler_start(1, 10, 20, i), b = a;
        for (int d = 0; d < 10; d++) {
            float u[4];
            Vec2 p = sampler_2d(&a), q = sampler_2d(&a);
            sampler_4d(&b, u);
            assert_true(p.x == u[0] && p.y == u[1] && q.x == u[2] && q.y == u[3]);
        }
    }
}

/* Of all numbers that there are, exactly its share is chosen, and what is left of those of
 * either outcome fills [0, 1) evenly: none of 100 equal bins is off by more than its ends. */
TEST(a_choice_leaves_an_even_number) {
    const float probs[] = {0, 0.1f, 0.5f, 0.99f, 1};
    for (int i = 0; i < 5; i++) {
        const int steps = 1 << 20;
        int bins[2][100] = {{0}}, chosen = 0;
        for (int k = 0; k < steps; k++) {
            float u = (float)k / (float)steps;
            bool yes = unit_choose(&u, probs[i]);
            assert_true(u >= 0 && u < 1);
            bins[yes][(int)(u * 100)]++;
            chosen += yes;
        }
        assert_near(chosen, steps * (double)probs[i], 1);
        for (int b = 0; b < 100; b++) {
            assert_near(bins[1][b], chosen / 100.0, 2);
            assert_near(bins[0][b], (steps - chosen) / 100.0, 2);
        }
    }
}

/* A (0,2)-sequence keeps its spread on either side of a choice: of 64 points those of one half
 * still have one in each of their 32 strips, along the number that chose and across it. */
TEST(points_of_a_choice_stay_spread) {
    for (int pixel = 0; pixel < 100; pixel++) {
        int along[2][32] = {{0}}, across[2][32] = {{0}};
        for (uint32_t i = 0; i < 64; i++) {
            Sampler sampler = sampler_start(9, pixel, 1, i);
            Vec2 p = sampler_2d(&sampler);
            bool yes = unit_choose(&p.x, 0.5f);
            along[yes][(int)(p.x * 32)]++;
            across[yes][(int)(p.y * 32)]++;
        }
        for (int b = 0; b < 64; b++) {
            assert_int_equal(along[b / 32][b % 32], 1);
            assert_int_equal(across[b / 32][b % 32], 1);
        }
    }
}

/* ---- sort ---------------------------------------------------------------------------- */

TEST(a_ranked_value_is_that_of_the_sorted_list) {
    enum { MOST = 70 };
    uint32_t random = 5;
    for (int count = 1; count <= MOST; count++)
        for (int rank = 0; rank < count; rank++) {
            float sorted[MOST], list[MOST];
            uint32_t kinds = rank % 3 ? 5 : 1000; /* many alike, or hardly any */
            for (int i = 0; i < count; i++)
                sorted[i] = list[i] = (float)(hash_u32(random++) % kinds);
            sort_floats(sorted, count);
            assert_true(sort_ranked(list, count, rank) == sorted[rank]);
            sort_floats(list, count);
            assert_memory_equal(list, sorted, (size_t)count * sizeof *list);
        }
}

/* ---- arena --------------------------------------------------------------------------- */

ARENA_TEST(a_list_grows_at_its_place_or_moves) {
    int *list = ARENA_GROW(&arena, int, NULL, 0, 3);
    for (int i = 0; i < 3; i++) list[i] = i + 1;
    int *longer = ARENA_GROW(&arena, int, list, 3, 100);
    assert_int_equal(longer[3], 0);
    arena_alloc(&arena, 1, 1, 1);
    int *moved = ARENA_GROW(&arena, int, longer, 100, 200);
    assert_ptr_not_equal(moved, longer);
    for (int i = 0; i < 200; i++) assert_int_equal(moved[i], i < 3 ? i + 1 : 0);
}

TEST(arena_memory_is_aligned_and_zeroed) {
    Arena arena = arena_reserve(1 << 20);
    for (size_t align = 1; align <= 4096; align *= 2) {
        char *memory = arena_alloc(&arena, 3, align, 7);
        assert_true((uintptr_t)memory % align == 0);
        for (int i = 0; i < 21; i++) assert_int_equal(memory[i], 0);
        memset(memory, 0xff, 21);
    }
    assert_non_null(arena_alloc(&arena, 8, 8, 0));
    arena_release(&arena);
    assert_null(arena.begin);
    arena_release(&arena); /* again is fine */
}

static char *scratch_of(Arena scratch) {
    char *memory = ARENA_NEW(&scratch, char, 100);
    for (int i = 0; i < 100; i++) assert_int_equal(memory[i], 0);
    memset(memory, 1, 100);
    return memory;
}

ARENA_TEST(scratch_is_back_after_the_call) {
    char *first = scratch_of(arena);
    assert_ptr_equal(scratch_of(arena), first);
}

static jmp_buf when_full;
static size_t wanted, left;

static void note_full(size_t bytes_wanted, size_t bytes_left) {
    wanted = bytes_wanted;
    left = bytes_left;
    longjmp(when_full, 1);
}

TEST(a_full_arena_says_what_was_wanted_and_left) {
    Arena arena = arena_reserve(1 << 16);
    arena.on_full = note_full;
    arena_alloc(&arena, 1, 1, 65000);
    if (!setjmp(when_full)) {
        arena_alloc(&arena, 10, 1, 100);
        fail_msg("1000 bytes were found in 536");
    }
    assert_int_equal(wanted, 1000);
    assert_int_equal(left, 536);
    if (!setjmp(when_full)) {
        arena_alloc(&arena, SIZE_MAX / 2, 1, 3);
        fail_msg("more than the address space was found");
    }
    assert_true(wanted == SIZE_MAX);
    arena_alloc(&arena, 536, 1, 1); /* to the last byte */
    arena_release(&arena);
}

TEST(a_full_arena_may_have_a_way_out) {
    Arena arena = arena_reserve(1 << 16);
    jmp_buf way_out;
    arena.on_full = note_full;
    arena.way_out = &way_out;
    char *first = arena_alloc(&arena, 1, 1, 65000);
    assert_null(arena_try(&arena, 10, 1, 100));
    Arena scratch = arena;
    if (!setjmp(way_out)) fail_msg("%p", arena_alloc(&scratch, 10, 1, 100));
    assert_ptr_equal(arena_try(&arena, 1, 1, 536), first + 65000);
    arena_release(&arena);
}

TEST(a_trimmed_arena_keeps_what_it_holds) {
    Arena arena;
    assert_true(arena_try_reserve(1 << 24, &arena));
    char *bytes = arena_alloc(&arena, 1, 1, 100000);
    bytes[99999] = 7;
    arena_trim(&arena);
    assert_int_equal(arena.end - arena.begin, 1 << 17);
    assert_int_equal(bytes[99999], 7);
    arena_release(&arena);
}

ARENA_TEST(arena_texts_are_terminated_copies) {
    char source[] = "windscreen";
    char *copy = arena_string(&arena, source, 4);
    source[0] = 'W';
    assert_string_equal(copy, "wind");
    assert_string_equal(arena_format(&arena, "%s %d of %g", "lamp", 3, 0.5), "lamp 3 of 0.5");
    assert_string_equal(arena_string(&arena, "", 0), "");
}

/* Bytes made behind scratch, moved to where the scratch began, over each other. */
ARENA_TEST(what_is_kept_lies_where_the_arena_was) {
    Arena scratch = arena;
    ARENA_NEW(&scratch, char, 3);
    char *made = arena_string(&scratch, "0123456789", 10), *before = arena.next;
    const char *kept = arena_keep(&arena, made, 11, 16);
    assert_string_equal(kept, "0123456789");
    assert_int_equal((uintptr_t)kept % 16, 0);
    assert_in_range(kept - before, 0, 15);
    assert_true(arena.next >= kept + 11);
}

/* ---- errors and problems ------------------------------------------------------------- */

TEST(an_error_s_line_has_file_place_and_text) {
    Error err;
    char line[2048];
    assert_false(error_set(&err, ERROR_USAGE, "size %d", 3));
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "size 3");
    assert_false(error_at(&err, ERROR_INPUT, "car.gltf", "/materials/3", "ior %g", 0.5));
    assert_false(error_prefix(&err, "material '%s'", "glass"));
    assert_false(error_in_file(&err, "other.gltf")); /* named already */
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "car.gltf: /materials/3: material 'glass': ior 0.5");
    assert_int_equal(err.code, ERROR_INPUT);
    assert_false(error_at(&err, ERROR_OUTPUT, NULL, NULL, "full"));
    assert_false(error_in_file(&err, "a.exr"));
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "a.exr: full");
}

/* What a file holds may be quoted; it may neither break the line nor command a terminal. */
ARENA_TEST(a_message_is_one_line_whatever_it_quotes) {
    Error err;
    char line[2048];
    Problems problems = problems_start(&arena);
    error_at(&err, ERROR_INPUT, "a\nb", "/x\r", "found \"%s\"", "\033[2J\t\177\n\303\244");
    error_prefix(&err, "%s", "in\n");
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "a\\u000Ab: /x\\u000D: in\\u000A: found "
                              "\"\\u001B[2J\\u0009\\u007F\\u000A\303\244\"");
    problems_add(&problems, SEVERITY_WARNING, "a\nb", "/x\r", "%s", "c\nd");
    assert_string_equal(problems.list[0].file, "a\\u000Ab");
    assert_string_equal(problems.list[0].path, "/x\\u000D");
    assert_string_equal(problems.list[0].message, "c\\u000Ad");
}

TEST(a_long_error_is_cut_and_stays_a_string) {
    Error err;
    char word[2000], line[64];
    memset(word, 'x', sizeof word - 1);
    word[sizeof word - 1] = '\0';
    error_at(&err, ERROR_INPUT, word, word, "%s", word);
    error_prefix(&err, "%s", word);
    assert_int_equal(strlen(err.text), sizeof err.text - 1);
    assert_int_equal(strlen(err.file), sizeof err.file - 1);
    assert_int_equal(strlen(err.path), sizeof err.path - 1);
    error_line(&err, line, sizeof line);
    assert_int_equal(strlen(line), sizeof line - 1);
}

TEST(exit_statuses_follow_the_codes) {
    static const struct {
        ErrorCode code;
        int status;
    } cases[] = {{ERROR_NONE, 0},   {ERROR_UNUSABLE, 1}, {ERROR_USAGE, 2}, {ERROR_INPUT, 3},
                 {ERROR_OUTPUT, 4}, {ERROR_LIBRARY, 3},  {ERROR_MEMORY, 3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        if (error_exit_status(cases[i].code) != cases[i].status)
            fail_msg("code %d: status %d, required: %d", (int)cases[i].code,
                     error_exit_status(cases[i].code), cases[i].status);
}

ARENA_TEST(problems_keep_their_order_and_their_texts) {
    Problems problems = problems_start(&arena);
    Error err;
    char path[32], line[2048];
    assert_true(problems_verdict(&problems, &err));
    problems_add(&problems, SEVERITY_WARNING, "a.gltf", "/x", "odd");
    assert_true(problems_verdict(&problems, &err));
    for (int i = 0; i < 100; i++) {
        snprintf(path, sizeof path, "/nodes/%d", i);
        problems_add(&problems, SEVERITY_ERROR, "a.gltf", path, "bad %d", i);
    }
    error_at(&err, ERROR_OUTPUT, NULL, NULL, "disk");
    problems_add_error(&problems, &err);
    assert_int_equal(problems.count, 102);
    assert_int_equal(problems.error_count, 101);
    for (int i = 0; i < 100; i++) {
        snprintf(path, sizeof path, "/nodes/%d", i);
        assert_string_equal(problems.list[i + 1].path, path);
    }
    assert_string_equal(problems.list[101].file, "");
    assert_false(problems_verdict(&problems, &err));
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "a.gltf: /nodes/0: bad 0 (and 100 more: see `parhelion check`)");
}

ARENA_TEST(a_hundred_of_one_kind_are_listed) {
    enum { MANY = 250000 };
    Problems problems = problems_start(&arena);
    Error err;
    char line[2048];
    for (int i = 0; i < MANY; i++) {
        problems_add(&problems, SEVERITY_WARNING, "a.gltf", "/x", "odd %d", i);
        if (i % 1000 == 0) problems_add(&problems, SEVERITY_ERROR, "a.gltf", "", "bad %d", i);
        if (i % 1000 == 0) problems_add(&problems, SEVERITY_WARNING, "", "", "%s", "apart");
    }
    assert_int_equal(problems.count, 101 + 101 + MANY / 1000);
    assert_int_equal(problems.error_count, MANY / 1000);
    assert_int_equal(problems.warning_count, MANY + MANY / 1000);
    int found = 0;
    for (int i = 0; i < problems.count; i++) {
        const Problem *one = &problems.list[i];
        if (!strcmp(one->message, "and 249900 more like 'odd 0...'")) found += !one->path[0];
        if (!strcmp(one->message, "and 150 more like 'bad 0...'")) found += 10;
    }
    assert_int_equal(found, 11);
    assert_false(problems_verdict(&problems, &err));
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "a.gltf: bad 0 (and 249 more: see `parhelion check`)");
}

ARENA_TEST(a_single_error_is_its_own_verdict) {
    Problems problems = problems_start(&arena);
    Error err;
    char line[2048];
    problems_add(&problems, SEVERITY_ERROR, NULL, NULL, "empty scene");
    assert_false(problems_verdict(&problems, &err));
    error_line(&err, line, sizeof line);
    assert_string_equal(line, "empty scene");
}

TEST_PROGRAM(make_arena, drop_arena)

/* SPDX-License-Identifier: Apache-2.0 */
/* A display's sub-pixels: their mean, their order, and nothing of them from far. */
#include "panel_fixture.h"

#include "base/count.h"
#include "base/sampler.h"
#include "bvh/bvh.h"
#include "camera/camera.h"
#include "light/subpixels.h"
#include "path/collect/seen.h"
#include "path/path_features.h"
#include "scene_builder.h"

static Fixture ips;

static int start_ips(void **state)
{
    *state = &ips;
    FitOptions options = fit_options_default();
    options.level = 4;
    fixture_start(&ips, FIXTURE_IPS, &options);
    return 0;
}

#define SIDE 8         /* pixels a row and a column */
#define SIZE_M 0.0008f /* pixels of a tenth of a millimetre */

/* One display about the origin that faces +z, of SIDE x SIDE pixels; no content: white. */
typedef struct Shown {
    Arena     arena;
    Scene    *scene;
    Display  *display;
    Subpixels subpixels;
    uint8_t   picture[SIDE * SIDE * 4];
} Shown;

static void show(Shown *shown, SubpixelLayout layout, float fill, bool has_content)
{
    *shown = (Shown){.arena = arena_reserve((size_t)1 << 30)};
    shown->subpixels = (Subpixels){layout, fill, {SIDE, SIDE}};
    Scene   *scene = shown->scene = builder_scene(&shown->arena);
    Material material = builder_material(0);
    material.display_id = 0;
    material.is_emitter = true;
    int id = builder_part(scene, material);
    builder_quad(scene, vec3(0, 0, 0), vec3(SIZE_M / 2, 0, 0), vec3(0, SIZE_M / 2, 0));
    shown->display = &scene->displays[scene->display_count++];
    *shown->display = (Display){.name = "display", .panel = ips.panel, .material_id = id,
                                .level = 0.5f, .content = builder_no_texture(),
                                .subpixels = &shown->subpixels};
    if (!has_content) return;
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int k = 0; k < 3; k++)
            shown->picture[4 * i + k] = (uint8_t)((i * 37 + k * 91 + i / SIDE * 53) % 256);
    scene->textures[0] = (Texture){{SIDE, SIDE, IMAGE_RGBA8, shown->picture}, WRAP_CLAMP,
                                   WRAP_CLAMP, true};
    shown->display->content.texture_id = 0;
}

static void shown_end(Shown *shown)
{
    arena_release(&shown->arena);
}

/* A frame's pixel that is so wide, about the view's direction. */
static void widen(CloseView *view, float width)
{
    Frame frame = frame_from_z(view->local);
    view->across[0] = vec3_scale(frame.x, width);
    view->across[1] = vec3_scale(frame.y, width);
}

/* At (x, y), in pixels from the upper left. */
static CloseView view_at(const Shown *shown, TrianglePoint *point, double x, double y,
                         float width)
{
    float s = (float)(x / SIDE), t = (float)(y / SIDE); /* v grows downwards */
    *point = triangle_point(shown->scene, 0, 0, 0);
    point->uv[0] = (Vec2){s, t};
    point->position = vec3((s - 0.5f) * SIZE_M, (0.5f - t) * SIZE_M, 0);
    CloseView view = {.scene = shown->scene, .display = shown->display, .point = point,
                      .local = direction_deg(20, 30)};
    widen(&view, width);
    return view;
}

/* Of points between which no edge of an open area passes exactly through one. */
static double area_mean(const Shown *shown, const int box[4], float width, double xyz[3])
{
    enum { STEPS = 300 }; /* a pixel; a multiple of three */
    double brightest = 0, count = (double)(box[2] - box[0]) * (box[3] - box[1]) * STEPS * STEPS;
    for (int k = 0; k < 3; k++) xyz[k] = 0;
    for (int j = box[1] * STEPS; j < box[3] * STEPS; j++)
        for (int i = box[0] * STEPS; i < box[2] * STEPS; i++) {
            TrianglePoint point;
            float         one[3];
            CloseView view =
                view_at(shown, &point, (i + 0.5) / STEPS, (j + 0.25) / STEPS, width);
            subpixels_xyz(&view, one);
            for (int k = 0; k < 3; k++) xyz[k] += (double)one[k] / count;
            brightest = fmax(brightest, (double)one[1]);
        }
    return brightest;
}

/* What the pixels of a box send by the panel alone. */
static void panel_mean(const Shown *shown, const int box[4], double xyz[3])
{
    for (int k = 0; k < 3; k++) xyz[k] = 0;
    for (int y = box[1]; y < box[3]; y++)
        for (int x = box[0]; x < box[2]; x++) {
            TrianglePoint point;
            float         codes[3], one[3];
            CloseView view = view_at(shown, &point, x + 0.5, y + 0.5, 0);
            display_codes(shown->scene, shown->display, &point, codes);
            display_panel_xyz(shown->display, &point, view.local, codes, one);
            for (int k = 0; k < 3; k++)
                xyz[k] += (double)one[k] * 0.5 / ((box[2] - box[0]) * (box[3] - box[1]));
        }
}

/* Pentile with content: up to a fill of a quarter no diamond reaches over its pixel. */
TEST(the_mean_over_a_pixel_is_what_the_panel_sends)
{
    static const struct {
        SubpixelLayout layout;
        float          fill;
        bool           has_content;
        int            box[4];
        double         most;
    } rows[] = {{SUBPIXELS_STRIPE, 1, false, {2, 3, 3, 4}, 1e-5},
                {SUBPIXELS_STRIPE, 1, true, {2, 3, 3, 4}, 1e-5},
                {SUBPIXELS_STRIPE, 0.64f, true, {5, 1, 6, 2}, 1e-5},
                {SUBPIXELS_STRIPE, 0.16f, true, {0, 7, 1, 8}, 1e-5},
                {SUBPIXELS_STRIPE, 0.16f, true, {0, 0, 8, 1}, 1e-5},
                {SUBPIXELS_PENTILE, 1, false, {2, 2, 4, 4}, 1e-4},
                {SUBPIXELS_PENTILE, 0.364010f, false, {2, 2, 4, 4}, 1e-4},
                {SUBPIXELS_PENTILE, 0.196544f, true, {2, 5, 4, 6}, 1e-4}};
    for (int i = 0; i < COUNT_OF(rows); i++) {
        ENDS_BY(shown_end) Shown shown;
        double found[3], wanted[3];
        show(&shown, rows[i].layout, rows[i].fill, rows[i].has_content);
        double brightest = area_mean(&shown, rows[i].box, 1e-9f, found);
        panel_mean(&shown, rows[i].box, wanted);
        print_message("row %d: off by %.2g %.2g %.2g\n", i, found[0] / wanted[0] - 1,
                      found[1] / wanted[1] - 1, found[2] / wanted[2] - 1);
        for (int k = 0; k < 3; k++) assert_close(found[k], wanted[k], rows[i].most);
        assert_true(brightest > 1.3 * wanted[1]);
    }
}

/* From a point of pixel (3, 2): what the panel sends for one primary, less black. */
static void assert_opening(const Shown *shown, double x, double y, int primary, double gain)
{
    TrianglePoint point;
    float         codes[3] = {0}, black[3], lit[3], found[3];
    CloseView     view = view_at(shown, &point, 3 + x, 2 + y, 1e-9f);
    display_panel_xyz(shown->display, &point, view.local, codes, black);
    if (primary >= 0) codes[primary] = 255;
    display_panel_xyz(shown->display, &point, view.local, codes, lit);
    subpixels_xyz(&view, found);
    for (int k = 0; k < 3; k++) {
        double wanted = 0.5 * ((double)black[k] + gain * (double)(lit[k] - black[k]));
        assert_close(found[k], wanted, 1e-5);
    }
}

TEST(stripes_stand_from_red_at_the_left_to_blue_at_the_right)
{
    ENDS_BY(shown_end) Shown shown;
    show(&shown, SUBPIXELS_STRIPE, 0.25f, false);
    for (int p = 0; p < 3; p++) {
        assert_opening(&shown, (p + 0.5) / 3, 0.5, p, 12);
        assert_opening(&shown, (p + 0.26) / 3, 0.26, p, 12);
        assert_opening(&shown, (p + 0.24) / 3, 0.5, -1, 0);
        assert_opening(&shown, (p + 0.5) / 3, 0.76, -1, 0);
    }
}

TEST(diamonds_have_green_in_every_pixel_and_red_and_blue_in_turn)
{
    ENDS_BY(shown_end) Shown shown;
    show(&shown, SUBPIXELS_PENTILE, 0.25f, false);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) { /* pixel (3, 2) is odd: blue */
            bool is_red = (x + y) & 1;
            assert_opening(&shown, x + 0.25, y + 0.25, 1, 8);
            assert_opening(&shown, x + 0.75, y + 0.75, is_red ? 0 : 2, 16);
            assert_opening(&shown, x + 0.75 + 0.11, y + 0.75 - 0.12, is_red ? 0 : 2, 16);
            assert_opening(&shown, x + 0.75 + 0.13, y + 0.75 - 0.14, -1, 0);
        }
}

/* In units of a display pixel; the view is slanted by 20 degrees. */
TEST(from_far_the_light_is_even_to_the_bit)
{
    const float pixel = SIZE_M / SIDE;
    for (int layout = SUBPIXELS_STRIPE; layout <= SUBPIXELS_PENTILE; layout++) {
        ENDS_BY(shown_end) Shown shown;
        show(&shown, (SubpixelLayout)layout, 0.5f, true);
        for (int i = 0; i < 400; i++) {
            TrianglePoint point;
            Wavelengths   w;
            float         even[3], found[3];
            CloseView view = view_at(&shown, &point, 0.02 * i, 7.9 - 0.0177 * i, 0.5f * pixel);
            Vec3      direction = view.local; /* its frame is the world's */
            display_emission_xyz(shown.scene, shown.display, 0, &point, direction, even);
            subpixels_xyz(&view, found);
            assert_memory_equal(found, even, sizeof even);
            widen(&view, i % 2 ? 0 : NAN); /* of no frame; not known */
            subpixels_xyz(&view, found);
            assert_memory_equal(found, even, sizeof even);
            wavelengths_sample((float)i / 400, &w);
            Spectrum all = triangle_emission(shown.scene, 0, &point, direction, &w);
            Spectrum sent = subpixels_spectrum(&view, &w);
            assert_memory_equal(&sent, &all, sizeof all);
        }
    }
}

/* The footprint that counts is the wider one: at 20 degrees towards 30 the cone is stretched by
 * sqrt(1 + (tan 20 cos 30)^2) along the rows. */
TEST(the_layout_fades_as_a_pixel_of_the_frame_widens)
{
    ENDS_BY(shown_end) Shown shown;
    const double stretch = sqrt(1 + pow(tan(0.34906585) * cos(0.52359878), 2));
    show(&shown, SUBPIXELS_STRIPE, 0.25f, false);
    for (int i = 0; i <= 20; i++) {
        TrianglePoint point;
        SubpixelMix   mix;
        double    covered = 0.2 + 0.02 * i, even = fmin(fmax((covered - 0.25) / 0.25, 0), 1);
        CloseView view = view_at(&shown, &point, 3.5, 2.5,
                                 (float)(covered / stretch * (double)SIZE_M / SIDE));
        float sum = 0, found = 0;
        subpixels_seen(&view, &mix);
        for (int k = 0; k < mix.count; k++) {
            sum += mix.weight[k];
            if (mix.codes[k][0] > 0) found += mix.weight[k]; /* red is lit: the even share */
        }
        assert_near(sum, 1, 1e-5);
        assert_near(found, even, 1e-4);
    }
}

TEST(spectra_carry_the_same_light)
{
    ENDS_BY(shown_end) Shown shown;
    show(&shown, SUBPIXELS_PENTILE, 0.7f, true);
    for (int i = 0; i < 60; i++) {
        enum { COUNT = 200 };
        TrianglePoint point;
        float         xyz[3], sum[3] = {0};
        CloseView view = view_at(&shown, &point, 1 + 0.1 * i, 7 - 0.07 * i,
                                 (i % 3) * 0.15f * SIZE_M / SIDE + 1e-9f);
        subpixels_xyz(&view, xyz);
        for (int k = 0; k < COUNT; k++) {
            Wavelengths w;
            wavelengths_sample(((float)k + 0.5f) / COUNT, &w);
            spectrum_add_xyz(&w, subpixels_spectrum(&view, &w), sum);
        }
        for (int j = 0; j < 3; j++)
            assert_near(sum[j] / COUNT, xyz[j], 0.01 * (double)(xyz[0] + xyz[1] + xyz[2]));
    }
}

/* ---- frames ------------------------------------------------------------------------------ */

enum { FRAME = 48, SAMPLES = 36 };

typedef struct Pixels {
    double xyz[FRAME * FRAME][3];
} Pixels;

static double difference(const float a[3], const float b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += fabs((double)a[k] - (double)b[k]);
    return sum;
}

/* ANYWHERE: as if no frame's pixel were too wide for it. */
typedef enum Layout { WITHOUT_LAYOUT, WITH_LAYOUT, LAYOUT_ANYWHERE } Layout;

/* Where the camera stands, and where to it looks. */
typedef struct Stand {
    Vec3   eye, target;
    double way;     /* m to the display */
    int    bounces; /* mirrors on the way */
} Stand;

/* What a camera sees that has SIDE-th parts of the display, so many, from edge to edge where it
 * looks upright; emission only. By a mirror the samples are the mirror image's. */
static void take_frame_at(Shown *shown, const Stand *stand, double parts, Layout layout,
                          Pixels *out)
{
    Bvh     *bvh;
    Lights  *lights;
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 30);
    SceneCamera at = camera_look_at(stand->eye, stand->target,
                                    (float)(2 * atan(parts * SIZE_M / SIDE / 2 / stand->way)));
    Camera   camera = camera_from_scene(&at, FRAME, FRAME);
    shown->display->subpixels = layout == WITHOUT_LAYOUT ? NULL : &shown->subpixels;
    assert_done(bvh_create(shown->scene, 1, NULL, &bvh, &err) && lights_build(shown->scene,
                                                                               &arena, &lights,
                                                                               &err));
    PathContext context =
        path_context_build(shown->scene, bvh, lights, stand->bounces, &arena);
    context.cone = camera_cone(&camera);
    if (layout == LAYOUT_ANYWHERE) context.cone.spread *= 1e-3f;
    memset(out, 0, sizeof *out);
    for (int i = 0; i < FRAME * FRAME * SAMPLES; i++) {
        int            pixel = i / SAMPLES;
        PathStatistics statistics = {0};
        Wavelengths    w;
        SeenLight      seen;
        PathResult     result;
        float          emitted[3];
        int     column = stand->bounces ? FRAME - 1 - pixel % FRAME : pixel % FRAME;
        Sampler sampler = sampler_start(3, column, pixel / FRAME, (uint32_t)(i % SAMPLES));
        Vec2    in = sampler_2d(&sampler);
        if (stand->bounces) in.x = 1 - in.x;
        wavelengths_sample(sampler_1d(&sampler), &w);
        Ray ray = camera_ray(&camera, (float)(pixel % FRAME) + in.x,
                             (float)(pixel / FRAME) + in.y);
        PathStart start = {.context = &context, .wavelengths = &w, .sampler = &sampler,
                           .statistics = &statistics};
        path_seen(&start, ray, &(SeenRequest){.listener = NULL}, &seen);
        result = seen.path;
        assert_true(result.hit);
        if (!stand->bounces) {
            assert_true(path_display_emission(&context, &result, &w, emitted));
            assert_true(difference(emitted, result.xyz) <= 1e-4 * (double)result.xyz[1]);
        }
        for (int k = 0; k < 3; k++) out->xyz[pixel][k] += (double)result.xyz[k] / SAMPLES;
    }
    bvh_destroy(bvh);
}

static void take_frame(Shown *shown, double parts, Layout layout, Pixels *out)
{
    take_frame_at(shown, &(Stand){vec3(0, 0, 0.03f), vec3(0, 0, 0), 0.03, 0}, parts, layout,
                  out);
}

/* The middle of a frame's pixel that lies in the middle of a stripe. */
TEST(a_frame_from_close_shows_red_green_and_blue_from_left_to_right)
{
    static Pixels close, plain;
    static const int column[3] = {2, 7, 13}; /* of 16 a display pixel */
    ENDS_BY(shown_end) Shown shown;
    double sum[2] = {0};
    show(&shown, SUBPIXELS_STRIPE, 0.8f, false);
    take_frame(&shown, 2, WITH_LAYOUT, &close); /* the middle is a corner of four pixels */
    take_frame(&shown, 2, WITHOUT_LAYOUT, &plain);
    for (int i = 0; i < FRAME * FRAME; i++) {
        sum[0] += close.xyz[i][1];
        sum[1] += plain.xyz[i][1];
    }
    assert_close(sum[0], sum[1], 5e-3);
    for (int x = 0; x < 2; x++)
        for (int p = 0; p < 3; p++) {
            const double *at =
                close.xyz[(FRAME / 4) * FRAME + x * FRAME / 2 + column[p] * FRAME / 2 / 16];
            double all = at[0] + at[1] + at[2];
            assert_true(p == 0 ? at[0] / all > 0.55
                               : p == 1 ? at[1] / all > 0.55 : at[2] / all > 0.55);
        }
}

/* How much the light of red differs over the frame, when what repeats within about seven pixels
 * is smoothed away (by a raised cosine): of the mean, root mean square. Light that is not even
 * by itself is reported by a plain frame; NULL: it is. */
static double unrest(const Pixels *frame, const Pixels *plain)
{
    enum { WINDOW = 16 };
    double sum = 0, squares = 0;
    int    count = 0;
    for (int y = 0; y + WINDOW <= FRAME; y += 2)
        for (int x = 0; x + WINDOW <= FRAME; x += 2, count++) {
            double mean = 0;
            for (int i = 0; i < WINDOW * WINDOW; i++) {
                int    at = (y + i / WINDOW) * FRAME + x + i % WINDOW;
                double across = 1 - cos(2 * PI * (i % WINDOW + 0.5) / WINDOW);
                double down = 1 - cos(2 * PI * (i / WINDOW + 0.5) / WINDOW);
                mean += across * down * frame->xyz[at][0] / (plain ? plain->xyz[at][0] : 1);
            }
            sum += mean;
            squares += mean * mean;
        }
    return sqrt(fmax(squares * count / (sum * sum) - 1, 0));
}

/* A white display of 64 x 64 pixels, at sizes that have no simple ratio to the frame's pixels.
 * That the measure sees moire: without the fade it is there. */
TEST(frames_of_no_distance_show_moire)
{
    static Pixels frame, plain;
    static const double covered[] = {0.27, 0.351, 0.394, 0.453, 0.49, 0.62, 0.953, 1.26};
    for (int layout = SUBPIXELS_STRIPE; layout <= SUBPIXELS_PENTILE; layout++) {
        ENDS_BY(shown_end) Shown shown;
        show(&shown, (SubpixelLayout)layout, 0.6f, false);
        shown.subpixels.pixels[0] = shown.subpixels.pixels[1] = 64;
        for (int i = 0; i < COUNT_OF(covered); i++) {
            double parts = covered[i] * FRAME * SIDE / 64;
            take_frame(&shown, parts, WITH_LAYOUT, &frame);
            double found = unrest(&frame, NULL);
            print_message("layout %d, %.3f pixels in one of the frame: %.2g\n", layout,
                          covered[i], found);
            assert_true(found < 0.01);
            if (covered[i] < 0.5) continue;
            take_frame(&shown, parts, WITHOUT_LAYOUT, &plain);
            assert_memory_equal(&frame, &plain, sizeof frame);
        }
        take_frame(&shown, 0.93 * FRAME * SIDE / 64, LAYOUT_ANYWHERE, &frame);
        print_message("layout %d without the fade: %.2g\n", layout, unrest(&frame, NULL));
        assert_true(unrest(&frame, NULL) > 0.015);
    }
}

/* ---- in mirrors -------------------------------------------------------------------------- */

#define MIRROR_X 0.02f
#define MIRROR_Z (0.03f - 0.03f * 15 / 35) /* where the camera below looks at it */

/* A perfect mirror beside the display, that faces -x; as a ball of this radius mirrors (above
 * 0: convex; INFINITY: flat). */
static void add_mirror(Shown *shown, double radius)
{
    Scene   *scene = shown->scene;
    builder_part(scene, builder_mirror(1));
    uint32_t first = scene->vertex_count;
    builder_quad(scene, vec3(MIRROR_X, 0, MIRROR_Z), vec3(0, 0, 0.01f), vec3(0, 0.01f, 0));
    for (uint32_t i = first; i < scene->vertex_count; i++) {
        Vec3 p = vec3(0, scene->positions[i].y, scene->positions[i].z - MIRROR_Z);
        scene->parts[0].normals[i] =
            vec3_normalize(vec3_along(vec3(-1, 0, 0), p, (float)(1 / radius)));
    }
}

/* Towards the display's image, and the same without the mirror. */
static const Stand by_mirror = {{0.005f, 0, 0.03f}, {2 * MIRROR_X, 0, 0}, 0.0461, 1};
static const Stand unfolded = {{2 * MIRROR_X - 0.005f, 0, 0.03f}, {0, 0, 0}, 0.0461, 0};

/* In a flat mirror all is as from the camera's image, right and left changed. */
TEST(a_mirror_shows_what_its_image_of_the_camera_sees)
{
    static Pixels mirrored, direct;
    static const double parts[] = {2, 4, 0.2 * FRAME};
    for (int i = 0; i < COUNT_OF(parts); i++) {
        ENDS_BY(shown_end) Shown shown;
        double sum[2] = {0}, most = 0, off = 0;
        show(&shown, i % 2 ? SUBPIXELS_PENTILE : SUBPIXELS_STRIPE, 0.6f, false);
        if (i == 2) shown.subpixels.pixels[0] = shown.subpixels.pixels[1] = 64;
        double seen = i == 2 ? parts[i] * SIDE / 64 : parts[i];
        take_frame_at(&shown, &unfolded, seen, WITH_LAYOUT, &direct);
        add_mirror(&shown, INFINITY);
        take_frame_at(&shown, &by_mirror, seen, WITH_LAYOUT, &mirrored);
        for (int k = 0; k < FRAME * FRAME; k++) {
            double a = mirrored.xyz[k / FRAME * FRAME + FRAME - 1 - k % FRAME][0];
            double b = direct.xyz[k][0];
            sum[0] += a;
            sum[1] += b;
            most = fmax(most, b);
            off += fabs(a - b);
        }
        print_message("%.3g display pixels: off by %.2g, the mean by %.2g\n", parts[i],
                      off / sum[1], sum[0] / sum[1] - 1);
        assert_close(sum[0], sum[1], 1e-3);
        assert_true(off < 0.005 * sum[1]); /* edges within the rounding of a ray's way */
        assert_true(most > 1.1 * sum[1] / FRAME / FRAME);
    }
}

/* The image of a display in a ball shrinks: of frames that show it the smaller the more of its
 * pixels lie in one of the frame's. */
TEST(mirrors_that_shrink_a_display_show_no_moire_either)
{
    static Pixels frame, plain;
    static const double covered[] = {0.113, 0.121, 0.131, 0.141, 0.151, 0.2, 0.3};
    const double radius = 0.03; /* three times as many columns in a pixel as upright and flat */
    for (int layout = SUBPIXELS_STRIPE; layout <= SUBPIXELS_PENTILE; layout++) {
        ENDS_BY(shown_end) Shown shown;
        int   alike = 0, others = 0;
        show(&shown, (SubpixelLayout)layout, 0.6f, false);
        shown.subpixels.pixels[0] = shown.subpixels.pixels[1] = 64;
        add_mirror(&shown, radius);
        for (int i = 0; i < COUNT_OF(covered); i++) {
            double parts = covered[i] * FRAME * SIDE / 64;
            take_frame_at(&shown, &by_mirror, parts, WITH_LAYOUT, &frame);
            take_frame_at(&shown, &by_mirror, parts, WITHOUT_LAYOUT, &plain);
            double found = unrest(&frame, &plain);
            bool   is_plain = memcmp(&frame, &plain, sizeof frame) == 0;
            print_message("layout %d, %.3f: %.2g%s\n", layout, covered[i], found,
                          is_plain ? ", as without" : "");
            assert_true(found < 0.01);
            alike += is_plain;
            others += !is_plain;
        }
        assert_true(alike && others);
        take_frame_at(&shown, &by_mirror, 0.3 * FRAME * SIDE / 64, LAYOUT_ANYWHERE, &frame);
        print_message("layout %d without the fade: %.2g\n", layout, unrest(&frame, &plain));
        assert_true(unrest(&frame, &plain) > 0.01);
    }
}

TEST_PROGRAM(start_ips, fixture_group_end)

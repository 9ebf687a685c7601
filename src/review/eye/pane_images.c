/* SPDX-License-Identifier: Apache-2.0 */
#include "review/eye/pane_images.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "mirror/mirrors.h"
#include "scene/point/ray_ends.h"

#define CELLS 512         /* of a display, or one a triangle if it has more */
#define SIDE_MOST 16      /* cells along a triangle's side */
#define DEPTH_MOST 4      /* halvings of the sides of a cell that is shown in part */
#define CELLS_MOST 131072 /* of a display, by those */
#define LATTICE ((PANE_RASTER + 1) * (PANE_RASTER + 1)) /* a triangle's has half as many */
#define HIDES_BELOW 0.01f                               /* of the light that passes */

/* ---- what hides -------------------------------------------------------------------------- */

typedef struct PaneLook {
    const PathContext *context;
    const Wavelengths *wavelengths;
    Vec3 direction;
    Spectrum passed;
} PaneLook;

static bool passes(void *user, const Hit *hit) {
    PaneLook *look = user;
    const PathContext *context = look->context;
    look->passed *=
        surface_pass(context->scene, context->tables, hit, look->direction, look->wavelengths);
    float all = spectrum_sum(look->wavelengths->xyz[1]);
    return spectrum_sum(look->passed * look->wavelengths->xyz[1]) >= HIDES_BELOW * all;
}

/* The first part that hides what lies at the ray's end; NO_ID: nothing does. */
static int hiding_part(const PathContext *context, const Wavelengths *wavelengths, Ray ray) {
    const Scene *scene = context->scene;
    PaneLook look = {context, wavelengths, ray.direction, spectrum_all(1)};
    int part = NO_ID;
    Hit hit;
    if (!bvh_occluded(context->bvh, ray, passes, &look)) return NO_ID;
    look.passed = spectrum_all(1);
    while (bvh_intersect(context->bvh, ray, 0, &hit)) {
        part = (int)scene->triangles[hit.triangle].part_id;
        if (hit.triangle < scene->opaque_count || !passes(&look, &hit)) break;
        ray = ray_behind(scene, ray, &hit);
    }
    return part;
}

/* ---- a point of a display, in a pane ----------------------------------------------------- */

typedef struct PaneSearch {
    const PathContext *context;
    const Wavelengths *wavelengths;
    Vec3 eye;
    const int *panes, *displays; /* parts */
    int display_count;
    PaneImage *images; /* [pane][display] */
    double *covered;   /* [pane][display][part] */
} PaneSearch;

typedef enum PaneState { PANE_ENDS, PANE_AWAY, PANE_COVERED, PANE_SHOWS } PaneState;

/* Where the pane turns the eye's ray. */
typedef struct PanePoint {
    PaneState state;   /* PANE_ENDS: nowhere */
    int covered_by;    /* scene part */
    float s, t;        /* of the display's triangle: barycentric weights of corners 1, 2 */
    uint32_t triangle; /* of the pane */
    float u, v;
    Vec3 towards;   /* unit, from the eye */
    Vec3 place;     /* that it is turned to */
    Vec3 seen_from; /* as PaneCell has it */
} PanePoint;

/* Of a solid the far face shows what its near one lets in. */
static bool faces_eye(const MirrorTriangle *m, Vec3 eye) {
    Vec3 flat = vec3_cross(vec3_sub(m->position[1], m->position[0]),
                           vec3_sub(m->position[2], m->position[0]));
    return vec3_dot(flat, vec3_sub(eye, m->position[0])) > 0;
}

static bool point_in(const PaneSearch *search, const Part *part, uint32_t triangle, Vec3 source,
                     PanePoint *out) {
    const Scene *scene = search->context->scene;
    MirrorTriangle mirror = mirror_triangle(scene, triangle);
    ReflectionPoint at[REFLECTION_POINTS_MAX];
    const ReflectionLight light = {source, true};
    if (scene->materials[part->material_id].is_solid && !faces_eye(&mirror, search->eye))
        return false;
    if (!reflection_points_find(&mirror, search->eye, &light, at)) return false;
    Vec3 place = triangle_point(scene, triangle, at[0].u, at[0].v).position;
    Vec3 towards = vec3_normalize(vec3_sub(place, search->eye));
    *out = (PanePoint){.state = PANE_SHOWS,
                       .covered_by = NO_ID,
                       .triangle = triangle,
                       .u = at[0].u,
                       .v = at[0].v,
                       .towards = towards,
                       .place = source};
    return true;
}

/* hint: the triangle that is tried first. */
static PanePoint point_of(const PaneSearch *search, const Part *part, Vec3 source, uint32_t *hint) {
    PanePoint found = {.state = PANE_ENDS};
    if (point_in(search, part, *hint, source, &found)) return found;
    for (uint32_t i = 0; i < part->triangle_count && found.state == PANE_ENDS; i++)
        if (point_in(search, part, part->first_triangle + i, source, &found))
            *hint = found.triangle;
    return found;
}

/* ---- a display's cells ------------------------------------------------------------------- */

/* A triangle of a display: its corners in the pane, and where its cells are to go. */
typedef struct PaneLattice {
    const PaneSearch *search;
    const Part *pane;
    uint32_t triangle;
    int side;        /* cells along its sides */
    int halvings;    /* of one that is shown in part, at most */
    double area;     /* of a cell, as a share of the display's */
    double *covered; /* [part] */
    uint32_t hint;
    int met; /* cells so far */
    PanePoint at[LATTICE];
} PaneLattice;

static int lattice_index(int side, int i, int j) {
    return j * (side + 1) - j * (j - 1) / 2 + i;
}

/* The first part that hides the display's point in the pane's; NO_ID: nothing does. */
static int hiding_way(const PaneSearch *search, const TrianglePoint *pane,
                      const TrianglePoint *display, Vec3 way) {
    int by = hiding_part(search->context, search->wavelengths,
                         ray_to(search->eye, pane, vec3_sub(search->eye, pane->position)));
    if (by != NO_ID) return by;
    return hiding_part(search->context, search->wavelengths,
                       ray_to(ray_start(pane, way), display, vec3_neg(way)));
}

static PanePoint look_at(PaneLattice *lattice, const TrianglePoint *display) {
    const PaneSearch *search = lattice->search;
    const Scene *scene = search->context->scene;
    PanePoint at = point_of(search, lattice->pane, display->position, &lattice->hint);
    if (at.state == PANE_ENDS) return at;
    TrianglePoint pane = triangle_point(scene, at.triangle, at.u, at.v);
    Vec3 way = vec3_sub(display->position, pane.position);
    at.seen_from = vec3_along(pane.position, vec3_normalize(vec3_neg(way)),
                              vec3_length(vec3_sub(search->eye, pane.position)));
    if (!(vec3_dot(way, display->ng) < 0)) {
        at.state = PANE_AWAY;
        return at;
    }
    at.covered_by = hiding_way(search, &pane, display, way);
    if (at.covered_by != NO_ID) at.state = PANE_COVERED;
    return at;
}

static PanePoint look_at_triangle(PaneLattice *lattice, float s, float t) {
    TrianglePoint display =
        triangle_point(lattice->search->context->scene, lattice->triangle, s, t);
    PanePoint at = look_at(lattice, &display);
    at.s = s;
    at.t = t;
    return at;
}

static void fill_lattice(PaneLattice *lattice) {
    int side = lattice->side;
    for (int j = 0; j <= side; j++)
        for (int i = 0; i + j <= side; i++)
            lattice->at[lattice_index(side, i, j)] =
                look_at_triangle(lattice, (float)i / (float)side, (float)j / (float)side);
}

/* By Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125-126. */
static double solid_angle(const Vec3 p[3]) {
    double volume = (double)vec3_dot(p[0], vec3_cross(p[1], p[2]));
    double below = 1 + (double)(vec3_dot(p[0], p[1]) + vec3_dot(p[1], p[2]) + vec3_dot(p[2], p[0]));
    return 2 * atan2(fabs(volume), below);
}

/* Of a cell's corners one may lie beyond the pane's end: there where the others and the middle
 * have it, of a small cell. False: it is too much of the cell. */
static bool set_corners(const PanePoint corner[3], const PanePoint *middle, PaneCell *cell) {
    int missing = NO_ID;
    for (int k = 0; k < 3; k++) {
        cell->corner[k] = corner[k].towards;
        cell->place[k] = corner[k].place;
        if (corner[k].state != PANE_ENDS) continue;
        if (missing != NO_ID) return false;
        missing = k;
    }
    if (missing == NO_ID) return true;
    int a = (missing + 1) % 3, b = (missing + 2) % 3;
    Vec3 towards = vec3_sub(vec3_scale(middle->towards, 3), cell->corner[a]);
    Vec3 place = vec3_sub(vec3_scale(middle->place, 3), cell->place[a]);
    cell->corner[missing] = vec3_normalize(vec3_sub(towards, cell->corner[b]));
    cell->place[missing] = vec3_sub(place, cell->place[b]);
    return true;
}

/* area: of the cell, as a share of the display's. */
static void add_whole(PaneLattice *lattice, const PanePoint corner[3], const PanePoint *middle,
                      double area, PaneImage *out) {
    PaneCell cell = {.id = lattice->met++, .seen_from = middle->seen_from};
    PaneState state = middle->state;
    if (state == PANE_SHOWS && !set_corners(corner, middle, &cell)) state = PANE_ENDS;
    switch (state) {
    case PANE_ENDS: out->share.ends += area; break;
    case PANE_AWAY: out->share.away += area; break;
    case PANE_COVERED:
        out->share.covered += area;
        lattice->covered[middle->covered_by] += area;
        break;
    case PANE_SHOWS:
        out->share.shown += area;
        cell.sr = solid_angle(cell.corner);
        out->cells[out->cell_count++] = cell;
        break;
    }
}

/* halvings: how many are left to a cell that is not the same everywhere. */
static void add_cell(PaneLattice *lattice, const PanePoint corner[3], int halvings, double area,
                     PaneImage *out) {
    const PanePoint *a = &corner[0], *b = &corner[1], *c = &corner[2];
    PanePoint m = look_at_triangle(lattice, (a->s + b->s + c->s) / 3, (a->t + b->t + c->t) / 3);
    bool is_one = a->state == m.state && b->state == m.state && c->state == m.state;
    if (is_one || halvings == 0) {
        add_whole(lattice, corner, &m, area, out);
        return;
    }
    PanePoint ab = look_at_triangle(lattice, (a->s + b->s) / 2, (a->t + b->t) / 2);
    PanePoint bc = look_at_triangle(lattice, (b->s + c->s) / 2, (b->t + c->t) / 2);
    PanePoint ca = look_at_triangle(lattice, (c->s + a->s) / 2, (c->t + a->t) / 2);
    add_cell(lattice, (PanePoint[]){*a, ab, ca}, halvings - 1, area / 4, out);
    add_cell(lattice, (PanePoint[]){ab, *b, bc}, halvings - 1, area / 4, out);
    add_cell(lattice, (PanePoint[]){ca, bc, *c}, halvings - 1, area / 4, out);
    add_cell(lattice, (PanePoint[]){ab, bc, ca}, halvings - 1, area / 4, out);
}

static void add_triangle(PaneLattice *lattice, PaneImage *out) {
    int side = lattice->side;
    PanePoint *at = lattice->at;
    fill_lattice(lattice);
    for (int j = 0; j < side; j++)
        for (int i = 0; i + j < side; i++) {
            PanePoint a = at[lattice_index(side, i, j)];
            PanePoint b = at[lattice_index(side, i + 1, j)];
            PanePoint c = at[lattice_index(side, i, j + 1)];
            add_cell(lattice, (PanePoint[]){a, b, c}, lattice->halvings, lattice->area, out);
            if (i + j + 1 == side) continue;
            PanePoint d = at[lattice_index(side, i + 1, j + 1)];
            add_cell(lattice, (PanePoint[]){b, d, c}, lattice->halvings, lattice->area, out);
        }
}

/* ---- the outline ------------------------------------------------------------------------- */

static int by_place(const void *a, const void *b) {
    const Vec2 *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    return (p->y > q->y) - (p->y < q->y);
}

static double turn(Vec2 a, Vec2 b, Vec2 c) {
    return ((double)b.x - (double)a.x) * ((double)c.y - (double)a.y) -
           ((double)b.y - (double)a.y) * ((double)c.x - (double)a.x);
}

/* Andrew's monotone chain (Inf. Process. Lett. 9 (1979) 216-219): points in order of place
 * become their convex hull, anticlockwise. out: of twice as many. */
static int hull_of(const Vec2 *points, int count, Vec2 *out) {
    int n = 0;
    for (int pass = 0; pass < 2; pass++) {
        int least = n + 1;
        for (int i = 0; i < count; i++) {
            Vec2 p = points[pass ? count - 1 - i : i];
            while (n > least && turn(out[n - 2], out[n - 1], p) <= 0) n--;
            out[n++] = p;
        }
        n--; /* the next pass begins with it */
    }
    return n;
}

#define SLIGHT 1e-4 /* of the outline's area: what a corner may take of it and be left out */

/* Leaves out the corners that matter least. */
static int thin_out(Vec2 *hull, int count) {
    double all = 0;
    for (int i = 2; i < count; i++) all += turn(hull[0], hull[i - 1], hull[i]);
    while (count > 3) {
        int least = 0;
        double area = INFINITY;
        for (int i = 0; i < count; i++) {
            double a = turn(hull[(i + count - 1) % count], hull[i], hull[(i + 1) % count]);
            if (a < area) least = i;
            area = fmin(area, a);
        }
        if (count <= PANE_OUTLINE && area > SLIGHT * all) break;
        memmove(&hull[least], &hull[least + 1], sizeof *hull * (size_t)(count - 1 - least));
        count--;
    }
    return count;
}

/* In the plane across its middle. */
static void set_outline(PaneImage *image, Arena *arena) {
    Arena scratch = *arena;
    Frame frame = frame_from_z(image->towards);
    int count = 0, most = 3 * image->cell_count;
    Vec2 *points = ARENA_NEW(&scratch, Vec2, most), *hull = ARENA_NEW(&scratch, Vec2, 2 * most);
    for (int i = 0; i < most; i++) {
        Vec3 local = frame_to_local(&frame, image->cells[i / 3].corner[i % 3]);
        if (local.z > 0) points[count++] = (Vec2){local.x / local.z, local.y / local.z};
    }
    qsort(points, (size_t)count, sizeof *points, by_place);
    Vec2 kept[PANE_OUTLINE];
    count = thin_out(hull, hull_of(points, count, hull));
    memcpy(kept, hull, sizeof *hull * (size_t)count);
    image->outline = ARENA_NEW(arena, Vec3, count);
    image->outline_count = count;
    for (int i = 0; i < count; i++) {
        Vec3 local = vec3_normalize(vec3(kept[i].x, kept[i].y, 1));
        image->outline[i] = frame_to_world(&frame, local);
    }
}

/* ---- all of them ------------------------------------------------------------------------- */

static int side_of(const Part *part) {
    int each = CELLS / (int)part->triangle_count, side = 1;
    while (side < SIDE_MOST && (side + 1) * (side + 1) <= each) side++;
    return side;
}

static int halvings_of(const Part *part) {
    int halvings = 0, side = side_of(part);
    int cells = 4 * side * side * (int)part->triangle_count;
    for (; halvings < DEPTH_MOST && cells <= CELLS_MOST; cells *= 4) halvings++;
    return halvings;
}

static void set_middle(PaneImage *image) {
    Vec3 sum = vec3(0, 0, 0);
    for (int i = 0; i < image->cell_count; i++) {
        PaneCell *cell = &image->cells[i];
        Vec3 middle = vec3_add(vec3_add(cell->corner[0], cell->corner[1]), cell->corner[2]);
        cell->sr_before = image->sr;
        image->sr += cell->sr;
        sum = vec3_along(sum, middle, (float)cell->sr);
    }
    image->towards = vec3_normalize(sum);
}

static void set_covered_by(const Scene *scene, const double *covered, PaneImage *image) {
    for (int i = 0; i < scene->part_count; i++)
        if (covered[i] > (image->covered_by == NO_ID ? 0 : covered[image->covered_by]))
            image->covered_by = i;
}

static void find_one(void *user, int item, int worker) {
    (void)worker;
    const PaneSearch *search = user;
    const Scene *scene = search->context->scene;
    PaneImage *image = &search->images[item];
    const Part *part = &scene->parts[image->part_id], *pane = &scene->parts[image->pane_id];
    double *covered = search->covered + (size_t)item * (size_t)scene->part_count;
    double area = 0;
    PaneLattice lattice = {.search = search,
                           .pane = pane,
                           .side = side_of(part),
                           .halvings = halvings_of(part),
                           .covered = covered,
                           .hint = pane->first_triangle};
    for (uint32_t t = 0; t < part->triangle_count; t++)
        area += scene_triangle_m2(scene, part->first_triangle + t);
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        lattice.triangle = part->first_triangle + t;
        lattice.area =
            scene_triangle_m2(scene, lattice.triangle) / area / (lattice.side * lattice.side);
        add_triangle(&lattice, image);
    }
    set_covered_by(scene, covered, image);
    set_middle(image);
}

/* Parts that let light through, or that are displays. */
static int list_parts(const Scene *scene, bool displays, int *out) {
    int count = 0;
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        const Material *m = &scene->materials[part->material_id];
        bool is_listed =
            displays ? m->display_id != NO_ID : m->transmission > 0 && m->display_id == NO_ID;
        if (is_listed && part->triangle_count) out[count++] = i;
    }
    return count;
}

PaneImage *pane_images_find(const Setup *setup, Vec3 eye, int *count, Arena *arena) {
    const Scene *scene = setup->scene;
    Wavelengths wavelengths;
    int *panes = ARENA_NEW(arena, int, scene->part_count);
    int *displays = ARENA_NEW(arena, int, scene->part_count);
    PaneSearch search = {.context = &setup->context,
                         .wavelengths = &wavelengths,
                         .eye = eye,
                         .panes = panes,
                         .displays = displays};
    int pane_count = list_parts(scene, false, panes);
    search.display_count = list_parts(scene, true, displays);
    *count = pane_count * search.display_count;
    search.images = ARENA_NEW(arena, PaneImage, *count);
    wavelengths_sample(0.5f, &wavelengths);
    for (int i = 0; i < *count; i++) {
        int part_id = displays[i % search.display_count];
        const Part *part = &scene->parts[part_id];
        int side = side_of(part) << halvings_of(part);
        int cells = side * side * (int)part->triangle_count;
        search.images[i] = (PaneImage){.pane_id = panes[i / search.display_count],
                                       .part_id = part_id,
                                       .covered_by = NO_ID,
                                       .cells = ARENA_NEW(arena, PaneCell, cells)};
    }
    Arena scratch = *arena;
    search.covered = ARENA_NEW(&scratch, double, *count * scene->part_count);
    parallel_for(setup->tools.threads, *count, find_one, &search);
    for (int i = 0; i < *count; i++)
        if (search.images[i].cell_count) set_outline(&search.images[i], arena);
    return search.images;
}

/* ---- part of a display ------------------------------------------------------------------- */

int pane_images_panes(const Scene *scene, int *out) {
    return list_parts(scene, false, out);
}

static PanePoint look_at_place(PaneLattice *lattice, const TrianglePoint *at, bool is_there) {
    return is_there ? look_at(lattice, at) : (PanePoint){.state = PANE_ENDS};
}

static void add_raster(PaneLattice *lattice, const PaneRaster *raster, PaneImage *out) {
    const int wide = PANE_RASTER + 1;
    PanePoint *at = lattice->at;
    for (int i = 0; i < wide * wide; i++)
        at[i] = look_at_place(lattice, &raster->corner[i], raster->has_corner[i]);
    for (int i = 0; i < PANE_RASTER * PANE_RASTER; i++) {
        int a = i / PANE_RASTER * wide + i % PANE_RASTER, b = a + 1, c = a + wide, d = c + 1;
        const TrianglePoint *middle = &raster->middle[2 * i];
        const bool *is_there = &raster->has_middle[2 * i];
        PanePoint near = look_at_place(lattice, &middle[0], is_there[0]);
        PanePoint far = look_at_place(lattice, &middle[1], is_there[1]);
        add_whole(lattice, (PanePoint[]){at[a], at[b], at[c]}, &near, lattice->area, out);
        add_whole(lattice, (PanePoint[]){at[b], at[d], at[c]}, &far, lattice->area, out);
    }
}

PaneImage pane_image_of(const Setup *setup, Vec3 eye, int pane_id, const PaneRaster *raster,
                        Arena *arena) {
    const int cells = 2 * PANE_RASTER * PANE_RASTER;
    const Scene *scene = setup->scene;
    const Part *pane = &scene->parts[pane_id];
    Wavelengths wavelengths;
    PaneImage image = {.pane_id = pane_id,
                       .part_id = raster->part_id,
                       .covered_by = NO_ID,
                       .cells = ARENA_NEW(arena, PaneCell, cells)};
    Arena scratch = *arena;
    PaneSearch search = {.context = &setup->context, .wavelengths = &wavelengths, .eye = eye};
    PaneLattice *lattice = ARENA_NEW(&scratch, PaneLattice, 1);
    *lattice = (PaneLattice){.search = &search,
                             .pane = pane,
                             .area = 1.0 / cells,
                             .covered = ARENA_NEW(&scratch, double, scene->part_count),
                             .hint = pane->first_triangle};
    wavelengths_sample(0.5f, &wavelengths);
    add_raster(lattice, raster, &image);
    set_covered_by(scene, lattice->covered, &image);
    if (image.cell_count) set_middle(&image);
    return image;
}

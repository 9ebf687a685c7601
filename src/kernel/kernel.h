/* kernel.h -- the hot part of the program, built once for each instruction set.
 *
 * Everything between a tile and its film samples (KERNEL_SOURCES of the build) is compiled for
 * several instruction sets; one is chosen when a render starts, together with Embree's. All of
 * them compute the same bits, but Embree's do not: pin the name to compare machines.
 * No vector type crosses this seam by value.
 */
#pragma once
#include "camera/camera.h"
#include "film/film.h"
#include "path/path.h"

/* Work on a rectangle of pixels: the seam between the render loop and the kernel. */
typedef struct TileJob {
    const PathContext *context;
    const Camera      *camera;
    Film    *film;
    bool     with_features; /* fill the layers of the first surface, not only the colour */
    bool     with_fine;     /* and display.fine, which takes more camera rays */
    uint32_t seed;
    uint32_t first_sample, end_sample; /* half-open */
} TileJob;

typedef struct Kernel {
    const char *isa; /* "sse2", "avx2", "avx512"; "native" on other processors */
    /* rect: inside the film's crop, pixels of the whole frame. Adds to *statistics. */
    void (*render)(const TileJob *job, FilmRect rect, PathStatistics *statistics);
} Kernel;

/* isa: a name from above, or NULL for the best that this processor and program have. Fails,
 * naming what there is, on another name or on one that the processor lacks. */
bool kernel_choose(const char *isa, const Kernel **out, Error *err);

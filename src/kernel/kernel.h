/* SPDX-License-Identifier: Apache-2.0 */
/* kernel.h -- the hot part of the program, built once for each instruction set.
 *
 * Everything between a tile and its film samples (KERNEL_SOURCES of the build) is compiled for
 * several instruction sets; one is chosen when a render starts, together with Embree's. All of
 * them compute the same bits, but Embree's do not: choose one by name to compare machines.
 * No vector type crosses this interface by value.
 */
#pragma once
#include "camera/camera.h"
#include "film/film.h"
#include "film/sample_shares.h"
#include "guide/guide_training.h"
#include "kernel/aim.h"
#include "light/light_groups.h"
#include "path/cell_lights.h"
#include "path/collect/training.h"
#include "path/path.h"

/* Work on a rectangle of pixels: the interface between the render loop and the kernel. */
typedef struct TileJob {
    const PathContext *context;
    const Camera *camera;
    Film *film;
    bool with_features;        /* fill the layers of the first surface, not only the colour */
    bool with_fine;            /* and display.fine, which takes more camera rays; */
    bool with_lambertian;      /* display.lambertian */
    bool with_extrapolated;    /* display.extrapolated */
    const LightGroups *lights; /* the film's groups of lights; NULL: it keeps none apart */
    uint32_t seed;
    SampleShares shares;               /* of the film's crop */
    uint32_t first_sample, end_sample; /* half-open, of the frame */
} TileJob;

/* A search for the pixels that show a display. */
typedef struct DisplaySearch {
    const PathContext *context;
    const Camera *camera;
    int display;    /* its id; FILM_ANY_DISPLAY: any */
    FilmRect rect;  /* of the frame */
    uint8_t *shows; /* of each of its pixels, row by row: 1: it does */
} DisplaySearch;

/* The work by which a guide is trained. */
typedef struct TrainingJob {
    const PathContext *context; /* with the guide as trained so far */
    const Camera *camera;
    uint32_t seed, index; /* of the paths' random numbers */
    Vec2 stretch;         /* pixels of the frame to a step of the raster, across and down */
    PathPlaces *places;   /* one a step of the raster, row by row */
    int columns;          /* of the raster */
    const GuideTraining *training;
    LightFinds *finds; /* one a cell */
} TrainingJob;

typedef struct Kernel {
    const char *isa; /* "sse2", "avx2", "avx512"; "native" on other processors */
    /* rect: inside the film's crop, pixels of the whole frame. Adds to *statistics. */
    void (*render)(const TileJob *job, FilmRect rect, PathStatistics *statistics);
    /* Sets what a part of the search's rectangle shows. */
    void (*find_displays)(const DisplaySearch *search, FilmRect part);
    /* One path through every step of a rectangle of the raster: the places it comes by. */
    void (*find_places)(const TrainingJob *job, FilmRect rect, PathStatistics *statistics);
    /* Measures the light that arrives in a cell from every direction. */
    void (*train)(const TrainingJob *job, uint32_t cell, PathStatistics *statistics);
    /* Takes light samples in a cell: they decide how often it samples each set of lights. */
    void (*try_lights)(const TrainingJob *job, uint32_t cell, PathStatistics *statistics);
    /* The functions of aim.h. */
    void (*look)(const ProbeAim *aim, int first, int end, ProbeLook *out,
                 PathStatistics *statistics);
    void (*trace)(const ProbeAim *aim, int first, int end, const PathListener *listener,
                  PathStatistics *statistics);
    void (*sample_cells)(const ProbeAim *aim, const ProbeCells *cells, int first, int end,
                         ProbeAnswers *out, PathStatistics *statistics);
    void (*sample_suns)(const ProbeAim *aim, const ProbeSuns *suns, int first, int end,
                        ProbeAnswers *out, PathStatistics *statistics);
    void (*sample_images)(const ProbeAim *aim, int first, int end, const ProbeImages *images,
                          PathStatistics *statistics);
} Kernel;

/* isa: a name from above, or NULL for the best that this processor and program have. Fails,
 * naming what there is: ERROR_MACHINE where another processor has it, else ERROR_USAGE. */
bool kernel_choose(const char *isa, const Kernel **out, Error *err);

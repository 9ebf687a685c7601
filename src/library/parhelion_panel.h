/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion_panel.h -- libparhelion-panel: what a measured display emits and reflects, for any
 * renderer. C99 to C23 and C++; no foreign types.
 *
 * A .panel file (`parhelion panel fit` makes it of measurements; `parhelion help panel-format`
 * describes its bytes) answers, at any place of the display and at any angle: the emission as
 * XYZ or as a spectrum, the BRDF, the mirror's reflectance, and directions to go on with.
 *
 * Frame    the display's own, right-handed: +z its normal, +x to the right and +y up as who
 *          faces it sees them. Directions leave the display, also those to the light. They are
 *          of length 1; others are scaled, and one without a length, with a number that is
 *          not finite or with z <= 0 gets zeros. Places: u from 0 at the left to 1 at the
 *          right, v from 0 at the top to 1 at the bottom of the active area, held in there.
 * Units    XYZ with Y in cd m^-2; spectral radiance in W m^-2 sr^-1 nm^-1; BRDF and densities
 *          in sr^-1, the cosine not included; reflectances are shares of 1; angles in
 *          radians, wavelengths in nm. Codes are 0 to 255 a primary, fractions allowed, held
 *          in there.
 * Threads  no global state. An open panel is constant: any number of threads may query it at
 *          once; none may while another closes it.
 * Memory   arrays belong to the caller. All of a panel is freed by closing it. Opening takes
 *          address space for 4 GiB, or half of what the process may still take, and gives back
 *          what it did not need. Where the system refuses memory, or it does not suffice, there
 *          is no panel, the status is PARHELION_PANEL_NO_MEMORY and nothing is kept: the
 *          process goes on, and may open again. Questions take no memory.
 * Errors   opening reports in words what is wrong with a file. Questions fail only where they
 *          are put wrongly (ParhelionPanelStatus), and then no array is written. The library
 *          prints nothing and never ends the process.
 * ABI      structs begin with their size in bytes, which the caller fills in (sizeof): members
 *          may come in behind, and a library fills and reads no more than that. Within one
 *          soname nothing else changes. The same questions get the same bits from every build
 *          of one version, on any x86-64.
 */
#ifndef PARHELION_PANEL_H
#define PARHELION_PANEL_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define PARHELION_PANEL_API __attribute__((visibility("default")))
#else
#define PARHELION_PANEL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct ParhelionPanel ParhelionPanel; /* opaque */

typedef enum ParhelionPanelStatus {
    PARHELION_PANEL_OK = 0,
    PARHELION_PANEL_WRONG_SIZE = 1, /* a struct's size is 0 or less than its first version's */
    PARHELION_PANEL_MISSING = 2,    /* an array that the question needs is NULL */
    PARHELION_PANEL_REFUSED = 3,    /* opening: the file cannot be read, or is no good panel */
    PARHELION_PANEL_NO_MEMORY = 4   /* opening: there is not enough memory */
} ParhelionPanelStatus;

/* ---- opening ----------------------------------------------------------------------------- */

/* Reads and checks a .panel file; later changes of the file make no difference. *panel is NULL
 * where the status is not PARHELION_PANEL_OK: `error` (NULL is fine, error_size 0 then) has the
 * reason as one line, cut at error_size - 1 bytes. */
PARHELION_PANEL_API int parhelion_panel_open(const char *path, ParhelionPanel **panel, char *error,
                                             size_t error_size);

/* The same for the bytes of a file, which are copied. */
PARHELION_PANEL_API int parhelion_panel_open_memory(const void *bytes, size_t size,
                                                    ParhelionPanel **panel, char *error,
                                                    size_t error_size);

PARHELION_PANEL_API void parhelion_panel_close(ParhelionPanel *panel); /* NULL is fine */

/* ---- what it holds ----------------------------------------------------------------------- */

/* Bits of ParhelionPanelInfo.flags. */
#define PARHELION_PANEL_EMITS 1u
#define PARHELION_PANEL_REFLECTS 2u
#define PARHELION_PANEL_HAS_MIRROR 4u  /* an image in the glass, anywhere */
#define PARHELION_PANEL_ANISOTROPIC 8u /* reflection depends on the azimuth of the light */
#define PARHELION_PANEL_VARIES 16u     /* not the same at every place */
#define PARHELION_PANEL_POLARISED 32u
/* Local dimming: all answers are of a full backlight, not of what a picture makes of it. */
#define PARHELION_PANEL_HAS_ZONES 64u

/* Numbers of what is absent are 0. */
typedef struct ParhelionPanelInfo {
    uint32_t size; /* sizeof(ParhelionPanelInfo), by the caller */
    uint32_t flags;
    float emission_cone;        /* last measured angle to the normal; beyond: extrapolated */
    float reflection_cone;      /* the same of leaving directions */
    float last_incidence;       /* the same of the light */
    float emission_nm[2];       /* range of the spectra of the emission */
    float reflection_nm[2];     /* measured range of the reflection; the ends hold outside */
    float polarisation;         /* linearly polarised share of the emission */
    float polarisation_azimuth; /* in which it swings: 0 right, pi / 2 up */
} ParhelionPanelInfo;

/* Fills in *info but its size. */
PARHELION_PANEL_API int parhelion_panel_info(const ParhelionPanel *panel, ParhelionPanelInfo *info);

/* ---- questions --------------------------------------------------------------------------- */

/* Any number of questions at once: arrays have the numbers of one after those of the other.
 * What a question does not need may be NULL. */
typedef struct ParhelionPanelQuestions {
    size_t size;         /* sizeof(ParhelionPanelQuestions), by the caller */
    size_t count;        /* of questions */
    const float *place;  /* [count][2]; NULL: all in the middle, (0.5, 0.5) */
    const float *viewer; /* [count][3], the direction to the eye */
    const float *light;  /* [count][3], the direction to the light */
    const float *code;   /* [count][3], red, green, blue */
    const float *random; /* [count][3], in [0, 1) */
    size_t wavelengths;  /* requested, the same in all questions */
    const float *nm;     /* [wavelengths], in any order */
} ParhelionPanelQuestions;

/* Emission towards the viewer: viewer, code. xyz[count][3]; is_measured[count], 0: it lies
 * beyond the cone; NULL is fine. */
PARHELION_PANEL_API int parhelion_panel_emission_xyz(const ParhelionPanel *panel,
                                                     const ParhelionPanelQuestions *questions,
                                                     float *xyz, unsigned char *is_measured);

/* The same as spectral radiance: viewer, code, nm (held in 360 to 830).
 * radiance[count][wavelengths]. Its XYZ are nearly those above (0.1 % as a rule). */
PARHELION_PANEL_API int parhelion_panel_emission_spectrum(const ParhelionPanel *panel,
                                                          const ParhelionPanelQuestions *questions,
                                                          float *radiance);

/* BRDF without the mirror part: viewer, light, nm. brdf[count][wavelengths];
 * lambertian[count][wavelengths]: how much of it is the same to all sides, the rest is haze;
 * NULL is fine. Where the mirror has a share see below. */
PARHELION_PANEL_API int parhelion_panel_brdf(const ParhelionPanel *panel,
                                             const ParhelionPanelQuestions *questions, float *brdf,
                                             float *lambertian);

/* Share of the light that is mirrored, an image: viewer (the angle to the normal counts), nm.
 * reflectance[count][wavelengths]. */
PARHELION_PANEL_API int parhelion_panel_mirror(const ParhelionPanel *panel,
                                               const ParhelionPanelQuestions *questions,
                                               float *reflectance);

/* Share of the light that the BRDF sends back, its luminous mean: viewer. albedo[count]. With
 * the mirror's share it gives the odds of drawing from each. */
PARHELION_PANEL_API int parhelion_panel_albedo(const ParhelionPanel *panel,
                                               const ParhelionPanelQuestions *questions,
                                               float *albedo);

/* Draws directions to the light as the BRDF times the cosine is distributed: viewer, random.
 * light[count][3]; density[count], sr^-1, as parhelion_panel_pdf returns it, to rounding; 0:
 * there is no direction. The mirror is not drawn. */
PARHELION_PANEL_API int parhelion_panel_sample(const ParhelionPanel *panel,
                                               const ParhelionPanelQuestions *questions,
                                               float *light, float *density);

/* The density with which a direction is drawn: viewer, light. density[count]; it integrates to
 * 1 over the hemisphere. */
PARHELION_PANEL_API int parhelion_panel_pdf(const ParhelionPanel *panel,
                                            const ParhelionPanelQuestions *questions,
                                            float *density);

/* ---- the display as a light -------------------------------------------------------------- */

/* Draws directions to a viewer as luminance times the cosine is distributed: code, random.
 * viewer[count][3]; density[count], sr^-1, as parhelion_panel_pdf_emission returns it; 0: there
 * is no direction, nothing is emitted with these codes. Red, green, blue at code 255 and black
 * have a distribution each, made when the panel is opened; a code mixes them by their mean
 * luminance, so that the light over the density is nearly the same everywhere, exact in the
 * mean. Every direction above the surface has a density. The same at all places. */
PARHELION_PANEL_API int parhelion_panel_sample_emission(const ParhelionPanel *panel,
                                                        const ParhelionPanelQuestions *questions,
                                                        float *viewer, float *density);

/* The density with which a direction is drawn: viewer, code. density[count]; it integrates to
 * 1 over the hemisphere. */
PARHELION_PANEL_API int parhelion_panel_pdf_emission(const ParhelionPanel *panel,
                                                     const ParhelionPanelQuestions *questions,
                                                     float *density);

#ifdef __cplusplus
}
#endif

#endif

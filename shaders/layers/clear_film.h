/* SPDX-License-Identifier: Apache-2.0 */
/* clear_film.h -- one thin clear film on a body, at all lanes of a path: what soap, oxides and
 * pearl paints do (KHR_materials_iridescence).
 *
 * Airy's sum of all waves in the film for both polarisations, unpolarised on average; air in
 * front. The same as spectrum/thin_film.h's of one layer, in single precision.
 * Units    thickness and wavelengths in nm; indices n + ik as thin_film.h. Shares in [0, 1].
 * Source   Born and Wolf, "Principles of Optics", 7.6.1 (Airy), 14.4 (on bodies that absorb).
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "spectrum/thin_film.h"
#include "spectrum/wavelengths.h"

typedef struct ThinFilm {
    float share;        /* of the surface that carries it, [0, 1]; 0: there is none */
    float ior;          /* 1 or more */
    float thickness_nm; /* > 0 */
} ThinFilm;

/* Index of a body that absorbs nothing and reflects so much at normal incidence, [0, 1]. */
Spectrum clear_film_body(Spectrum reflectance);

/* n + ik of a body. */
typedef struct ClearFilmBody {
    Spectrum n, k;
} ClearFilmBody;

/* Reflectance of light polarised s and p. cosine: outside, [0, 1]. */
void clear_film_waves(const ThinFilm *film, const Wavelengths *wavelengths, float cosine,
                      const ClearFilmBody *body, Spectrum out[2]);

/* Their mean. n, k: of the body. */
Spectrum clear_film_at(const ThinFilm *film, const Wavelengths *wavelengths, float cosine,
                       Spectrum n, Spectrum k);

/* A film between air and a clear body, one ray through both: cosines of its angle in the air
 * and in the body, [0, 1]; n: of the body, > 0. */
typedef struct FilmCrossing {
    float in_air, in_body, n;
} FilmCrossing;

/* Reflectance, the same from either side; the rest goes through. 1 where a cosine is 0: the
 * ray grazes or is reflected totally, which a clear film does not change. */
Spectrum clear_film_between(const ThinFilm *film, const Wavelengths *wavelengths,
                            const FilmCrossing *ray);
float clear_film_lane(const ThinFilm *film, float nm, const FilmCrossing *ray);

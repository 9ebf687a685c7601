/* dielectric.h -- clear glass and plastic: the boundary of a solid.
 *
 * The user page is on top of dielectric.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/clear_film.h"
#include "shaders/coating.h"
#include "shaders/facets/solid_energy.h"

/* Where a solid ends. The frame's +z is the outside: wo.z < 0 is an eye inside the solid. */
typedef struct Dielectric {
    Spectrum tint;  /* [0, 1]: of transmitted light, at each crossing */
    float    ior;   /* of the solid against its surroundings, > 0; 0: reflects everything */
    float    alpha; /* GGX, [0, 1]; below SMOOTH_ALPHA smooth */
    float    alpha_along; /* brushed: GGX along the frame's x, in [SMOOTH_ALPHA, 1]; then alpha
                             is that along y, in the same range. 0: alpha */
    ThinFilm film;  /* in air, without a coating; share 0: none */
    const CoatingTables *coating;     /* of that boundary; NULL: bare */
    const Wavelengths   *wavelengths; /* NULL where there is no coating, film or index */
    const Curve         *index;       /* by wavelength, 1 or more, in place of ior; NULL: it is
                                         the same for all. Without a coating */
    /* What rough facets pass to one another, of that ior; where the index differs by wavelength
     * of its least and its greatest. NULL: it is lost (a smooth boundary has none). */
    const SolidEnergy   *energy, *energy_most;
    const Spectrum      *light;       /* of a path that is split: what its lanes still count,
                                         >= 0; chance follows it. NULL: all alike */
} Dielectric;

extern const BsdfModel dielectric_model;

/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_look.h"

#include "shaders/metallic/metallic_base.h"
#include "shaders/metallic/metallic_choices.h"
#include "shaders/metallic/metallic_covered.h"
#include "shaders/metallic/metallic_coat.h"

static void set_film(MetallicView *view)
{
    view->coated = spectrum_all(0);
    if (!(view->m->metallic < 1)) return;
    for (int i = 0; i < LOBE_FACETS; i++)
        view->film[i] = facet_reflectance(view->m, &view->boundary, facet_cosine[i]);
    view->coated = energy_filmed(view, view->wo);
}

/* Layers that a surface does not have leave their members as they were. */
static void set_layers(MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    if (m->clearcoat > 0) {
        view->through = coat_through(m, view->wo);
        view->coat_mean = coat_mean(m->coat, m->alpha, m->clearcoat_alpha);
    }
    if (coated_face(m)) view->coated = energy_coated(m, view->wo);
    if (has_film(m)) set_film(view);
}

void metallic_look(MetallicView *view, const MetallicRoughness *m, Vec3 wo)
{
    view->m = m;
    view->wo = wo;
    view->boundary = boundary_of(m);
    view->energy = base_energy(m, wo);
    view->coat = coat_albedo(m, wo);
    set_layers(view);
    if (is_covered(m)) covered_set(view);
    if (has_sheen(m)) {
        view->sheen = sheen_towards(m, wo);
        view->sheen_mean =
            sheen_mean(&common_sheen_table, m->sheen_alpha, energy_even_alpha(m));
    }
    view->choices = metallic_choose(view);
    if (has_lambert(m)) view->lambert = base_lambert_towards(view);
}

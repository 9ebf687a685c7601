/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/metallic/metallic_choices.h"

#include "shaders/metallic/metallic_base.h"
#include "shaders/metallic/metallic_coat.h"

static MetallicChoices scaled_to_one(MetallicChoices c)
{
    float sum = c.coat + c.mirror + c.diffuse + c.through + c.across + c.sheen;
    float scale = sum > 0 ? 1 / sum : 0;
    return (MetallicChoices){c.coat * scale,    c.mirror * scale, c.diffuse * scale,
                             c.through * scale, c.across * scale, c.sheen * scale};
}

static MetallicChoices beside_sheen(const MetallicView *view, MetallicChoices c)
{
    const MetallicRoughness *m = view->m;
    float left = 1 - sheen_most(m) * view->sheen.albedo;
    return (MetallicChoices){.coat = c.coat,
                     .mirror = c.mirror * left,
                     .diffuse = c.diffuse * left,
                     .through = c.through * left,
                     .across = c.across * left,
                     .sheen = (1 - c.coat) * view->sheen.albedo *
                              spectrum_mean(sheen_tint(m))};
}

/* Mean shares of light for choosing, where a part is coated. */
static MetallicChoices choose_coated(const MetallicView *view, float coat)
{
    const MetallicRoughness *m = view->m;
    float z = view->wo.z, lost = 1 - view->energy.all, under = 1 - coat;
    float clear = (1 - m->metallic) * m->transmission, solid = 1 - m->metallic - clear;
    float base = spectrum_mean(lambert_back(m));
    float facets = spectrum_mean(facet_of_nonmetal(m, &view->boundary, z));
    float metal = m->metallic > 0 ? spectrum_mean(facet_of_metal(m, z)) : 0;
    float through = clear > 0 ? spectrum_mean(facet_through(m, &view->boundary, z)) : 0;
    float face = coated_face(m) || has_film(m) ? spectrum_mean(view->coated) :
                 spectrum_mean(spectrum_all(1) - let_in(&view->boundary, view->energy));
    return (MetallicChoices){
        .coat = coat,
        .mirror = under * (facets + metal),
        .diffuse = under * (base * solid * (1 - face) +
                            lost * (metal * metal + facets * clear)),
        .through = under * through,
        .across = m->across > 0 ?
                      under * solid * (1 - face) * spectrum_mean(base_lambert_across(m)) : 0};
}

/* Probabilities follow the lanes' mean albedo of each part, so that none is ever starved. */
static inline MetallicChoices choose(const MetallicView *view)
{
    const MetallicRoughness *m = view->m;
    Energy e = view->energy;
    if (m->coating || has_film(m)) {
        float above = vec3_dot(m->clearcoat_normal, view->wo);
        return choose_coated(view, above > 0 ? view->coat : 0);
    }
    float  base = spectrum_mean(m->base_color);
    float  f0 = spectrum_mean(view->boundary.f0);
    float face = f0 * e.all + (m->specular - f0) * e.shape;
    float sheet = 2 * face / (1 + face);
    float metal = base * e.all + (1 - base) * e.shape;
    float clear = (1 - m->metallic) * m->transmission, solid = 1 - m->metallic - clear;
    float coat = vec3_dot(m->clearcoat_normal, view->wo) > 0 ? view->coat : 0;
    float under = 1 - coat;
    MetallicChoices c = {
        .coat = coat,
        .mirror = under * (solid * face + clear * sheet + m->metallic * metal),
        .diffuse = under * (base * (solid * (1 - m->across) * (1 - face) +
                                    m->metallic * base * (1 - e.all)) +
                            clear * sheet * (1 - e.all)),
        .through = under * base * clear * (1 - sheet),
        .across = 0,
    };
    if (m->across > 0)
        c.across = under * solid * (1 - face) * spectrum_mean(base_lambert_across(m));
    return c;
}

/* A coat holds light back that passes a sheet: part of it is sent back by its turns. What its
 * facets hide, and fibres send from below, leaves on both sides. */
static MetallicChoices choose_turns(const MetallicView *view, MetallicChoices c)
{
    const MetallicRoughness *m = view->m;
    CoatOnSheet coat = coat_on_sheet(m, &view->through, &view->through);
    SheetFaces  faces = facet_sheet(m, &view->boundary, view->wo.z);
    SheetLight  turned = sheet_turns(&faces, coat.held), spread = coat_sheet_rebound(view);
    float front = spectrum_mean(faces.front), through = spectrum_mean(faces.through);
    float back = spectrum_mean(turned.back), on = spectrum_mean(turned.through);
    float hidden = is_covered(m) ? view->covered.rest.metal
                                 : view->through.open * (1 - view->energy.all);
    if (through > 0) { /* the sum of both stays as it was */
        float left = (front + through) * on / ((back + on) * through);
        float moved = c.through * m->clearcoat * fmaxf(1 - left, 0);
        c.mirror += moved;
        c.through -= moved;
    }
    c.diffuse += m->clearcoat * hidden * spectrum_mean(spread.back);
    if (is_covered(m)) c.across += m->clearcoat * hidden * spectrum_mean(spread.through);
    return c;
}

MetallicChoices metallic_choose(const MetallicView *view)
{
    MetallicChoices choices = choose(view);
    if (has_sheen(view->m)) choices = beside_sheen(view, choices);
    if (has_sheet_under_coat(view->m)) choices = choose_turns(view, choices);
    return scaled_to_one(choices);
}

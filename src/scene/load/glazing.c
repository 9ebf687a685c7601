/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/load/glazing.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "scene/load/coating.h"
#include "scene/optics/curve_file.h"
#include "scene/load/texture_slot.h"

#define LEAST_TRANSMITTANCE 1e-12 /* black: its logarithm is still a number */

/* The transmittance of one layer; 1 for a layer that states none. */
static void read_transmission(GltfFile *file, const GltfValue *layer, Curve *out) {
    const GltfValue *value = tree_member(layer, "transmission");
    float constant = value && value->kind == GLTF_NUMBER ? (float)value->number : 1;
    if (value && value->kind == GLTF_STRING && curve_file_read(file, value, CURVE_SHARES, out))
        return;
    for (int i = 0; i < CURVE_COUNT; i++) out->value[i] = constant;
}

/* Adds a layer's absorbance; returns its mean. */
static double absorb(const Curve *transmission, Curve *absorbance) {
    double sum = 0;
    for (int i = 0; i < CURVE_COUNT; i++) {
        double a = -log_d(fmax((double)transmission->value[i], LEAST_TRANSMITTANCE));
        absorbance->value[i] += (float)a;
        sum += a;
    }
    return sum / CURVE_COUNT;
}

static void read_wedge(const GltfValue *layer, Glazing *pane) {
    float wedge = tree_float(layer, "wedge_rad", 0);
    const char *towards = tree_text(layer, "wedge_toward", "+v");
    if (wedge == 0) return;
    pane->wedge[towards[1] == 'v'] = towards[0] == '-' ? -wedge : wedge;
    pane->wedge_ior = tree_float(layer, "ior", 0);
}

static void read_layers(GltfFile *file, const GltfValue *layers, Glazing *pane) {
    double absorbed = 0, weighed = 0;
    for (int i = 0; i < layers->count; i++) {
        Curve curve;
        const GltfValue *value = &layers->items[i];
        GlazingLayer *layer = &pane->layers[pane->layer_count++];
        *layer =
            (GlazingLayer){tree_float(value, "thickness_m", 0), tree_float(value, "ior", 1.52f)};
        read_transmission(file, value, &curve);
        double mean = absorb(&curve, &pane->absorbance);
        absorbed += mean;
        weighed += mean * (double)layer->ior;
        read_wedge(value, pane);
    }
    pane->absorbing_ior = absorbed > 0 ? (float)(weighed / absorbed) : pane->layers[0].ior;
}

static void become_pane(Material *m, const Glazing *pane) {
    m->glazing = pane;
    m->transmission = 1;
    m->roughness = m->metallic = m->clearcoat = m->diffuse_transmission = 0;
    m->is_solid = false;
    m->ior = pane->layers[0].ior;
    m->normal_texture = texture_slot_none();
}

void glazing_build(GltfFile *file, const GltfValue *glazing, Material *material) {
    const GltfValue *layers = tree_member(glazing, "layers");
    const GltfValue *haze = tree_member(glazing, "haze");
    if (!layers || layers->count < 1 || layers->count > GLAZING_LAYERS_MAX) return;
    Glazing *pane = ARENA_NEW(file->load->arena, Glazing, 1);
    *pane = (Glazing){.wedge_ior = 1};
    read_layers(file, layers, pane);
    pane->haze_share = tree_float(haze, "share", 0);
    pane->haze_width = (float)sin_d(radians_from_degrees(tree_number(haze, "width_deg", 0)));
    pane->coating[0] = coating_read(file, tree_member(glazing, "coating_outside"));
    pane->coating[1] = coating_read(file, tree_member(glazing, "coating_inside"));
    become_pane(material, pane);
}

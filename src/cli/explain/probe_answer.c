/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/explain/probe_answer.h"

#include <math.h>
#include <stdio.h>

#include "cli/options/answer.h"
#include "review/chain/chain_words.h"
#include "review/output/ray_file.h"
#include "text/json_text.h"

#define BAR 40 /* letters of the longest in the spectrum */

/* One thing that a chain of objects does with light, in the order of the eye's ray. */
typedef struct ProbeBounce {
    const char *what;
    int         part_id;
    Vec3        at;       /* on one of the chain's paths; only if has_place: */
    bool        has_place;
} ProbeBounce;

#define BOUNCES (2 * CHAIN_STEPS + 2)

typedef struct ProbeWay {
    ProbeBounce bounce[BOUNCES];
    int         count;
    const char *light;     /* as the scene has it */
    bool        has_from;  /* the light is near: */
    Vec3        from;      /* where that path met it */
} ProbeWay;

/* ---- a chain as bounces ------------------------------------------------------------------ */

static const char *event_word(int event)
{
    static const char *const words[] = {"scatters", "mirror", "refracts"};
    return words[event];
}

static void add_bounce(ProbeWay *way, const char *what, int part_id, const Vec3 *at)
{
    ProbeBounce *bounce = &way->bounce[way->count++];
    *bounce = (ProbeBounce){.what = what, .part_id = part_id, .has_place = at != NULL};
    if (at) bounce->at = *at;
}

static void add_pane(ProbeWay *way, int part_id)
{
    if (part_id != NO_ID) add_bounce(way, "passes", part_id, NULL);
}

static bool is_distant(const Scene *scene, const ChainKey *key)
{
    if (key->source == LIGHTS_EMITTERS) return false;
    return key->source != LIGHTS_PUNCTUAL ||
           scene->lights[key->source_id].kind == LIGHT_DIRECTIONAL;
}

static int group_of(const Probed *probed, const ChainKey *key)
{
    return light_group_of(&probed->groups, (LightSet)key->source, key->source_id);
}

static ProbeWay way_of(const Probed *probed, const Chain *chain)
{
    const ChainKey *key = &chain->key;
    const ChainRay *ray = chain->ray_count ? &chain->rays[0] : NULL;
    ProbeWay way = {.light = probed->groups.said[group_of(probed, key)]};
    for (int i = 0; i < key->count; i++) {
        add_pane(&way, key->link[i].pane_id);
        add_bounce(&way, event_word(key->link[i].event), key->link[i].part_id,
                   ray ? &ray->point[i + 1] : NULL);
    }
    add_pane(&way, key->pane_id);
    way.has_from = ray && !ray->is_cut && !is_distant(probed->chains.scene, key);
    if (way.has_from) way.from = ray->point[ray->count - 1];
    return way;
}

/* ---- as text ----------------------------------------------------------------------------- */

static void print_place(Vec3 at)
{
    printf("  at %.3f, %.3f, %.3f m", (double)at.x, (double)at.y, (double)at.z);
}

static void print_way(const Probed *probed, const Chain *chain, Arena scratch)
{
    ProbeWay way = way_of(probed, chain);
    printf("%6.1f %%  %10.4g  %9.2g  %s\n",
           100 * chain->figure.cd_m2 / probed->chains.all.cd_m2, chain->figure.cd_m2,
           chain->figure.sigma, way.light);
    for (int i = 0; i < way.count; i++) {
        const ProbeBounce *bounce = &way.bounce[i];
        printf("%34d %-8s %s", i + 1, bounce->what,
               chain_part_words(probed->chains.scene, bounce->part_id, &scratch));
        if (bounce->has_place) print_place(bounce->at);
        printf("\n");
    }
    if (chain->key.is_longer) printf("%34s further surfaces\n", "");
    if (!way.has_from) return;
    printf("%34s begins ", "");
    print_place(way.from);
    printf("\n");
}

static void print_ways(const Probed *probed, Arena scratch)
{
    const Chains *chains = &probed->chains;
    if (!(chains->all.cd_m2 > 0)) return;
    printf("\n   share       cd/m2      error  light, and what the eye's ray meets before "
           "it\n");
    for (int i = 0; i < chains->count; i++) print_way(probed, &chains->list[i], scratch);
    if (chains->others)
        printf("%6.1f %%  %10.4g  %9.2g  %d other ways\n",
               100 * chains->rest.cd_m2 / chains->all.cd_m2, chains->rest.cd_m2,
               chains->rest.sigma, chains->others);
}

static double greatest(const PixelLight *light)
{
    double most = 0;
    for (int i = 0; i < PIXEL_BANDS; i++) most = fmax(most, light->radiance[i].mean);
    return most;
}

static int band_center_nm(int band)
{
    return PIXEL_FIRST_NM + PIXEL_BAND_NM * band + PIXEL_BAND_NM / 2;
}

static void print_spectrum(const PixelLight *light)
{
    double most = greatest(light);
    if (!(most > 0)) return;
    printf("\n    nm  W m-2 sr-1 nm-1      error\n");
    for (int i = 0; i < PIXEL_BANDS; i++) {
        const PixelFigure *figure = &light->radiance[i];
        int length = (int)(BAR * fmax(figure->mean, 0) / most + 0.5);
        printf("%6d  %15.4g  %9.2g  %.*s\n", band_center_nm(i), figure->mean, figure->sigma,
               length, "########################################");
    }
}

static void print_text(const Probed *probed, Arena scratch)
{
    const PixelFigure *xyz = probed->light.xyz;
    double sum = xyz[0].mean + xyz[1].mean + xyz[2].mean;
    printf("pixel      %d,%d of %dx%d, %ld paths\n", probed->pixel[0], probed->pixel[1],
           probed->size[0], probed->size[1], probed->chains.paths);
    printf("luminance  %.5g cd/m2, standard error %.2g", xyz[1].mean, xyz[1].sigma);
    if (sum > 0) printf("; x %.4f, y %.4f", xyz[0].mean / sum, xyz[1].mean / sum);
    printf("\n");
    print_ways(probed, scratch);
    print_spectrum(&probed->light);
}

/* ---- as JSON ----------------------------------------------------------------------------- */

static json_t *json_point(bool is_there, Vec3 p)
{
    return is_there ? json_pack("[f,f,f]", (double)p.x, (double)p.y, (double)p.z)
                    : json_null();
}

static json_t *json_bounces(const Probed *probed, const ProbeWay *way)
{
    const Scene *scene = probed->chains.scene;
    json_t      *out = json_array();
    for (int i = 0; i < way->count; i++) {
        const ProbeBounce *bounce = &way->bounce[i];
        const Part        *part = &scene->parts[bounce->part_id];
        json_array_append_new(out, json_pack(
            "{s:s, s:o, s:o, s:o}", "what", bounce->what, "material",
            json_text(scene->materials[part->material_id].name), "node", json_text(part->name),
            "at_m", json_point(bounce->has_place, bounce->at)));
    }
    return out;
}

static json_t *json_rays(const Chain *chain)
{
    json_t *out = json_array();
    for (int i = 0; i < chain->ray_count; i++) {
        json_t *ray = json_array();
        for (int k = 0; k < chain->rays[i].count; k++)
            json_array_append_new(ray, json_point(true, chain->rays[i].point[k]));
        json_array_append_new(out, ray);
    }
    return out;
}

static json_t *json_way(const Probed *probed, const Chain *chain)
{
    static const char *const kinds[] = {"sun", "sky", "surface", "lamp"};
    ProbeWay way = way_of(probed, chain);
    return json_pack("{s:o, s:s, s:o, s:f, s:f, s:f, s:o, s:b, s:o}", "light",
                     json_text(way.light), "kind", kinds[chain->key.source], "from_m",
                     json_point(way.has_from, way.from), "cd_m2", chain->figure.cd_m2,
                     "standard_error_cd_m2", chain->figure.sigma, "share",
                     chain->figure.cd_m2 / probed->chains.all.cd_m2, "bounces",
                     json_bounces(probed, &way), "has_further_surfaces",
                     chain->key.is_longer, "rays", json_rays(chain));
}

static json_t *json_spectrum(const PixelLight *light)
{
    json_t *nm = json_array(), *radiance = json_array(), *error = json_array();
    for (int i = 0; i < PIXEL_BANDS; i++) {
        json_array_append_new(nm, json_integer(band_center_nm(i)));
        json_array_append_new(radiance, json_real(light->radiance[i].mean));
        json_array_append_new(error, json_real(light->radiance[i].sigma));
    }
    return json_pack("{s:s, s:i, s:o, s:o, s:o}", "unit", "W m-2 sr-1 nm-1", "band_nm",
                     PIXEL_BAND_NM, "nm", nm, "radiance", radiance, "standard_error", error);
}

static bool print_json(const Probed *probed, Error *err)
{
    const Chains      *chains = &probed->chains;
    const PixelFigure *xyz = probed->light.xyz;
    json_t *ways = json_array();
    for (int i = 0; i < chains->count; i++)
        json_array_append_new(ways, json_way(probed, &chains->list[i]));
    return cli_print_json(
        json_pack("{s:[i,i], s:[i,i], s:I, s:o, s:[f,f,f], s:f, s:f, s:o, s:{s:i,s:f,s:f}, "
                  "s:o}",
                  "pixel", probed->pixel[0], probed->pixel[1], "size", probed->size[0],
                  probed->size[1], "paths", (json_int_t)chains->paths, "eye_m",
                  json_point(true, probed->eye), "XYZ", xyz[0].mean, xyz[1].mean, xyz[2].mean,
                  "luminance_cd_m2", xyz[1].mean, "standard_error_cd_m2", xyz[1].sigma, "ways",
                  ways, "other_ways", "count", chains->others, "cd_m2", chains->rest.cd_m2,
                  "standard_error_cd_m2", chains->rest.sigma, "spectrum",
                  json_spectrum(&probed->light)),
        err);
}

bool probe_answer(const Cli *cli, const Probed *probed, Arena *arena, Error *err)
{
    if (cli->json) return print_json(probed, err);
    print_text(probed, *arena);
    return true;
}

/* ---- rays -------------------------------------------------------------------------------- */

static CaseRay ray_of(const ChainRay *from)
{
    return (CaseRay){from->point, from->count};
}

bool probe_write_rays(const Probed *probed, const char *path, Arena *arena, Error *err)
{
    const Chains *chains = &probed->chains;
    Arena         scratch = *arena;
    CaseCause    *causes = ARENA_NEW(&scratch, CaseCause, chains->count);
    for (int i = 0; i < chains->count; i++) {
        const Chain *chain = &chains->list[i];
        CaseRay     *rays = ARENA_NEW(&scratch, CaseRay, chain->ray_count);
        for (int k = 0; k < chain->ray_count; k++) rays[k] = ray_of(&chain->rays[k]);
        causes[i] = (CaseCause){.share = chain->figure.cd_m2 / chains->all.cd_m2,
                                .cd_m2 = chain->figure.cd_m2, .rays = rays,
                                .ray_count = chain->ray_count,
                                .contrast_without = (double)NAN,
                                .light = 1 + group_of(probed, &chain->key)};
        causes[i].chain = chain_words(chains->scene, &chain->key, &causes[i].links, &scratch);
    }
    const ReviewCase all = {.causes = causes, .cause_count = chains->count};
    return ray_file_write(&all, path, err);
}

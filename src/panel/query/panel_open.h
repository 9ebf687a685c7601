/* panel_open.h -- the sections of a panel file while it is opened. Private to src/panel.
 *
 * Every function that fails says so in bytes->err, naming the file and the place.
 */
#pragma once
#include "panel/query/panel_file.h"

/* A piece of the file, or the whole. */
typedef struct PanelBytes {
    const unsigned char *data;
    size_t      size;
    const char *name; /* of the file */
    Error      *err;
} PanelBytes;

/* "the panel file is damaged"; always false. */
bool panel_refuse(const PanelBytes *bytes, const char *place, const char *what);

/* The section of a kind and index, inside the file; true with *found false when absent. */
bool panel_find_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out, bool *found);

/* The same; absent is an error. */
bool panel_need_section(const PanelBytes *bytes, PanelSectionKind kind, uint32_t index,
                        PanelBytes *out);

/* Numbers that a query may use: finite and below 1e30. */
bool panel_all_finite(const float *value, size_t count);

bool panel_rising(const float *value, uint32_t count);

/* The emission's sections into *panel; a file without them is fine. */
bool panel_open_emission(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                         Panel *panel);

/* How the primaries' spectra bend: a few milliseconds, once everything else is in order. */
void panel_open_bends(Panel *panel);

/* The reflection's sections into *panel; a file without them is fine. Tables that are derived
 * from the stored ones come from the arena. */
bool panel_open_reflection(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                           Panel *panel);

/* The reflection alone, from its section and its tree, into *panel. */
bool panel_expand_reflection(const PanelBytes *at, const PanelBytes *tree,
                             const Geodesic *geodesic, Arena *arena, Panel *panel);

/* The sampling tree, expanded into the arena; a file without one leaves the panel as it is.
 * The reflection is there. */
bool panel_open_sampling(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                         Panel *panel);

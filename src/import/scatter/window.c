/* SPDX-License-Identifier: Apache-2.0 */
/* WINDOW's and Radiance's BSDF as XML: a matrix over Klems patches, or a tensor tree. */
#include <string.h>

#include "import/scatter/klems.h"
#include "import/scatter/scatter.h"
#include "import/scatter/tensor_tree.h"

static bool read_window(const char *file, const ImportOptions *options, ImportSet *set,
                        Error *err)
{
    WindowXml in;
    if (!window_xml_read(file, set, &in, err)) return false;
    const float *nm = scatter_photopic(options, file, set);
    if (!set->panel) set->panel = in.panel;
    bool is_matrix = in.structure == WINDOW_COLUMNS || in.structure == WINDOW_ROWS;
    return is_matrix ? klems_add(&in, nm, set, err) : tensor_tree_add(&in, nm, set, err);
}

static bool is_window(const char *file, const char *head, size_t head_size)
{
    (void)file;
    (void)head_size;
    return strstr(head, "<WindowElement") != NULL;
}

const Importer importer_window = {
    "window", "WINDOW / Radiance BSDF as XML: Klems or tensor tree", is_window, read_window};

/* SPDX-License-Identifier: Apache-2.0 */
#include "import/luminaire/luminaire_read.h"

#include <strings.h>

#include "base/file.h"
#include "import/luminaire/eulumdat.h"
#include "import/luminaire/ies.h"

bool luminaire_is_eulumdat(const char *file) {
    return !strcasecmp(path_ending(file), ".ldt");
}

bool luminaire_read(const char *file, FileBytes bytes, ImportSet *set, Luminaire *out, Error *err) {
    return luminaire_is_eulumdat(file) ? eulumdat_read_luminaire(file, &bytes, set, out, err)
                                       : ies_read_luminaire(file, &bytes, set, out, err);
}

#include "import/luminaire/luminaire_read.h"

#include <strings.h>

#include "base/file.h"
#include "import/luminaire/eulumdat.h"
#include "import/luminaire/ies.h"

bool luminaire_read(const char *file, ImportSet *set, Luminaire *out, Error *err)
{
    bool is_eulumdat = !strcasecmp(path_ending(file), ".ldt");
    return is_eulumdat ? eulumdat_read_luminaire(file, set, out, err)
                       : ies_read_luminaire(file, set, out, err);
}

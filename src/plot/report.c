#include "plot/plot.h"

bool plot_write_report(const PlotInput *input, const PlotOptions *options, const char *path,
                       Arena *arena, int *figures, Error *err)
{
    (void)input, (void)options, (void)arena, (void)figures;
    return error_set(err, ERROR_USAGE, "%s", path);
}

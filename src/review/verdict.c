#include "review/verdict.h"

#include <math.h>

const char *const verdict_names[4] = {"pass", "fail", "too close", "not visible"};
int verdict_rank(Verdict verdict)
{
    static const int ranks[] = {0, 3, 1, 2};
    return ranks[verdict];
}

const char *const ambient_names[4] = {"night", "twilight", "day", "sun"};

double luminance_contrast(double one, double other, double added)
{
    double brighter = fmax(one, other) + added, darker = fmin(one, other) + added;
    return darker > 0 ? brighter / darker : brighter > 0 ? (double)INFINITY : 1;
}

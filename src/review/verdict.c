#include "review/verdict.h"

const char *const verdict_names[4] = {"pass", "fail", "too close", "not visible"};
const char *const ambient_names[4] = {"night", "twilight", "day", "sun"};

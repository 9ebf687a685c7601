#include "plot/plot.h"

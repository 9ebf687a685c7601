#pragma once
#include "spectrum/spectrum.h"
typedef struct MetallicRoughness { Spectrum base_color; } MetallicRoughness;

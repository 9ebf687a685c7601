#pragma once
#include "spectrum/spectrum.h"
typedef struct ThinWindow { Spectrum tint; } ThinWindow;
typedef struct Dielectric { float ior; } Dielectric;

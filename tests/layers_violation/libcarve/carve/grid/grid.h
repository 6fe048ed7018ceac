#include "carve/carving/carve_silhouettes.h"

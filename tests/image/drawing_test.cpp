#include "carve/image/drawing.h"

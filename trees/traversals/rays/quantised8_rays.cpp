#define BOXWOOD_RAY_NODE QuantisedBlock
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/rays/quantised8_rays.cpp"
#include "trees/traversals/rays/layout_rays-inl.h"

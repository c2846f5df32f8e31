#define BOXWOOD_RAY_NODE RayNode<16>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/rays/wide16_rays.cpp"
#include "trees/traversals/rays/layout_rays-inl.h"

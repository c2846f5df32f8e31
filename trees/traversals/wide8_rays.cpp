#define BOXWOOD_RAY_NODE RayNode<8>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/wide8_rays.cpp"
#include "trees/traversals/layout_rays-inl.h"

#define BOXWOOD_RAY_NODE RayNode<4>
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/rays/wide4_rays.cpp"
#include "trees/traversals/rays/layout_rays-inl.h"

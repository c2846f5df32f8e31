#pragma once

/// The kernels room: a few primitives in, one answer out, nothing allocated, threaded or logged.
/// What each kernel promises is its KernelInfo (verdict.h); `boxwood list kernels` prints them all.

#include "kernels/primitives/aabb.h"                              // closed boxes: overlap, merge, half area
#include "kernels/boxes/box_fit_kernel.h"              // contract: the box of a transformed box
#include "kernels/boxes/fit.h"                         // ... plain, and padded by its rounding
#include "kernels/primitives/obb.h"                         // boxes in any pose
#include "kernels/boxes/obb_kernel.h"                  // contract: such a box against another
#include "kernels/primitives/rigid_transform.h"             // rotation and translation
#include "kernels/boxes/sat.h"                         // ... 15 directions, plain and certified
#include "kernels/registry.h"                         // every kernel by its word
#include "kernels/continuous/continuous_kernel.h"      // contract: points in linear motion
#include "kernels/continuous/cubic.h"                  // ... roots of a cubic
#include "kernels/continuous/tight_inclusion.h"        // ... separating planes, no miss
#include "kernels/features/point_segment.h"            // ... foot on the line, clamped
#include "kernels/features/point_triangle.h"           // ... by region, and by cross product
#include "kernels/features/segment_segment.h"          // ... Ericson, and by cross product
#include "kernels/arithmetic/float_mode.h"                        // flush-to-zero, and keeping it out
#include "kernels/predicates/exact.h"                  // exact orientation signs of any doubles
#include "kernels/predicates/filtered.h"               // ... where an error bound decides
#include "kernels/predicates/orientation.h"            // who decides triangle truth
#include "kernels/predicates/rounded.h"                // ... plain double
#include "kernels/primitives/ray.h"                               // rays and their hits
#include "kernels/ray_box/plain.h"                     // ... textbook slabs, nothing padded
#include "kernels/ray_box/ray_box_kernel.h"            // contract: ray against box
#include "kernels/ray_box/slabs.h"                     // ... losing no true hit
#include "kernels/ray_triangle/baldwin_weber.h"        // ... map to the unit triangle
#include "kernels/ray_triangle/blocks.h"               // ... 4 or 8 triangles at a time
#include "kernels/ray_triangle/exact.h"                // ... exactly: filter, fixed point
#include "kernels/ray_triangle/moller_trumbore.h"      // ... in float or double
#include "kernels/ray_triangle/plucker.h"              // ... sides of the edges
#include "kernels/ray_triangle/ray_kernel.h"           // contract: ray against triangle
#include "kernels/ray_triangle/triangle_block.h"       // triangles side by side for SIMD
#include "kernels/ray_triangle/watertight.h"           // ... Woop, Benthin, Wald 2013
#include "kernels/arithmetic/rounding.h"                          // double -> float, outward
#include "kernels/primitives/triangle.h"                          // triangles and indexed meshes
#include "kernels/triangle_distance/certified.h"       // ... between proven bounds
#include "kernels/triangle_distance/distance_kernel.h" // contract: distance of triangles, features
#include "kernels/triangle_distance/features.h"        // ... 15 features, plain
#include "kernels/triangle_distance/features_batch.h"  // ... eight pairs at a time
#include "kernels/triangle_triangle/exact.h"           // ... exactly: filter, integers, fixed point
#include "kernels/triangle_triangle/guigue_devillers.h"       // ... Guigue, Devillers 2003
#include "kernels/triangle_triangle/guigue_devillers_batch.h" // ... sixteen pairs at a time
#include "kernels/triangle_triangle/moller.h"                 // ... Moeller 1997
#include "kernels/triangle_triangle/sat.h"                    // ... separating axes
#include "kernels/triangle_triangle/sat_certified.h"          // ... with proven gaps and overlaps
#include "kernels/triangle_triangle/triangle_kernel.h"        // contract: triangle against triangle
#include "kernels/primitives/vec3.h"                                     // points and directions
#include "kernels/verdict.h"                                  // no, yes, maybe; promises

#pragma once

/// All public headers of kernels/: a few primitives in, one answer out, nothing allocated, threaded
/// or logged. What each kernel promises is its KernelInfo (decision.h); `boxwood list kernels`
/// prints them all. Not here: kernels/simd/*-inl.h, for code that is compiled once per instruction
/// set, and the oracle, a target of its own.

// Primitives
#include "kernels/primitives/aabb.h"             // closed boxes: overlap, merge, half area
#include "kernels/primitives/coordinate_limit.h" // 2^60
#include "kernels/primitives/obb.h"              // boxes in any pose
#include "kernels/primitives/ray.h"              // rays and their hits
#include "kernels/primitives/rigid_transform.h"  // rotation and translation
#include "kernels/primitives/rotation.h"         // products of them
#include "kernels/primitives/segment.h"
#include "kernels/primitives/sphere.h"
#include "kernels/primitives/triangle.h" // triangles and indexed meshes
#include "kernels/primitives/vec3.h"     // points and directions

// Arithmetic
#include "kernels/arithmetic/float_mode.h" // flush-to-zero, and keeping it out
#include "kernels/arithmetic/on_both.h"    // what a CUDA device calls too
#include "kernels/arithmetic/rounding.h"   // double to float, outward

// Robots
#include "kernels/kinematics/kinematic_tree.h"    // values of joints to poses of links
#include "kernels/kinematics/robot_description.h" // links, joints, geometry, as plain data

// What all kernels share
#include "kernels/decision.h" // no, yes, maybe; promises
#include "kernels/registry.h" // every kernel by its name

// Orientation signs
#include "kernels/predicates/exact.h"       // of any finite doubles
#include "kernels/predicates/filtered.h"    // where an error bound decides
#include "kernels/predicates/orientation.h" // contract
#include "kernels/predicates/rounded.h"     // in plain float or double

// Do two triangles share a point
#include "kernels/triangle_triangle/exact.h"                  // filter, integers, fixed point
#include "kernels/triangle_triangle/float_pair.h"             // as a thread of a device decides
#include "kernels/triangle_triangle/guigue_devillers.h"       // Guigue, Devillers 2003
#include "kernels/triangle_triangle/guigue_devillers_batch.h" // sixteen pairs at a time
#include "kernels/triangle_triangle/moller.h"                 // Moeller 1997
#include "kernels/triangle_triangle/sat.h"                    // separating axes
#include "kernels/triangle_triangle/sat_certified.h"          // with proven gaps and overlaps
#include "kernels/triangle_triangle/triangle_kernel.h"        // contract

// Minimum distance
#include "kernels/features/point_segment.h"            // foot on the line, clamped
#include "kernels/features/point_triangle.h"           // by region, and by cross product
#include "kernels/features/segment_segment.h"          // Ericson, and by cross product
#include "kernels/features/upward_crossing.h"          // of a triangle, by a ray from a point
#include "kernels/triangle_distance/certified.h"       // between proven bounds
#include "kernels/triangle_distance/distance_kernel.h" // contract: triangles, segments, points
#include "kernels/triangle_distance/features.h"        // 15 features, plain
#include "kernels/triangle_distance/features_batch.h"  // eight pairs at a time
#include "kernels/triangle_distance/float_pair.h"      // as a thread of a device measures

// Where a ray meets a triangle
#include "kernels/ray_triangle/baldwin_weber.h"   // map to the unit triangle
#include "kernels/ray_triangle/blocks.h"          // 4 or 8 triangles at a time
#include "kernels/ray_triangle/exact.h"           // filter, fixed point
#include "kernels/ray_triangle/moller_trumbore.h" // in float or double
#include "kernels/ray_triangle/plucker.h"         // sides of the edges
#include "kernels/ray_triangle/ray_kernel.h"      // contract
#include "kernels/ray_triangle/triangle_block.h"  // triangles side by side for SIMD
#include "kernels/ray_triangle/watertight.h"      // Woop, Benthin, Wald 2013

// Whether a ray meets a box
#include "kernels/ray_box/fused_slabs.h"    // by fused products, for boxes within known bounds
#include "kernels/ray_box/plain.h"          // textbook slabs, nothing padded
#include "kernels/ray_box/ray_box_kernel.h" // contract
#include "kernels/ray_box/slabs.h"          // no true hit is missed

// Boxes in motion and in any pose
#include "kernels/boxes/box_fit_kernel.h" // contract: the box of a transformed box
#include "kernels/boxes/fit.h"            // plain, and padded by its rounding
#include "kernels/boxes/obb_kernel.h"     // contract: two boxes in any pose
#include "kernels/boxes/sat.h"            // 15 directions, plain and certified

// Whether and when moving features touch
#include "kernels/continuous/continuous_kernel.h" // contract: points in linear motion
#include "kernels/continuous/cubic.h"             // roots of a cubic
#include "kernels/continuous/tight_inclusion.h"   // separating planes, no miss

// Convex shapes
#include "kernels/convex/contact.h"         // up to four points where two meet
#include "kernels/convex/first_contact.h"   // when two in motion first touch, between bounds
#include "kernels/convex/motion.h"          // rigid, along lines and screws
#include "kernels/convex/shapes.h"          // spheres, boxes, ... hulls; one of any kind
#include "kernels/convex/shared_point.h"    // of a triangle and a shape that touch
#include "kernels/convex/signed_distance.h" // distance or depth between bounds; yes or no
#include "kernels/convex/support.h"         // farthest points, extents, boxes of posed shapes
#include "kernels/convex/unit_flat.h"       // half-spaces and planes by a normal of length 1

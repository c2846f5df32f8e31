#pragma once

/// Trees of axis-aligned boxes.
///
///   boxes --builder--> Tree --layout--> BinaryLayout, WideLayout ... --traversal--> sink
///
/// A builder makes the canonical binary tree, a layout is a function of that tree alone, and a
/// traversal visits layouts and hands what it finds to a sink; an executor says on which threads.
/// Trees, answers and their order do not depend on the threads. README.md tells how to add one.
///
/// Floats must round to nearest and keep denormals, as when a program starts. Our executors see to
/// the latter in each body, whatever the mode of a thread. Who calls from a thread that flushes
/// denormals holds a DenormalFlushing(false) meanwhile (kernels/arithmetic/float_mode.h), or
/// answers about coordinates below 2^-126 may be wrong.

#include "trees/buffer.h"
#include "trees/builder.h"
#include "trees/builders/binned_sah.h"
#include "trees/builders/bonsai.h"
#include "trees/builders/hilbert.h"
#include "trees/builders/incremental.h"
#include "trees/builders/lbvh.h"
#include "trees/builders/median.h"
#include "trees/builders/ploc.h"
#include "trees/builders/spatial_sah.h"
#include "trees/builders/sweep_sah.h"
#include "trees/builders/top_down.h"
#include "trees/bvh.h"
#include "trees/device.h"
#include "trees/device_bvh.h"
#include "trees/device_graph.h"
#include "trees/device_memory.h"
#include "trees/device_mesh_bvh.h"
#include "trees/device_triangles.h"
#include "trees/device_worlds.h"
#include "trees/dynamic/dynamic_bvh.h"
#include "trees/dynamic/dynamic_tree.h"
#include "trees/dynamic/order_degradation.h"
#include "trees/dynamic/ray_refit.h"
#include "trees/dynamic/update.h"
#include "trees/executor.h"
#include "trees/executors/chunks.h"
#include "trees/function_ref.h"
#include "trees/inspect/draw.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/inspect/work.h"
#include "trees/layout.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/layouts.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/mesh_bvh.h"
#include "trees/optimizers/refit.h"
#include "trees/optimizers/reinsertion.h"
#include "trees/ordering/curve_codes.h"
#include "trees/ordering/curve_order.h"
#include "trees/ordering/ray_codes.h"
#include "trees/queries/allowed_collisions.h"
#include "trees/queries/answers.h"
#include "trees/queries/box_distance.h"
#include "trees/queries/box_queries.h"
#include "trees/queries/count_up_to.h"
#include "trees/queries/filters.h"
#include "trees/queries/nearest.h"
#include "trees/queries/points.h"
#include "trees/queries/rays.h"
#include "trees/queries/regions.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/sides.h"
#include "trees/queries/single_rays.h"
#include "trees/queries/sinks.h"
#include "trees/queries/sorted_rays.h"
#include "trees/queries/touching_pairs.h"
#include "trees/queries/tree_pairs.h"
#include "trees/tree.h"

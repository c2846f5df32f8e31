#pragma once

/// Trees of axis-aligned boxes.
///
///   boxes --builder--> Tree --layout--> BinaryLayout, WideLayout ... --traversal--> sink
///
/// A builder makes the canonical binary tree, a layout is a function of that tree alone, and a
/// traversal visits layouts and hands what it finds to a sink; an executor says on which threads.
/// Trees, answers and their order do not depend on the threads. README.md tells how to add one.

#include "trees/queries/allowed_collisions.h"
#include "trees/builder.h"
#include "trees/builders/binned_sah.h"
#include "trees/builders/bonsai.h"
#include "trees/builders/hilbert.h"
#include "trees/builders/incremental.h"
#include "trees/builders/lbvh.h"
#include "trees/builders/median.h"
#include "trees/builders/ploc.h"
#include "trees/builders/spatial_sah.h"
#include "trees/ordering/curve_order.h"
#include "trees/inspect/draw.h"
#include "trees/dynamic/dynamic_tree.h"
#include "trees/executor.h"
#include "trees/queries/filtered_pairs.h"
#include "trees/dynamic/detail/cached_pairs.h"
#include "trees/layout.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/queries/pairs.h"
#include "trees/inspect/quality.h"
#include "trees/optimizers/refit.h"
#include "trees/optimizers/reinsertion.h"
#include "trees/queries/touching_pairs.h"
#include "trees/queries/rays.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/sorted_rays.h"
#include "trees/queries/tree_pairs.h"
#include "trees/tree.h"
#include "trees/dynamic/update.h"
#include "trees/inspect/validate.h"
#include "trees/inspect/work.h"

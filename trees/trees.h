#pragma once

/// Trees of axis-aligned boxes.
///
///   boxes --builder--> Tree --layout--> BinaryLayout, WideLayout ... --traversal--> sink
///
/// A builder makes the canonical binary tree, a layout is a function of that tree alone, and a
/// traversal walks layouts and hands what it finds to a sink; an executor says on which threads.
/// Trees, answers and their order do not depend on the threads. README.md tells how to add one.

#include "trees/allowed_collisions.h"
#include "trees/builder.h"
#include "trees/builders/binned_sah.h"
#include "trees/builders/bonsai.h"
#include "trees/builders/hilbert.h"
#include "trees/builders/incremental.h"
#include "trees/builders/lbvh.h"
#include "trees/builders/median.h"
#include "trees/builders/ploc.h"
#include "trees/builders/spatial_sah.h"
#include "trees/curve_order.h"
#include "trees/draw.h"
#include "trees/dynamic_tree.h"
#include "trees/executor.h"
#include "trees/filtered_pairs.h"
#include "trees/kept_pairs.h"
#include "trees/layout.h"
#include "trees/layouts/binary.h"
#include "trees/layouts/packed.h"
#include "trees/layouts/quantised8.h"
#include "trees/layouts/wide.h"
#include "trees/pairs.h"
#include "trees/quality.h"
#include "trees/refit.h"
#include "trees/stages/reinsertion.h"
#include "trees/touching_pairs.h"
#include "trees/traversals/rays.h"
#include "trees/traversals/self_pairs.h"
#include "trees/traversals/sorted_rays.h"
#include "trees/traversals/tree_pairs.h"
#include "trees/tree.h"
#include "trees/update.h"
#include "trees/validate.h"
#include "trees/work.h"

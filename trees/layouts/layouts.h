#pragma once

#include <cstddef>
#include <cstdint>

/// The one list of layouts, by the traversals that serve them: X(name, type). The registry, the
/// declarations of all queries and the traversals themselves follow from it.
/// A new layout is its file, which ends in `LayoutEntry NAME_layout()`, and its name among
/// BOXWOOD_OWN_LAYOUTS; one in another list needs what the traversals of that list ask of it.

/// Nodes of two children and one item per leaf: traversals/binary_*.cpp.
#define BOXWOOD_BINARY_LAYOUTS(X) X(binary, BinaryLayout) X(binary_f64, BinaryLayoutF64)

/// Blocks that load as SIMD lanes, whose references lead to blocks: traversals/wide_*.cpp.
#define BOXWOOD_WIDE_LAYOUTS(X)                                                                    \
    X(wide4, Wide4Layout)                                                                          \
    X(wide8, Wide8Layout)                                                                          \
    X(wide16, Wide16Layout)                                                                        \
    X(quantised8, Quantised8Layout)                                                                \
    X(wide8_f64, Wide8LayoutF64)

/// As wide ones, but for pairs: traversals/packed_pairs.cpp.
#define BOXWOOD_PACKED_LAYOUTS(X) X(packed, PackedLayout)

/// Whose own files define the queries that they answer, any subset of the functions in queries/.
/// The type may be left unnamed here: X(name).
#define BOXWOOD_OWN_LAYOUTS(X)

#define BOXWOOD_LANE_LAYOUTS(X) BOXWOOD_WIDE_LAYOUTS(X) BOXWOOD_PACKED_LAYOUTS(X)
#define BOXWOOD_TRAVERSED_LAYOUTS(X) BOXWOOD_BINARY_LAYOUTS(X) BOXWOOD_LANE_LAYOUTS(X)
#define BOXWOOD_LAYOUTS(X) BOXWOOD_TRAVERSED_LAYOUTS(X) BOXWOOD_OWN_LAYOUTS(X)

/// What the queries of boxes search: these layouts, and DynamicTree as it stands.
#define BOXWOOD_BINARY_TREES(X) BOXWOOD_BINARY_LAYOUTS(X) X(dynamic, DynamicTree)
#define BOXWOOD_SEARCHED_TREES(X) BOXWOOD_TRAVERSED_LAYOUTS(X) X(dynamic, DynamicTree)

namespace boxwood {

/// The layouts by name, in the order of layouts() (trees/layout.h).
enum class LayoutName : std::uint8_t {
#define X(name, ...) name,
    BOXWOOD_LAYOUTS(X)
#undef X
};

template <class Real> class BinaryLayoutOf;
template <class Real, std::size_t W> class WideLayout;
class DynamicTree;
class PackedLayout;
class Quantised8Layout;

using BinaryLayout = BinaryLayoutOf<float>;
using BinaryLayoutF64 = BinaryLayoutOf<double>;
using Wide4Layout = WideLayout<float, 4>;
using Wide8Layout = WideLayout<float, 8>;
using Wide16Layout = WideLayout<float, 16>;
using Wide8LayoutF64 = WideLayout<double, 8>;

} // namespace boxwood

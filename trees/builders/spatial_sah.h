#pragma once

#include "trees/builder.h"

#include <array>

namespace boxwood {

/// `binned_sah` for rays: triangles that fill little of a large box are cut first, and each part
/// gets a leaf of its own with the box of the part, so that long and slanted ones cost rays less at
/// the cost of more leaves. A triangle is cut the more often the emptier its box, along planes
/// that halve the cube around the mesh again and again, so that neighbours part alike. None is cut
/// that fills more than a little of its box or is small among the others. Items count in blocks of
/// 8. Boxes alone cannot be cut: `build` gives the tree of binned_sah with that. O(n log n).
/// Source: Karras and Aila 2013, "Fast Parallel Construction of High-Quality Bounding Volume
/// Hierarchies", section 4; Ernst and Greiner 2007, "Early Split Clipping for Bounding Volume
/// Hierarchies".
struct SpatialSahBuilder {
    static constexpr std::string_view name = "spatial_sah";
    static constexpr std::string_view summary =
        "cuts triangles with large, empty boxes first, then binned_sah; for rays (Karras 2013)";

    double references = 2; ///< leaves per triangle at most, over the whole mesh

    static auto settings() {
        return std::array{Setting<SpatialSahBuilder>("references",
                                                     "leaves per triangle at most, over the mesh",
                                                     &SpatialSahBuilder::references, 1, 16)};
    }

    Tree build(Boxes boxes, const Executor& executor) const;
    /// A split tree (see Tree).
    Tree build_of_mesh(const TriangleMesh& mesh, const Executor& executor) const;
};

} // namespace boxwood

#pragma once

#include "trees/executor.h"
#include "trees/tree.h"

#include <cstdint>
#include <vector>

namespace boxwood::detail {

/// x, y, z and a lane that holds something else (GCC and Clang vector types).
using Float4 = float __attribute__((vector_size(16), may_alias));
using Int4 = std::int32_t __attribute__((vector_size(16)));

/// A node on its way to a better place: 32 bytes, siblings side by side in one cache line. The
/// children of node i are nodes `below` and `below` + 1; a node of odd index stands right.
/// Node 0 is the root and node 1 is unused.
struct alignas(32) Link {
    float min[3];
    std::uint32_t below; ///< first child, or leaf_bit and the node of the tree that it came from
    float max[3];
    std::uint32_t above; ///< parent

    static constexpr std::uint32_t leaf_bit = 0x80000000u;
    bool is_leaf() const { return (below & leaf_bit) != 0; }
};
static_assert(sizeof(Link) == 32);

inline Float4 load(const float* p) { return *reinterpret_cast<const Float4*>(p); }
inline Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max4(Float4 a, Float4 b) { return a > b ? a : b; }

/// Bounds; the fourth lanes hold no coordinates.
struct Bounds4 {
    Float4 min, max;

    explicit Bounds4(const Link& link) : min(load(link.min)), max(load(link.max)) {}
    Bounds4(Float4 low, Float4 high) : min(low), max(high) {}
    Bounds4 with(const Bounds4& b) const { return {min4(min, b.min), max4(max, b.max)}; }
    /// Half area: x y + y z + z x. The fourth lane is not touched: it may be slow (denormal).
    float area() const {
        const Float4 d = max - min;
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
    }
    double exact_area() const {
        const Float4 d = max - min;
        const double x = static_cast<double>(d[0]), y = static_cast<double>(d[1]),
                     z = static_cast<double>(d[2]);
        return x * y + y * z + z * x;
    }
    bool same(const Bounds4& b) const {
        const Int4 equal = (min == b.min) & (max == b.max);
        return (equal[0] & equal[1] & equal[2]) != 0;
    }
};

/// The nodes of a tree with pointers up and down, so that they can change places, and back again
/// into a canonical tree. The same on every executor.
class LinkedTree {
  public:
    /// Of two or more items; keeps a reference to the tree.
    /// Coordinates are scaled by a power of two so that the widest extent lies near 1: then no area
    /// over- or underflows that matters. They serve to choose; the result has the old boxes.
    LinkedTree(const Tree& tree, const Executor& executor);

    /// The links in depth-first order, as the canonical tree wants them.
    Tree canonical() const;

  protected:
    Bounds4 bounds(std::uint32_t i) const { return Bounds4(links_[i]); }
    void set_bounds(std::uint32_t i, const Bounds4& b) {
        for (int k = 0; k < 3; ++k) {
            links_[i].min[k] = b.min[k];
            links_[i].max[k] = b.max[k];
        }
    }

    const Tree& tree_;
    const Executor& executor_;
    Buffer<Link> links_;

  private:
    std::vector<std::uint32_t> cut() const;
    std::uint32_t leaves_below(std::uint32_t root) const;
    void write(std::uint32_t root, std::uint32_t node, std::uint32_t slot, Tree& made) const;
};

} // namespace boxwood::detail

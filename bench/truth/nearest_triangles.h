#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace boxwood::bench {

/// No two points of the boxes are nearer.
double gap_of(const Aabb<double>& a, const Aabb<double>& b);

/// The least distance of two sets of triangles, for judges: boxes of halves in doubles leave out
/// what cannot be nearest, and rationals decide on the rest. Nothing of trees/ is in it.
class NearestTriangles {
  public:
    explicit NearestTriangles(std::span<const Triangle<double>> triangles);

    /// Where the same triangles are now: the halves stay.
    void move(std::span<const Triangle<double>> triangles);

    struct Least {
        double distance; ///< rounded from the exact one of some pair
        double lo;       ///< none is nearer
    };
    /// lo is at least distance (1 - 2^-40). at_most if they are farther apart, or a set is empty.
    Least to(const NearestTriangles& other,
             double at_most = std::numeric_limits<double>::infinity()) const;

  private:
    class Search;
    struct Node {
        Aabb<double> box;
        std::uint32_t begin, end; ///< of order_
        std::uint32_t right = 0;  ///< the left child is the next node; 0: a leaf
    };
    std::uint32_t split(std::uint32_t begin, std::uint32_t end);
    void fit();

    std::vector<Triangle<double>> triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace boxwood::bench

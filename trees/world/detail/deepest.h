#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/vec3.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

/// How deep something goes into something else, by branch and bound: pieces of its surface are
/// split, the one that may be the deepest first. No point of a piece is deeper than its middle by
/// more than its radius, as a depth changes no faster than a point moves.
namespace boxwood::detail {

/// How deep a point lies inside, between bounds; below 0 outside.
struct Depth {
    double lo, hi;
};

/// A piece of a triangle.
struct TrianglePiece {
    std::array<Vec3<double>, 3> corners;

    Vec3<double> middle() const { return (1. / 3) * (corners[0] + corners[1] + corners[2]); }
    double radius() const {
        double radius = 0;
        for (const Vec3<double>& corner : corners)
            radius = std::max(radius, length(corner - middle()));
        return radius * (1 + 0x1p-40);
    }
    template <class F> void split(const F& f) const {
        const auto& [a, b, c] = corners;
        const Vec3<double> ab = .5 * (a + b), bc = .5 * (b + c), ca = .5 * (c + a);
        f(TrianglePiece{{a, ab, ca}});
        f(TrianglePiece{{ab, b, bc}});
        f(TrianglePiece{{ca, bc, c}});
        f(TrianglePiece{{ab, bc, ca}});
    }
};

/// What of a surface lies in a box.
struct CellPiece {
    Aabb<double> box;

    Vec3<double> middle() const { return .5 * (box.min + box.max); }
    double radius() const { return .5 * length(box.max - box.min) * (1 + 0x1p-40); }
    template <class F> void split(const F& f) const {
        const Vec3<double> sides = box.max - box.min;
        const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
        CellPiece low = *this, high = *this;
        low.box.max[axis] = high.box.min[axis] = middle()[axis];
        f(low);
        f(high);
    }
};

class Deepest {
  public:
    explicit Deepest(double tolerance) : tolerance_(tolerance) {}

    /// What is known of a piece: no point of it is deeper than `hi`, and `point` of the surface is
    /// at least `lo` deep. error: what bounds of depths lack; a smaller piece is not split.
    struct Measured {
        double lo, hi;
        Vec3<double> point;
        double error;
    };
    /// measure(piece): Measured. More than four million pieces: the bounds are wide, and true.
    template <class Piece, class Measure>
    void look(const std::vector<Piece>& first, const Measure& measure) {
        struct Waiting {
            double hi;
            Piece piece;
        };
        std::vector<Waiting> waiting;
        const auto add = [&](const Piece& piece) {
            const Measured found = measure(piece);
            if (found.lo > lo_) {
                lo_ = found.lo;
                point_ = found.point;
            }
            if (!(found.hi > lo_))
                return;
            // Nor one of a few units in the last place, whose halves are as large.
            if (piece.radius() <= std::max(found.error, 0x1p-48 * length(piece.middle()))) {
                hi_ = std::max(hi_, found.hi);
                return;
            }
            waiting.push_back({found.hi, piece});
            std::ranges::push_heap(waiting, {}, &Waiting::hi);
        };
        for (const Piece& piece : first)
            add(piece);
        for (std::size_t n = 0; !waiting.empty() && n < 4'000'000; ++n) {
            if (waiting.front().hi <= lo_ + tolerance_)
                break;
            std::ranges::pop_heap(waiting, {}, &Waiting::hi);
            const Piece piece = waiting.back().piece;
            waiting.pop_back();
            piece.split(add);
        }
        if (!waiting.empty())
            hi_ = std::max(hi_, waiting.front().hi);
        hi_ = std::max(hi_, lo_);
    }

    /// Of all that was looked at; at least 0.
    double lo() const { return lo_; }
    double hi() const { return hi_; }
    const Vec3<double>& point() const { return point_; } ///< as deep as lo

  private:
    double tolerance_, lo_ = 0, hi_ = 0;
    Vec3<double> point_{};
};

} // namespace boxwood::detail

/// Eight lanes of doubles. With u = 2^-53, S = |c - at|_1 + reach + size, c and reach of the block
/// or leaf: a difference from `at` is off by uS, its height along an axis by 4uS in all, a cosine
/// by 3u, the reach along a direction of length 1 by 12uS, sums of these by 2uS more; the root of
/// three squares of gaps makes sqrt(3) of that. A direction n that is computed is as good as any:
/// n . p of a triangle's moved corners and the reach along n are off by 26u |n| S, and |n| by 3u of
/// itself; less than 1e-100 counts as that, so that squares that underflow say nothing. All are
/// below 32u S. What the rotation lacks of being one, d its greatest entry |R R^T - 1|, itself off
/// by 4u: lengths change by 1.5 d, the shape's own points by 3 d; 8 (d + 4u) leaves room.

// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/world/detail/shape_bounds.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/convex/support.h"
#include "kernels/convex/unit_flat.h"
#include "kernels/primitives/rotation.h"
#include "trees/world/detail/shape_bounds.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<double, 8> d8;
using D8 = hn::Vec<decltype(d8)>;

HWY_INLINE D8 doubles(const float* from) {
    return hn::PromoteTo(d8, hn::LoadU(hn::Rebind<float, decltype(d8)>(), from));
}
HWY_INLINE D8 dot(const Vec3<double>& n, const D8 (&p)[3]) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d8, n.x), p[0]), hn::Mul(hn::Set(d8, n.y), p[1])),
                   hn::Mul(hn::Set(d8, n.z), p[2]));
}
HWY_INLINE D8 dot(const D8 (&n)[3], const D8 (&p)[3]) {
    return hn::Add(hn::Add(hn::Mul(n[0], p[0]), hn::Mul(n[1], p[1])), hn::Mul(n[2], p[2]));
}
HWY_INLINE D8 least(const D8 (&x)[3]) { return hn::Min(hn::Min(x[0], x[1]), x[2]); }
HWY_INLINE D8 greatest(const D8 (&x)[3]) { return hn::Max(hn::Max(x[0], x[1]), x[2]); }

/// How far the envelope, without its radius, reaches from its middle along n and against it, times
/// |n|; n in its frame.
struct Reach {
    D8 forwards, backwards;

    HWY_INLINE Reach(const Envelope& e, const D8 (&n)[3]) {
        if (e.form == Envelope::Form::points) {
            forwards = backwards = hn::Set(d8, -0x1p1000);
            for (const Vec3<double>& p : e.points) {
                const D8 along = dot(p + e.shift, n);
                forwards = hn::Max(forwards, along);
                backwards = hn::Max(backwards, hn::Neg(along));
            }
            return;
        }
        const D8 x = hn::Mul(hn::Set(d8, e.half[0]), n[0]),
                 y = hn::Mul(hn::Set(d8, e.half[1]), n[1]),
                 z = hn::Mul(hn::Set(d8, e.half[2]), n[2]);
        if (e.form == Envelope::Form::box) {
            forwards = backwards = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
            return;
        }
        const D8 across = hn::Add(hn::Mul(x, x), hn::Mul(y, y));
        if (e.form == Envelope::Form::cylinder) {
            forwards = backwards = hn::Add(hn::Sqrt(across), hn::Abs(z));
        } else if (e.form == Envelope::Form::cone) { // its apex, or its base
            const D8 base = hn::Sqrt(across);
            forwards = hn::Max(z, hn::Sub(base, z));
            backwards = hn::Max(hn::Neg(z), hn::Add(base, z));
        } else {
            forwards = backwards = hn::Sqrt(hn::Add(across, hn::Mul(z, z)));
        }
    }
    /// The gap to what lies from low to high along n.
    HWY_INLINE D8 gap_to(D8 low, D8 high) const {
        return hn::Max(hn::Sub(low, forwards), hn::Sub(hn::Neg(high), backwards));
    }
};

/// height / |n|; of short directions nearer to 0.
HWY_INLINE D8 over_length(D8 height, const D8 (&n)[3]) {
    return hn::Div(height, hn::Max(hn::Sqrt(dot(n, n)), hn::Set(d8, 1e-100)));
}

/// Gaps along single directions, and squares of those along three that are at right angles.
struct Gaps {
    D8 greatest, squares;

    HWY_INLINE Gaps() : greatest(hn::Set(d8, -0x1p1000)), squares(hn::Zero(d8)) {}
    HWY_INLINE void add(D8 gap) { greatest = hn::Max(greatest, gap); }
    HWY_INLINE void add_square(D8 gap) {
        add(gap);
        const D8 positive = hn::Max(gap, hn::Zero(d8));
        squares = hn::Add(squares, hn::Mul(positive, positive));
    }
};
HWY_INLINE D8 bound_of(const Gaps& gaps) {
    const D8 root = hn::Sqrt(gaps.squares);
    return hn::IfThenElse(hn::Gt(root, hn::Zero(d8)), hn::Max(root, gaps.greatest), gaps.greatest);
}

bool is_round(const Envelope& e) {
    return e.form == Envelope::Form::cylinder || e.form == Envelope::Form::cone;
}

double error_of(const Envelope& e, const PosedBox& own, double around) {
    const double apart = std::abs(own.centre[0] - e.at.x) + std::abs(own.centre[1] - e.at.y) +
                         std::abs(own.centre[2] - e.at.z);
    return (e.relative_error * (apart + around + e.size) + e.own_error) * (1 + 0x1p-40);
}

/// Of what reaches from low to high along the normal of a half-space or plane.
HWY_INLINE D8 flat_bound(const Envelope& e, D8 low, D8 high) {
    return e.form == Envelope::Form::plane ? hn::Max(low, hn::Neg(high)) : low;
}

/// The lanes [i, i + Lanes(d8)) of a block.
struct Boxes {
    D8 apart[3], axis[3][3], half[3], slack;

    HWY_INLINE Boxes(const Envelope& e, const ObbBlock& block, std::size_t i)
        : slack(doubles(block.slack + i)) {
        for (std::size_t k = 0; k < 3; ++k) {
            apart[k] = hn::Sub(hn::LoadU(d8, block.centre_f64[k] + i),
                               hn::Set(d8, e.at[static_cast<int>(k)]));
            half[k] = doubles(block.half[k] + i);
            for (std::size_t component = 0; component < 3; ++component)
                axis[k][component] = doubles(block.axis[k][component] + i);
        }
    }

    HWY_INLINE D8 flat(const Envelope& e) const {
        D8 around = slack;
        for (std::size_t k = 0; k < 3; ++k)
            around = hn::Add(around, hn::Mul(hn::Abs(dot(e.normal, axis[k])), half[k]));
        const D8 height = hn::Sub(dot(e.normal, apart), hn::Set(d8, e.offset));
        return flat_bound(e, hn::Sub(height, around), hn::Add(height, around));
    }

    HWY_INLINE D8 bounded(const Envelope& e) const {
        D8 cosine[3][3], way[3]; // of the boxes' axes, and `apart`, along the shape's
        for (std::size_t k = 0; k < 3; ++k) {
            way[k] = dot(e.axis[k], apart);
            for (std::size_t j = 0; j < 3; ++j)
                cosine[j][k] = dot(e.axis[k], axis[j]);
        }
        Gaps of_shape, of_boxes;
        D8 along_z = hn::Zero(d8);
        for (std::size_t k = 0; k < 3; ++k) {
            D8 around = hn::Add(slack, hn::Set(d8, e.half[k]));
            for (std::size_t j = 0; j < 3; ++j)
                around = hn::Add(around, hn::Mul(hn::Abs(cosine[j][k]), half[j]));
            along_z = hn::Sub(hn::Abs(way[k]), around); // at last
            of_shape.add_square(along_z);
        }
        if (is_round(e)) {
            const D8 out[3] = {way[0], way[1], hn::Zero(d8)};
            D8 height = dot(out, out);
            for (std::size_t j = 0; j < 3; ++j)
                height = hn::Sub(height, hn::Mul(hn::Abs(dot(out, cosine[j])), half[j]));
            Gaps of_rounding;
            of_rounding.add_square(along_z);
            of_rounding.add_square(
                hn::Sub(over_length(height, out), hn::Add(slack, hn::Set(d8, e.half[0]))));
            of_shape.squares = hn::Max(of_shape.squares, of_rounding.squares);
            of_shape.add(of_rounding.greatest);
        }
        D8 between = dot(apart, apart);
        for (std::size_t j = 0; j < 3; ++j) {
            const D8 along = dot(axis[j], apart);
            const D8 gap =
                Reach(e, cosine[j]).gap_to(hn::Sub(along, half[j]), hn::Add(along, half[j]));
            // Over the axis' length: with e = |axis|^2 - 1, less than 2^-21, 1 - e / 2 is below
            // 1 / |axis| by at most 3/8 e^2.
            const D8 squared = dot(axis[j], axis[j]);
            of_boxes.add_square(
                hn::Mul(gap, hn::Sub(hn::Set(d8, 1.5), hn::Mul(hn::Set(d8, 0.5), squared))));
            between = hn::Sub(between, hn::Mul(half[j], hn::Abs(along)));
        }
        // Axes of floats are at right angles to 3 * 3.5 * 2^-24.
        of_boxes.squares = hn::Mul(of_boxes.squares, hn::Set(d8, 1 - 0x1p-19));
        of_boxes.add(hn::Sub(over_length(hn::Sub(between, Reach(e, way).forwards), apart), slack));
        return hn::Sub(hn::Max(bound_of(of_shape), bound_of(of_boxes)), hn::Set(d8, e.radius));
    }
};

void boxes(const Envelope& e, const ObbBlock& block, double* bounds) {
    const D8 error = hn::Set(d8, error_of(e, block.own, double{block.own.reach}));
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
        const Boxes lanes(e, block, i);
        const D8 bound = e.is_flat() ? lanes.flat(e) : lanes.bounded(e);
        hn::StoreU(hn::Sub(bound, error), d8, bounds + i);
    }
}

/// The lanes [i, i + Lanes(d8)) of a leaf: corners from `at`.
struct Triangles {
    D8 corner[3][3];

    HWY_INLINE Triangles(const Envelope& e, const TriangleLeaf& leaf, std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                corner[k][axis] = hn::Sub(doubles(leaf.corner[k][axis] + i),
                                          hn::Set(d8, e.at[static_cast<int>(axis)]));
    }

    HWY_INLINE D8 flat(const Envelope& e) const {
        D8 height[3];
        for (std::size_t k = 0; k < 3; ++k)
            height[k] = hn::Sub(dot(e.normal, corner[k]), hn::Set(d8, e.offset));
        return flat_bound(e, least(height), greatest(height));
    }

    HWY_INLINE D8 bounded(const Envelope& e) const {
        D8 p[3][3]; // corners along the shape's axes
        Gaps gaps, of_rounding;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            D8 along[3];
            for (std::size_t k = 0; k < 3; ++k)
                p[k][axis] = along[k] = dot(e.axis[axis], corner[k]);
            const D8 half = hn::Set(d8, e.half[axis]);
            const D8 gap =
                hn::Max(hn::Sub(least(along), half), hn::Sub(hn::Neg(greatest(along)), half));
            gaps.add_square(gap);
            if (axis == 2)
                of_rounding.add_square(gap);
        }
        D8 edge[2][3], normal[3], middle[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            edge[0][axis] = hn::Sub(p[1][axis], p[0][axis]);
            edge[1][axis] = hn::Sub(p[2][axis], p[0][axis]);
            middle[axis] = hn::Add(hn::Add(p[0][axis], p[1][axis]), p[2][axis]);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t y = (axis + 1) % 3, z = (axis + 2) % 3;
            normal[axis] =
                hn::Sub(hn::Mul(edge[0][y], edge[1][z]), hn::Mul(edge[0][z], edge[1][y]));
        }
        const D8 square[3] = {dot(normal, p[0]), dot(normal, p[1]), dot(normal, p[2])};
        gaps.add(over_length(Reach(e, normal).gap_to(least(square), greatest(square)), normal));
        const D8 towards[3] = {dot(middle, p[0]), dot(middle, p[1]), dot(middle, p[2])};
        gaps.add(over_length(hn::Sub(least(towards), Reach(e, middle).forwards), middle));
        if (is_round(e)) {
            const D8 out[3] = {middle[0], middle[1], hn::Zero(d8)};
            const D8 beside[3] = {dot(out, p[0]), dot(out, p[1]), dot(out, p[2])};
            of_rounding.add_square(
                hn::Sub(over_length(least(beside), out), hn::Set(d8, e.half[0])));
            gaps.squares = hn::Max(gaps.squares, of_rounding.squares);
            gaps.add(of_rounding.greatest);
        }
        return hn::Sub(bound_of(gaps), hn::Set(d8, e.radius));
    }
};

void triangles(const Envelope& e, const TriangleLeaf& leaf, double* bounds) {
    // |corner - centre|_1 is at most 1.8 times the sum of halves, which own.reach is.
    const D8 error = hn::Set(d8, error_of(e, leaf.own, 2 * double{leaf.own.reach}));
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
        const Triangles lanes(e, leaf, i);
        const D8 bound = e.is_flat() ? lanes.flat(e) : lanes.bounded(e);
        hn::StoreU(hn::Sub(bound, error), d8, bounds + i);
    }
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {

HWY_EXPORT(boxes);
HWY_EXPORT(triangles);

void bound_boxes(const Envelope& shape, const ObbBlock& block, double (&bounds)[8]) {
    HWY_DYNAMIC_DISPATCH(boxes)(shape, block, bounds);
}
void bound_triangles(const Envelope& shape, const TriangleLeaf& leaf, double (&bounds)[8]) {
    HWY_DYNAMIC_DISPATCH(triangles)(shape, leaf, bounds);
}

namespace {

double sum_of_sizes(const Vec3<double>& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

void check(const Pose& pose) {
    const auto& [r0, r1, r2] = pose.rotation;
    if (!is_finite(r0) || !is_finite(r1) || !is_finite(r2) || !is_finite(pose.translation))
        throw std::invalid_argument("a pose has a number that is not finite");
    if (!(distance_from_orthonormal(pose.rotation) <= 0x1p-12))
        throw std::invalid_argument("a pose is no rigid transform: its matrix is off a rotation by "
                                    "more than 2^-12 (see checked_pose)");
}

} // namespace

Envelope::Envelope(const convex::Shape& shape, const Pose& pose) : at(pose.translation) {
    check(pose);
    const auto& [r0, r1, r2] = pose.rotation;
    axis[0] = {r0.x, r1.x, r2.x};
    axis[1] = {r0.y, r1.y, r2.y};
    axis[2] = {r0.z, r1.z, r2.z};
    Vec3<double> middle{}, halves{};
    shape.visit([&]<class S>(const S& s) {
        if constexpr (std::is_same_v<S, convex::Sphere>) {
            radius = s.radius;
        } else if constexpr (std::is_same_v<S, convex::Capsule>) {
            radius = s.radius;
            halves = {0, 0, s.half_length};
        } else if constexpr (std::is_same_v<S, convex::Box>) {
            halves = s.half;
        } else if constexpr (std::is_same_v<S, convex::Cylinder> ||
                             std::is_same_v<S, convex::Cone>) {
            form = std::is_same_v<S, convex::Cone> ? Form::cone : Form::cylinder;
            halves = {s.radius, s.radius, s.half_length};
        } else if constexpr (std::is_same_v<S, convex::Ellipsoid>) {
            form = Form::ellipsoid;
            halves = s.radii;
        } else if constexpr (!convex::BoundedShape<S>) {
            form = std::is_same_v<S, convex::Plane> ? Form::plane : Form::half_space;
            const auto flat = convex::unit_flat(s);
            offset = flat.offset;
            for (int k = 0; k < 3; ++k)
                normal = normal + flat.normal[k] * axis[k];
        } else {
            form = Form::points;
            if constexpr (std::is_same_v<S, convex::Hull>) {
                points = s.points();
            } else {
                corners_ = {s.a, s.b, s.c};
                points = corners_;
            }
            const Aabb<double> box = convex::bounds(shape, Pose{});
            middle = 0.5 * (box.min + box.max);
            halves = (1 + 0x1p-50) * max(box.max - middle, middle - box.min);
        }
    });
    for (int k = 0; k < 3; ++k) {
        half[k] = halves[k];
        at = at + middle[k] * axis[k];
    }
    shift = -middle;
    size = (half[0] + half[1] + half[2] + radius + std::abs(offset)) * (1 + 0x1p-50);
    const bool is_negative = half[0] < 0 || half[1] < 0 || half[2] < 0 || radius < 0;
    const double all =
        size + sum_of_sizes(middle) + sum_of_sizes(pose.translation) + sum_of_sizes(normal);
    if (is_negative || !(all <= 0x1p90))
        throw std::invalid_argument("a convex shape has a length that is negative or not finite, "
                                    "or lies or reaches beyond 2^90");
    relative_error = 0x1p-47 + 8 * distance_from_orthonormal(pose.rotation);
    if (middle != Vec3<double>{}) // rounded when it was moved
        own_error = 0x1p-49 * (sum_of_sizes(middle) + sum_of_sizes(pose.translation));
}

} // namespace boxwood::detail
#endif

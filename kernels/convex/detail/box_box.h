#pragma once

#include "kernels/convex/detail/gjk.h"
#include "kernels/features/segment_segment.h"

/// Two boxes by the 15 directions that can separate them: the normals of their faces, and the cross
/// products of their edges. If they overlap, the greatest gap is the signed distance, as the faces
/// of the difference of two boxes have no other normals.
namespace boxwood::convex::detail {

enum class Touch : std::uint8_t { face_of_a, face_of_b, edges };

/// The greatest gap, and bounds of what it would be without rounding but that of distance_error.
struct BoxGaps {
    double gap = -inf, hi = inf;
    Vec3<double> normal{0, 0, 1}; ///< in a's frame, from a to b
    Touch touch = Touch::face_of_a;
    int edge_a = 0, edge_b = 0; ///< the axes of edges that touch
};

/// Stops at the first gap of more than `enough`, with hi unknown.
/// Edges i and j that are nearly parallel, their cross product s long: the direction is off by
/// (16u + lack) / s, and its gap by size times that. Or it is left out: with b's edge replaced by
/// a's, s away, it bounds nothing, while the other gaps move by less than 5 (s + lack + 10u) size
/// (the same as in boxes/sat.h). hi takes the better of the two.
inline BoxGaps box_gaps(const Box& a, const Box& b, const RelativePose& b_in_a, double size,
                        double enough) {
    const Rows& r = b_in_a.rotation;
    const Vec3<double> t = b_in_a.translation;
    Rows q;
    for (std::size_t i = 0; i < 3; ++i)
        q[i] = {std::abs(r[i].x), std::abs(r[i].y), std::abs(r[i].z)};
    BoxGaps best;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
        const double gap =
            std::abs(t[i]) - (a.half[i] + dot(q[static_cast<std::size_t>(i)], b.half));
        if (gap > best.gap) {
            best.gap = gap, best.touch = Touch::face_of_a;
            best.normal = {};
            best.normal[i] = std::copysign(1.0, t[i]);
            if (gap > enough)
                return best;
        }
    }
    const Vec3<double> back = b_in_a.rotated_back(t), reach_a = transposed_times(q, a.half);
#pragma GCC unroll 3
    for (int j = 0; j < 3; ++j) {
        const double gap = std::abs(back[j]) - (b.half[j] + reach_a[j]);
        if (gap > best.gap) {
            best.gap = gap, best.touch = Touch::face_of_b;
            best.normal = Vec3<double>{r[0][j], r[1][j], r[2][j]} * std::copysign(1.0, back[j]);
            if (gap > enough)
                return best;
        }
    }
    double left_out = -1, hi = best.gap;
    const double vague = (16 * u + b_in_a.lack) * size;
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i)
#pragma GCC unroll 3
        for (int j = 0; j < 3; ++j) {
            const int i1 = i == 2 ? 0 : i + 1, i2 = i == 0 ? 2 : i - 1;
            const int j1 = j == 2 ? 0 : j + 1, j2 = j == 0 ? 2 : j - 1;
            const auto rij = [&](int k) { return r[static_cast<std::size_t>(k)][j]; };
            const auto qij = [&](int k, int l) { return q[static_cast<std::size_t>(k)][l]; };
            const double squared = rij(i1) * rij(i1) + rij(i2) * rij(i2);
            if (squared < 0x1p-52) { // s < 2^-26: leaving it out is the better
                left_out = std::max(left_out, squared);
                continue;
            }
            const double along = t[i2] * rij(i1) - t[i1] * rij(i2);
            const double halves = a.half[i1] * qij(i2, j) + a.half[i2] * qij(i1, j) +
                                  b.half[j1] * qij(i, j2) + b.half[j2] * qij(i, j1);
            const double longest = std::abs(along) - halves, at_most = longest + vague;
            // Below best.gap for sure, which is found without the root.
            if (at_most < 0 && (best.gap >= 0 || at_most * at_most > best.gap * best.gap * squared))
                continue;
            const double scale = 1 / std::sqrt(squared);
            const double gap = longest * scale;
            hi = std::max(hi, at_most * scale);
            if (gap > best.gap) {
                Vec3<double> n{};
                n[i1] = -rij(i2) * scale, n[i2] = rij(i1) * scale;
                best.gap = gap, best.touch = Touch::edges;
                best.edge_a = i, best.edge_b = j;
                best.normal = n * std::copysign(1.0, along);
                if (gap > enough)
                    return best;
            }
        }
    if (left_out >= 0)
        hi += 5 * (std::sqrt(left_out) + b_in_a.lack) * size;
    best.hi = hi;
    return best;
}

/// Boxes that overlap, with best.normal the way out: the point of a that touches b when that has
/// been moved out. Nothing if it takes a search.
inline bool touching_point(const Box& a, const Box& b, const RelativePose& b_in_a,
                           const BoxGaps& best, Vec3<double>& on_a) {
    const double slack = 0x1p-40 * (reach(a) + reach(b));
    const Vec3<double> n = best.normal;
    const auto inside = [&](Vec3<double> p, const Box& box) {
        return std::abs(p.x) <= box.half.x + slack && std::abs(p.y) <= box.half.y + slack &&
               std::abs(p.z) <= box.half.z + slack;
    };
    switch (best.touch) {
    case Touch::face_of_a:
        on_a = b_in_a(support(b, b_in_a.rotated_back(-n))) - n * best.gap;
        return inside(on_a, a);
    case Touch::face_of_b:
        on_a = support(a, n);
        return inside(b_in_a.rotated_back((on_a + n * best.gap) - b_in_a.translation), b);
    case Touch::edges:
        break;
    }
    const auto edge = [](Vec3<double> corner, int axis) {
        Vec3<double> other = corner;
        other[axis] = -corner[axis];
        return Segment<double>{corner, other};
    };
    const Segment<double> of_a = edge(support(a, n), best.edge_a),
                          of_b = edge(support(b, b_in_a.rotated_back(-n)), best.edge_b);
    const Vec3<double> out = n * best.gap;
    const auto near = nearest_on_segments<true>(
        of_a, Segment<double>{b_in_a(of_b.a) - out, b_in_a(of_b.b) - out});
    on_a = near.a;
    return length(near.offset) <= slack;
}

} // namespace boxwood::convex::detail

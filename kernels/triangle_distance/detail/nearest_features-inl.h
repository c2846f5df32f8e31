// Not a header of its own: included inside a namespace that has said what a lane vector V is. Once
// for plain numbers (one_lane.h), and once per instruction set (features_batch.cpp).
// V: + - * / unary-, < and <= to a mask; constant<V>(x), select(mask, x, y), min, max, abs,
// both(m, m), either(m, m), negation(m), any(m), all(m), reciprocals(V (&x)[3]), and Limits<V>.
// BOXWOOD_LANE: how its functions are declared.

#include "kernels/triangle_distance/detail/facing_edges-inl.h"

/// Where the other triangle's corners lie to a face: their signed heights times |normal|.
template <class V> struct Heights {
    V of[3];

    /// Whether all are on one side, or not beyond rounding on the other: the squares of smaller
    /// ones are below `noise`.
    BOXWOOD_LANE auto apart(V noise) const {
        const V lowest = min(min(of[0], of[1]), of[2]), highest = max(max(of[0], of[1]), of[2]);
        const V zero = constant<V>(0), below = min(lowest, zero), above = max(highest, zero);
        return either(below * below <= noise, above * above <= noise);
    }
};

/// The foot of x in the plane of a face, both seen from its first corner. scale: 1 / |normal|^2.
template <class V>
BOXWOOD_LANE Weights<V> foot_of(const LaneVec3<V>& x, const Shape<V>& face,
                                const LaneVec3<V>& normal, V scale) {
    return {dot(cross(x, face.edge[1]), normal) * scale,
            dot(cross(face.edge[0], x), normal) * scale};
}
template <class V> BOXWOOD_LANE auto inside(const Weights<V>& w) {
    const V zero = constant<V>(0);
    return both(both(zero <= w.u, zero <= w.v), w.u + w.v <= constant<V>(1));
}

/// Of corners on one side of a face's plane only the nearest can be nearest to the face's inside.
/// Offers it if its foot is inside; then nothing else is nearer, and the lane is done if the
/// triangle is no sliver. x: the corners, from the face's first one.
template <bool face_is_a, bool again, class M, class V>
BOXWOOD_LANE M offer_nearest_corner(M apart, const Shape<V>& face, const LaneVec3<V>& normal,
                                    V inverse_squares, V inverse_sine_squared, const Heights<V>& h,
                                    const LaneVec3<V>& x0, const LaneVec3<V>& x1,
                                    const LaneVec3<V>& x2, Best<V>& best) {
    const V zero = constant<V>(0), one = constant<V>(1);
    const V h0 = abs(h.of[0]), h1 = abs(h.of[1]), h2 = abs(h.of[2]);
    const auto second = h1 < h0, third = h2 < min(h0, h1);
    const LaneVec3<V> x = select(third, x2, select(second, x1, x0));
    const V scale = inverse_squares * inverse_sine_squared; // 1 / |normal|^2
    Weights<V> foot = foot_of(x, face, normal, scale);
    LaneVec3<V> offset = (x - foot.u * face.edge[0]) - foot.v * face.edge[1];
    if constexpr (again) { // of what is left: the foot is off by about u / sin of the angle
        const Weights<V> rest = foot_of(offset, face, normal, scale);
        foot = {foot.u + rest.u, foot.v + rest.v};
        offset = (offset - rest.u * face.edge[0]) - rest.v * face.edge[1];
    }
    const M found = both(apart, inside(foot));
    const Weights<V> corner{select(third, zero, select(second, one, zero)),
                            select(third, one, zero)};
    if constexpr (face_is_a)
        best.offer(found, dot(offset, offset), foot, corner);
    else
        best.offer(found, dot(offset, offset), corner, foot);
    return both(found, inverse_sine_squared < constant<V>(0x1p20));
}

/// The two points in which a triangle's edges pass through a plane that parts its corners: on the
/// edges of the lone corner, at these parts of them.
template <class V> struct Passage {
    decltype(V() < V()) lone0, lone1; ///< which corner; 2 if none is set
    V ratio0, ratio1;                 ///< to the lower and to the higher of the other two

    BOXWOOD_LANE explicit Passage(const Heights<V>& h) : lone0(), lone1(), ratio0(), ratio1() {
        const V zero = constant<V>(0);
        const auto s0 = h.of[0] < zero, s1 = h.of[1] < zero, s2 = h.of[2] < zero;
        lone0 = same(s1, s2), lone1 = same(s0, s2);
        const V h_lone = lone(h.of[0], h.of[1], h.of[2]);
        const V drop0 = h_lone - lower(h.of[0], h.of[1]);
        const V drop1 = h_lone - higher(h.of[1], h.of[2]);
        const V scale = h_lone / (drop0 * drop1);
        ratio0 = scale * drop1, ratio1 = scale * drop0;
    }
    BOXWOOD_LANE V lone(V x0, V x1, V x2) const { return select(lone0, x0, select(lone1, x1, x2)); }
    BOXWOOD_LANE V lower(V x0, V x1) const { return select(lone0, x1, x0); }
    BOXWOOD_LANE V higher(V x1, V x2) const { return select(either(lone0, lone1), x2, x1); }

    /// The point that is t of the way from the one to the other.
    BOXWOOD_LANE Weights<V> between(V t) const {
        const V one = constant<V>(1);
        const V first = (one - t) * ratio0, second = t * ratio1, rest = (one - first) - second;
        return {select(lone0, first, select(lone1, rest, second)),
                select(either(lone0, lone1), second, rest)};
    }
};

/// The part of the two planes' common line between those points, by one coordinate.
template <class V> struct Cut {
    Passage<V> passage;
    V end0, end1;

    BOXWOOD_LANE Cut(const Heights<V>& h, V p0, V p1, V p2) : passage(h), end0(), end1() {
        const V p = passage.lone(p0, p1, p2);
        end0 = p + passage.ratio0 * (passage.lower(p0, p1) - p);
        end1 = p + passage.ratio1 * (passage.higher(p1, p2) - p);
    }
    BOXWOOD_LANE V low() const { return min(end0, end1); }
    BOXWOOD_LANE V high() const { return max(end0, end1); }
    /// 1 instead of 0.
    BOXWOOD_LANE V width() const {
        const V w = end1 - end0, none = constant<V>(0);
        return select(either(w < none, none < w), w, constant<V>(1));
    }
    /// The point at p, between the ends; `inverse` is 1 / width.
    BOXWOOD_LANE Weights<V> at(V p, V inverse) const {
        return passage.between(in_unit((p - end0) * inverse));
    }
};

/// The axis along which a direction is longest.
template <class V> struct LongestAxis {
    decltype(V() < V()) not_x, is_z;

    BOXWOOD_LANE explicit LongestAxis(const LaneVec3<V>& v) : not_x(), is_z() {
        const V x = abs(v.x), y = abs(v.y), z = abs(v.z);
        not_x = x < y, is_z = max(x, y) < z;
    }
    BOXWOOD_LANE V of(const LaneVec3<V>& p) const {
        return select(is_z, p.z, select(not_x, p.y, p.x));
    }
};

/// 1 - cos^2, or in the better-conditioned form sin^2 from the cross product, of two edges; and
/// times it the first edge's parameter nearest to the other's line. All divided by the squared
/// lengths. r: from b's start to a's; ba = a.b / a.a, ab = a.b / b.b, ca = a.r / a.a, fb = b.r /
/// b.b
template <bool by_cross, class V> struct Lines {
    V sine_squared, numerator;
    BOXWOOD_LANE Lines(const LaneVec3<V>& a, const LaneVec3<V>& b, const LaneVec3<V>& r,
                       V inverse_squares, V ba, V ab, V ca, V fb)
        : sine_squared(), numerator() {
        if constexpr (by_cross) {
            const LaneVec3<V> n = cross(a, b);
            sine_squared = dot(n, n) * inverse_squares;
            numerator = dot(cross(b, r), n) * inverse_squares;
        } else {
            sine_squared = constant<V>(1) - ba * ab;
            numerator = ba * fb - ca;
        }
        sine_squared = max(sine_squared, constant<V>(Limits<V>::sine_squared));
    }
};

/// Edges i of a and j of b. Ericson 2005, 5.1.9: the lines' parameter s, clamped; t nearest to
/// that, clamped; s again. Any s will do for parallel lines, and for an edge of no length.
template <int i, int j, class V>
BOXWOOD_LANE void edge_pair(const LaneVec3<V>& a, const LaneVec3<V>& b, const LaneVec3<V>& r,
                            V on_lines, V ba, V ab, V ca, V fb, Best<V>& best) {
    const V t = in_unit(ab * in_unit(on_lines) + fb);
    const V s = in_unit(ba * t - ca);
    const LaneVec3<V> offset = (r + s * a) - t * b;
    best.offer(dot(offset, offset), on_edge<i>(s), on_edge<j>(t));
}

/// Edge i of a with the three of b; r0 and r1 are from the starts of b's edges to a's.
template <bool by_cross, int i, class V>
BOXWOOD_LANE void edge_pairs(const Shape<V>& a, const Shape<V>& b, V inverse_a,
                             const V (&inverse_b)[3], const LaneVec3<V>& r0, const LaneVec3<V>& r1,
                             Best<V>& best) {
    const LaneVec3<V>& e = a.edge[i];
    const V p0 = dot(e, b.edge[0]), p1 = dot(e, b.edge[1]), p2 = dot(e, b.edge[2]);
    const V ba0 = p0 * inverse_a, ba1 = p1 * inverse_a, ba2 = p2 * inverse_a;
    const V ab0 = p0 * inverse_b[0], ab1 = p1 * inverse_b[1], ab2 = p2 * inverse_b[2];
    const V c0 = dot(e, r0) * inverse_a, c1 = dot(e, r1) * inverse_a;
    const V f0 = dot(b.edge[0], r0) * inverse_b[0], f1 = dot(b.edge[1], r0) * inverse_b[1];
    const V f2 = dot(b.edge[2], r1) * inverse_b[2];
    const Lines<by_cross, V> l0(e, b.edge[0], r0, inverse_a * inverse_b[0], ba0, ab0, c0, f0);
    const Lines<by_cross, V> l1(e, b.edge[1], r0, inverse_a * inverse_b[1], ba1, ab1, c0, f1);
    const Lines<by_cross, V> l2(e, b.edge[2], r1, inverse_a * inverse_b[2], ba2, ab2, c1, f2);
    V inverse[3] = {l0.sine_squared, l1.sine_squared, l2.sine_squared};
    reciprocals(inverse);
    edge_pair<i, 0>(e, b.edge[0], r0, l0.numerator * inverse[0], ba0, ab0, c0, f0, best);
    edge_pair<i, 1>(e, b.edge[1], r0, l1.numerator * inverse[1], ba1, ab1, c0, f1, best);
    edge_pair<i, 2>(e, b.edge[2], r1, l2.numerator * inverse[2], ba2, ab2, c1, f2, best);
}

/// Two triangles, which must outlive it, and where each one's corners are to the other's plane. All
/// that follows holds nothing in lanes that are not in_range (NaN, too).
template <class V> struct Facing {
    using Mask = decltype(V() < V());
    const Shape<V>&a, &b;
    LaneVec3<V> d00, d01, d02, d10, d20, d11; ///< from b's corner to a's: first a's index, then b's
    V size_squared; ///< of all that spans the two: 1/2 to 5 times the largest length squared
    LaneVec3<V> normal_a, normal_b;
    V squares_a, squares_b; ///< of the edges whose cross product is the normal
    Heights<V> of_a, of_b;  ///< of its corners, above the other
    Mask a_apart, b_apart;  ///< whether it lies on one side of the other

    BOXWOOD_LANE Facing(const Shape<V>& first, const Shape<V>& second)
        : a(first), b(second), d00(a.corner[0] - b.corner[0]), d01(a.corner[0] - b.corner[1]),
          d02(a.corner[0] - b.corner[2]), d10(a.corner[1] - b.corner[0]),
          d20(a.corner[2] - b.corner[0]), d11(a.corner[1] - b.corner[1]),
          size_squared(((a.squared[0] + a.squared[1]) + (b.squared[0] + b.squared[1])) +
                       dot(d00, d00)),
          normal_a(cross(a.edge[0], a.edge[1])), normal_b(cross(b.edge[0], b.edge[1])),
          squares_a(a.squared[0] * a.squared[1]),
          squares_b(b.squared[0] * b.squared[1]), of_a{{dot(normal_b, d00), dot(normal_b, d10),
                                                        dot(normal_b, d20)}},
          of_b{{-dot(normal_a, d00), -dot(normal_a, d01), -dot(normal_a, d02)}}, a_apart(),
          b_apart() {
        const V noise = constant<V>(Limits<V>::noise) * size_squared;
        a_apart = of_a.apart(noise * squares_b), b_apart = of_b.apart(noise * squares_a);
    }

    BOXWOOD_LANE Mask in_range() const {
        return both(constant<V>(Limits<V>::smallest) < size_squared,
                    size_squared < constant<V>(Limits<V>::largest));
    }
    /// Of the angle at the first corner.
    BOXWOOD_LANE V sine_squared_a() const { return sine_squared(normal_a, squares_a); }
    BOXWOOD_LANE V sine_squared_b() const { return sine_squared(normal_b, squares_b); }
    /// Whether its normal is mostly rounding, or 0.
    BOXWOOD_LANE Mask a_sliver() const { return sliver(normal_a, squares_a); }
    BOXWOOD_LANE Mask b_sliver() const { return sliver(normal_b, squares_b); }

    BOXWOOD_LANE LaneVec3<V> offset(const Weights<V>& wa, const Weights<V>& wb) const {
        return ((d00 + wa.u * a.edge[0]) + wa.v * a.edge[1]) -
               (wb.u * b.edge[0] + wb.v * b.edge[1]);
    }

  private:
    static BOXWOOD_LANE V sine_squared(const LaneVec3<V>& normal, V squares) {
        return dot(normal, normal) / max(squares, constant<V>(Limits<V>::min_normal));
    }
    static BOXWOOD_LANE Mask sliver(const LaneVec3<V>& normal, V squares) {
        return dot(normal, normal) <= constant<V>(Limits<V>::sliver) * squares;
    }
};

/// Offers a pair of points that ought to be one; it is 0, and the lane done, if they are but for
/// rounding: 32u of the size, or of slivers 32u / sin of the angle, while that is within the width.
template <class M, class V>
BOXWOOD_LANE M offer_common(M when, const Facing<V>& f, const Weights<V>& wa, const Weights<V>& wb,
                            Best<V>& best) {
    const LaneVec3<V> offset = f.offset(wa, wb);
    const V squared = dot(offset, offset), rounding = constant<V>(Limits<V>::rounding);
    M same_point = both(when, squared <= rounding * f.size_squared);
    if (any(both(when, negation(same_point)))) [[unlikely]] {
        const V sine_squared = min(f.sine_squared_a(), f.sine_squared_b());
        const V width = constant<V>(0x1p-4) * sine_squared * f.size_squared;
        same_point =
            either(same_point, both(when, both(squared <= width, squared * sine_squared <=
                                                                     rounding * f.size_squared)));
    }
    best.offer(when, select(same_point, constant<V>(0), squared), wa, wb);
    return same_point;
}

/// Where each plane parts the other's corners: whether the two cut overlapping parts out of the
/// planes' common line (Moller 1997).
template <class M, class V>
BOXWOOD_LANE M offer_common_line(M parted, const Facing<V>& f, Best<V>& best) {
    const LongestAxis<V> axis(cross(f.normal_a, f.normal_b));
    const V start = axis.of(f.d00);
    const Cut<V> cut_a(f.of_a, start, start + axis.of(f.a.edge[0]), start + axis.of(f.a.edge[1]));
    const Cut<V> cut_b(f.of_b, constant<V>(0), axis.of(f.b.edge[0]), axis.of(f.b.edge[1]));
    const V p = max(cut_a.low(), cut_b.low());
    const M meet = both(parted, p <= min(cut_a.high(), cut_b.high()));
    if (!any(meet))
        return meet;
    const V width_a = cut_a.width(), width_b = cut_b.width();
    const V inverse = constant<V>(1) / (width_a * width_b);
    return offer_common(meet, f, cut_a.at(p, inverse * width_b), cut_b.at(p, inverse * width_a),
                        best);
}

/// Where a sliver passes through a face's plane: whether one of its two edges does so inside.
template <bool sliver_is_a, class M, class V>
BOXWOOD_LANE M offer_passage(M through, const Facing<V>& f, Best<V>& best) {
    const Shape<V>&sliver = sliver_is_a ? f.a : f.b, &face = sliver_is_a ? f.b : f.a;
    const LaneVec3<V>& normal = sliver_is_a ? f.normal_b : f.normal_a;
    const Passage<V> passage(sliver_is_a ? f.of_a : f.of_b);
    const V scale = constant<V>(1) / dot(normal, normal);
    const LaneVec3<V> start = sliver_is_a ? f.d00 : -f.d00;
    M done = through;
    for (int end = 0; end < 2; ++end) {
        const Weights<V> on_sliver = passage.between(constant<V>(end));
        const LaneVec3<V> x = (start + on_sliver.u * sliver.edge[0]) + on_sliver.v * sliver.edge[1];
        const Weights<V> on_face = foot_of(x, face, normal, scale);
        const M met =
            offer_common(both(through, inside(on_face)), f, sliver_is_a ? on_sliver : on_face,
                         sliver_is_a ? on_face : on_sliver, best);
        done = end == 0 ? met : either(done, met);
    }
    return done;
}

/// Offers a common point where they cross; those lanes are done.
template <class V> BOXWOOD_LANE auto offer_crossing(const Facing<V>& f, Best<V>& best) {
    auto done = negation(either(f.a_apart, f.b_apart));
    if (any(done))
        done = offer_common_line(done, f, best);
    const auto a_sliver = f.a_sliver(), b_sliver = f.b_sliver();
    const auto a_through = both(a_sliver, negation(either(b_sliver, f.a_apart)));
    if (any(a_through)) [[unlikely]]
        done = either(done, offer_passage<true>(a_through, f, best));
    const auto b_through = both(b_sliver, negation(either(a_sliver, f.b_apart)));
    if (any(b_through)) [[unlikely]]
        done = either(done, offer_passage<false>(b_through, f, best));
    return done;
}

/// Offers the nearest corner of each to the other's face, then 9 pairs of edges, in lanes that are
/// not done.
template <bool by_cross, class M, class V>
BOXWOOD_LANE void offer_features(const Facing<V>& f, M done, Best<V>& best) {
    const Shape<V>&a = f.a, &b = f.b;
    // Edges shorter than this count as points: what they are of the size is far below rounding.
    const V shortest = constant<V>(Limits<V>::shortest_squared) * f.size_squared;
    V inverse_a[3], inverse_b[3];
    for (int k = 0; k < 3; ++k) {
        inverse_a[k] = max(a.squared[k], shortest);
        inverse_b[k] = max(b.squared[k], shortest);
    }
    reciprocals(inverse_a);
    reciprocals(inverse_b);
    if (any(either(f.a_apart, f.b_apart))) {
        const V squares_a = inverse_a[0] * inverse_a[1], squares_b = inverse_b[0] * inverse_b[1];
        const V min_sine = constant<V>(Limits<V>::sine_squared);
        V sines[3] = {max(dot(f.normal_a, f.normal_a) * squares_a, min_sine),
                      max(dot(f.normal_b, f.normal_b) * squares_b, min_sine), constant<V>(1)};
        reciprocals(sines);
        if (any(f.b_apart))
            done = either(done, offer_nearest_corner<true, by_cross>(f.b_apart, a, f.normal_a,
                                                                     squares_a, sines[0], f.of_b,
                                                                     -f.d00, -f.d01, -f.d02, best));
        if (any(f.a_apart))
            done = either(done, offer_nearest_corner<false, by_cross>(f.a_apart, b, f.normal_b,
                                                                      squares_b, sines[1], f.of_a,
                                                                      f.d00, f.d10, f.d20, best));
        if (all(done))
            return;
    }
    best.settle(done);
    edge_pairs<by_cross, 0>(a, b, inverse_a[0], inverse_b, f.d00, f.d01, best);
    edge_pairs<by_cross, 1>(a, b, inverse_a[1], inverse_b, f.d00, f.d01, best);
    edge_pairs<by_cross, 2>(a, b, inverse_a[2], inverse_b, f.d10, f.d11, best);
}

/// The pair that was offered and is best.
template <class V> BOXWOOD_LANE PointPair<V> best_pair(const Facing<V>& f, const Best<V>& best) {
    const LaneVec3<V> on_a = best.a.u * f.a.edge[0] + best.a.v * f.a.edge[1];
    const LaneVec3<V> on_b = best.b.u * f.b.edge[0] + best.b.v * f.b.edge[1];
    return {best.squared(), (f.d00 + on_a) - on_b, f.a.corner[0] + on_a, f.b.corner[0] + on_b};
}

// Not a header of its own, but the first part of nearest_features-inl.h: triangles of lane vectors
// V, and the guess.

template <class M, class V>
BOXWOOD_LANE LaneVec3<V> select(M m, const LaneVec3<V>& a, const LaneVec3<V>& b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class V> BOXWOOD_LANE V in_unit(V x) {
    return max(min(x, constant<V>(1)), constant<V>(0));
}

/// A triangle by its first corner: the edges to the second and third and between those, and their
/// squared lengths. Edge k starts at corner k / 2.
template <class V> struct Shape {
    LaneVec3<V> corner[3], edge[3];
    V squared[3];

    BOXWOOD_LANE Shape(const LaneVec3<V>& c0, const LaneVec3<V>& c1, const LaneVec3<V>& c2)
        : corner{c0, c1, c2}, edge{c1 - c0, c2 - c0, c2 - c1}, squared{dot(edge[0], edge[0]),
                                                                       dot(edge[1], edge[1]),
                                                                       dot(edge[2], edge[2])} {}
};

/// A point of a triangle: first corner + u * edge 0 + v * edge 1.
template <class V> struct Weights { V u, v; };
template <int edge, class V> BOXWOOD_LANE Weights<V> on_edge(V s) {
    if constexpr (edge == 0)
        return {s, constant<V>(0)};
    else if constexpr (edge == 1)
        return {constant<V>(0), s};
    else
        return {constant<V>(1) - s, s};
}

/// A point of each triangle, as near as found. offset: from b's point to a's; squared: its square,
/// or 0 where they were seen to cross.
template <class V> struct PointPair {
    V squared;
    LaneVec3<V> offset, a, b;
};

/// Three times the way from a's centre to b's, from that between their first corners and the edges
/// there.
template <class V>
BOXWOOD_LANE LaneVec3<V> way_between(const LaneVec3<V>& a0_to_b0, const LaneVec3<V>& a1,
                                     const LaneVec3<V>& a2, const LaneVec3<V>& b1,
                                     const LaneVec3<V>& b2) {
    return constant<V>(3) * a0_to_b0 + ((b1 + b2) - (a1 + a2));
}

/// The nearest points of edges a1 a2 and b1 b2 (Ericson 2005, 5.1.9: the lines' parameter s,
/// clamped; t nearest to it, clamped; s again). True if they are the triangles' nearest: if a0 and
/// b0, too, lie well beyond the planes through the two points, normal to their offset.
template <bool by_cross, class V>
BOXWOOD_LANE auto facing_edges(const LaneVec3<V>& a0, const LaneVec3<V>& a1, const LaneVec3<V>& a2,
                               const LaneVec3<V>& b0, const LaneVec3<V>& b1, const LaneVec3<V>& b2,
                               PointPair<V>& pair) {
    const V one = constant<V>(1), min_normal = constant<V>(Limits<V>::min_normal);
    const LaneVec3<V> ea = a2 - a1, eb = b2 - b1, r = a1 - b1;
    const V aa = dot(ea, ea), bb = dot(eb, eb), ab = dot(ea, eb);
    const V ca = dot(ea, r), fb = dot(eb, r);
    V sine, on_lines;
    if constexpr (by_cross) {
        const LaneVec3<V> n = cross(ea, eb);
        sine = dot(n, n), on_lines = dot(cross(eb, r), n);
    } else {
        sine = aa * bb - ab * ab, on_lines = ab * fb - ca * bb;
    }
    // Parallel lines, and edges of no length, divide by `min_normal`: any parameter will do.
    const V inverse_a = one / max(aa, min_normal), inverse_b = one / max(bb, min_normal);
    const V first = in_unit(on_lines / max(sine, min_normal));
    const V t = in_unit((ab * first + fb) * inverse_b);
    const V s = in_unit((ab * t - ca) * inverse_a);
    const LaneVec3<V> to_a = s * ea, to_b = t * eb, offset = (r + to_a) - to_b;
    const V squared = dot(offset, offset), size = (aa + bb) + squared;
    pair = {squared, offset, a1 + to_a, b1 + to_b};
    const auto in_range =
        both(constant<V>(Limits<V>::smallest) < size, size < constant<V>(Limits<V>::largest));
    // By more than rounding: where edges are nearly parallel, other points may be far nearer.
    const LaneVec3<V> wa = (a0 - a1) - to_a, wb = (b0 - b1) - to_b;
    const V margin = constant<V>(Limits<V>::margin);
    const auto apart = both(margin * (size + dot(wa, wa)) <= dot(offset, wa),
                            margin * (size + dot(wb, wb)) <= -dot(offset, wb));
    return both(in_range, apart);
}

/// The best pair of points found so far, by lane. `limit` is what a candidate must beat.
template <class V> struct Best {
    V limit, settled;
    Weights<V> a, b;

    BOXWOOD_LANE Best()
        : limit(constant<V>(0x1p125)), settled(limit), a{constant<V>(0), constant<V>(0)}, b(a) {}

    template <class M> BOXWOOD_LANE void offer(M when, V candidate, Weights<V> wa, Weights<V> wb) {
        take(both(when, candidate < limit), candidate, wa, wb);
    }
    BOXWOOD_LANE void offer(V candidate, Weights<V> wa, Weights<V> wb) {
        take(candidate < limit, candidate, wa, wb);
    }
    template <class M> BOXWOOD_LANE void take(M better, V candidate, Weights<V> wa, Weights<V> wb) {
        limit = select(better, candidate, limit);
        a = {select(better, wa.u, a.u), select(better, wa.v, a.v)};
        b = {select(better, wb.u, b.u), select(better, wb.v, b.v)};
    }
    /// These lanes are final.
    template <class M> BOXWOOD_LANE void settle(M done) {
        settled = select(done, limit, settled);
        limit = select(done, constant<V>(-1), limit);
    }
    BOXWOOD_LANE V squared() const { return select(limit < constant<V>(0), settled, limit); }
};

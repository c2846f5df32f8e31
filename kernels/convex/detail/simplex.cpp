#include "kernels/convex/detail/simplex.h"

#include <bit>
#include <utility>

namespace boxwood::convex::detail {
namespace {

using V = Vec3<double>;
using Index = std::size_t;

struct Search {
    const Vertices& vertices;
    Nearest& best;
    double best_squared = inf;
    std::array<double, 4> squared; ///< of the vertices' distances
    std::array<Index, 3> from;     ///< the vertices of the best, the nearest to the origin first

    Search(const Vertices& of, Nearest& to) : vertices(of), best(to) {}
    const V& w(Index i) const { return vertices[i].w; }

    void vertex(Index i) {
        if (!(squared[i] < best_squared))
            return;
        best_squared = squared[i];
        best.point = w(i);
        best.used = 1u << i;
        best.weight[i] = 1;
        from[0] = i;
    }

    void segment(Index i, Index j) {
        if (squared[j] < squared[i])
            std::swap(i, j);
        const V e = w(j) - w(i);
        const double along = -dot(w(i), e), ee = dot(e, e);
        if (!(along > 0))
            return vertex(i);
        if (!(along < ee))
            return vertex(j);
        const double t = along / ee;
        const V p = w(i) + t * e;
        const double d = dot(p, p);
        if (!(d < best_squared))
            return;
        best_squared = d;
        best.point = p;
        best.used = 1u << i | 1u << j;
        best.weight[i] = 1 - t;
        best.weight[j] = t;
        from[0] = i, from[1] = j;
    }

    /// Of the edges of triangle ijk only those that face the origin can hold the nearest point,
    /// unless it is inside. `all`: tries all three.
    void triangle(Index i, Index j, Index k, bool all) {
        if (squared[j] < squared[i])
            std::swap(i, j);
        if (squared[k] < squared[i])
            std::swap(i, k);
        const V p = w(j) - w(i), q = w(k) - w(i);
        const double pp = dot(p, p), pq = dot(p, q), qq = dot(q, q);
        const double x = -dot(w(i), p), y = -dot(w(i), q);
        const V n = cross(p, q);
        const double nn = dot(n, n);
        const double of_j = qq * x - pq * y, of_k = pp * y - pq * x, of_i = nn - of_j - of_k;
        if (of_i > 0 && of_j > 0 && of_k > 0 && nn > 0) {
            const double b = of_j / nn, c = of_k / nn;
            const V at = w(i) + (b * p + c * q);
            if (const double d = dot(at, at); d < best_squared) {
                best_squared = d;
                best.point = at;
                best.used = 1u << i | 1u << j | 1u << k;
                best.weight[i] = 1 - b - c > 0 ? 1 - b - c : 0;
                best.weight[j] = b;
                best.weight[k] = c;
                from = {i, j, k};
            }
            if (!all)
                return;
        }
        if (all || !(of_k > 0))
            segment(i, j);
        if (all || !(of_j > 0))
            segment(i, k);
        if (all || !(of_i > 0))
            segment(j, k);
    }

    /// From the origin to the best point, square to the edge or face that it lies on.
    V direction() const {
        if (best.used == 0) // NaN in all
            return {};
        const V& a = w(from[0]);
        const int n_used = std::popcount(best.used);
        if (n_used == 1)
            return a;
        const V p = w(from[1]) - a;
        if (n_used == 2)
            return cross(p, cross(a, p));
        const V n = cross(p, w(from[2]) - a);
        return dot(n, a) < 0 ? -n : n;
    }

    /// True if the origin is inside.
    bool tetrahedron(bool all) {
        Index d = 0;
        for (Index i = 1; i < 4; ++i)
            if (squared[i] < squared[d])
                d = i;
        const Index a = d == 0 ? 1 : 0, b = d <= 1 ? 2 : 1, c = d <= 2 ? 3 : 2;
        const V p = w(a) - w(d), q = w(b) - w(d), r = w(c) - w(d), o = -w(d);
        const V qr = cross(q, r), rp = cross(r, p), pq = cross(p, q);
        double volume = dot(p, qr), of_a = dot(o, qr), of_b = dot(o, rp), of_c = dot(o, pq);
        if (volume < 0)
            volume = -volume, of_a = -of_a, of_b = -of_b, of_c = -of_c;
        const double of_d = volume - of_a - of_b - of_c;
        if (volume > 0 && of_a >= 0 && of_b >= 0 && of_c >= 0 && of_d >= 0) {
            best.used = 0b1111;
            best.weight[a] = of_a / volume, best.weight[b] = of_b / volume;
            best.weight[c] = of_c / volume, best.weight[d] = of_d / volume;
            best.encloses = true;
            best.point = {};
            for (Index i = 0; i < 4; ++i)
                best.point = best.point + best.weight[i] * w(i);
            return true;
        }
        const bool flat = !(volume > 0) || all;
        if (flat || of_a < 0)
            triangle(d, b, c, all);
        if (flat || of_b < 0)
            triangle(d, c, a, all);
        if (flat || of_c < 0)
            triangle(d, a, b, all);
        if (flat || of_d < 0)
            triangle(a, b, c, all);
        return false;
    }
};

/// Of a face's plane, counterclockwise seen from outside; the ball is inside and does not reach it.
bool is_beyond(double radius, V a, V b, V c) {
    const V n = cross(b - a, c - a);
    const double offset = std::min({dot(n, a), dot(n, b), dot(n, c)});
    return offset > 0 && offset * offset > radius * radius * dot(n, n);
}

} // namespace

void find_nearest(const Vertices& vertices, unsigned used, bool thoroughly, Nearest& nearest) {
    nearest.used = 0;
    nearest.encloses = false;
    Search search{vertices, nearest};
    std::array<Index, 4> at;
    int size = 0;
    for (unsigned bits = used; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<Index>(std::countr_zero(bits));
        search.squared[i] = dot(vertices[i].w, vertices[i].w);
        at[static_cast<Index>(size++)] = i;
    }
    switch (size) {
    case 1:
        search.vertex(at[0]);
        break;
    case 2:
        search.segment(at[0], at[1]);
        break;
    case 3:
        search.triangle(at[0], at[1], at[2], thoroughly);
        break;
    default:
        if (search.tetrahedron(thoroughly))
            return;
    }
    nearest.direction = search.direction();
}

bool encloses_ball(const Vertices& tetrahedron, double radius) {
    const auto& [a, b, c, d] = tetrahedron;
    const V n = cross(b.w - a.w, c.w - a.w);
    const auto [p, q] = dot(n, d.w - a.w) > 0 ? std::pair(c.w, b.w) : std::pair(b.w, c.w);
    return is_beyond(radius, a.w, p, q) && is_beyond(radius, a.w, d.w, p) &&
           is_beyond(radius, p, d.w, q) && is_beyond(radius, q, d.w, a.w);
}

bool encloses_ball(std::span<const V> ring, V top, V bottom, double radius) {
    for (Index i = 0; i < ring.size(); ++i) {
        const V &p = ring[i], &q = ring[i + 1 == ring.size() ? 0 : i + 1];
        if (!is_beyond(radius, p, q, top) || !is_beyond(radius, q, p, bottom))
            return false;
    }
    return true;
}

} // namespace boxwood::convex::detail

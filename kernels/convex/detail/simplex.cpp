#include "kernels/convex/detail/simplex.h"

#include <utility>

namespace boxwood::convex::detail {
namespace {

using V = Vec3<double>;
using Index = std::size_t;

/// The best point so far, on the vertices from[0 .. size).
struct Best {
    double squared = inf;
    V nearest;
    std::array<Index, 3> from;
    std::array<double, 3> weight;
    int size = 0;
};

struct Search {
    const Simplex& s;
    Best best;
    std::array<double, 4> squared; ///< of the vertices' distances

    explicit Search(const Simplex& simplex) : s(simplex) {
        for (Index i = 0; i < static_cast<Index>(s.size); ++i)
            squared[i] = dot(w(i), w(i));
    }

    const V& w(Index i) const { return s.vertex[i].w; }

    void vertex(Index i) {
        if (squared[i] < best.squared)
            best = {squared[i], w(i), {i, 0, 0}, {1, 0, 0}, 1};
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
        if (const double d = dot(p, p); d < best.squared)
            best = {d, p, {i, j, 0}, {1 - t, t, 0}, 2};
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
            if (const double d = dot(at, at); d < best.squared)
                best = {d, at, {i, j, k}, {1 - b - c > 0 ? 1 - b - c : 0, b, c}, 3};
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
        if (best.size == 0) // NaN in all
            return {};
        const V& a = w(best.from[0]);
        if (best.size == 1)
            return a;
        const V p = w(best.from[1]) - a;
        if (best.size == 2)
            return cross(p, cross(a, p));
        const V n = cross(p, w(best.from[2]) - a);
        return dot(n, a) < 0 ? -n : n;
    }

    /// True if the origin is inside, with the weights of the four.
    bool tetrahedron(bool all, std::array<double, 4>& weight) {
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
            weight[a] = of_a / volume, weight[b] = of_b / volume;
            weight[c] = of_c / volume, weight[d] = of_d / volume;
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

void reduce_with(const Simplex& s, Simplex& to, bool all) {
    Search search(s);
    to.encloses = false;
    switch (s.size) {
    case 1:
        search.vertex(0);
        break;
    case 2:
        search.segment(0, 1);
        break;
    case 3:
        search.triangle(0, 1, 2, all);
        break;
    default:
        if (search.tetrahedron(all, to.weight)) {
            to.encloses = true;
            to.size = 4;
            to.vertex = s.vertex;
            to.nearest = to.direction = {};
            for (Index i = 0; i < 4; ++i)
                to.nearest = to.nearest + to.weight[i] * s.vertex[i].w;
            return;
        }
    }
    const Best& best = search.best;
    to.size = 0;
    for (Index i = 0; i < static_cast<Index>(s.size); ++i) // in order, the newest last
        for (Index k = 0; k < static_cast<Index>(best.size); ++k)
            if (best.from[k] == i) {
                to.weight[static_cast<Index>(to.size)] = best.weight[k];
                to.add(s.vertex[i]);
            }
    to.nearest = best.nearest;
    to.direction = search.direction();
}

} // namespace

void reduce(const Simplex& from, Simplex& to) { reduce_with(from, to, false); }
void reduce_thoroughly(const Simplex& from, Simplex& to) { reduce_with(from, to, true); }

bool encloses_ball(const Simplex& tetrahedron, double radius) {
    const auto& v = tetrahedron.vertex;
    const auto face_is_beyond = [&](Index i, Index j, Index k, Index inside) {
        V n = cross(v[j].w - v[i].w, v[k].w - v[i].w);
        if (dot(n, v[inside].w - v[i].w) > 0)
            n = -n;
        const double offset = std::min({dot(n, v[i].w), dot(n, v[j].w), dot(n, v[k].w)});
        return offset > 0 && offset * offset > radius * radius * dot(n, n);
    };
    return face_is_beyond(0, 1, 2, 3) && face_is_beyond(0, 1, 3, 2) && face_is_beyond(0, 2, 3, 1) &&
           face_is_beyond(1, 2, 3, 0);
}

} // namespace boxwood::convex::detail

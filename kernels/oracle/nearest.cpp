#include "kernels/oracle/nearest.h"

#include "kernels/oracle/exact_vector.h"

#include <array>
#include <tuple>
#include <utility>

namespace boxwood::oracle {
namespace {

/// The point x / w, w > 0.
struct Site {
    Point x;
    Integer w;
};

/// The least of the squared distances offered so far, as a fraction, and where it was.
class Best {
  public:
    /// sites(): the two points. swapped: the first of them is of side b.
    template <class Sites>
    void offer(const Integer& num, const Integer& den, bool swapped, Sites&& sites) {
        if (den_ != 0 && num * den_ >= num_ * den)
            return;
        num_ = num;
        den_ = den;
        std::tie(a_, b_) = sites();
        if (swapped)
            std::swap(a_, b_);
    }

    Nearest in_units_of(const Unit& unit) const {
        mpq_class squared(num_, den_);
        squared.canonicalize();
        return {scaled(squared, 2L * unit.exponent), rational(a_, unit), rational(b_, unit)};
    }

  private:
    static RationalPoint rational(const Site& site, const Unit& unit) {
        RationalPoint p;
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = mpq_class(site.x[i], site.w);
            p[i].canonicalize();
            p[i] = scaled(p[i], unit.exponent);
        }
        return p;
    }

    Integer num_, den_ = 0;
    Site a_, b_;
};

void corner_corner(Best& best, const Point& p, const Point& q) {
    const Point d = p - q;
    best.offer(dot(d, d), 1, false, [&] { return std::pair(Site{p, 1}, Site{q, 1}); });
}

/// p against the inside of the segment ab: where its foot lies strictly between the ends.
void corner_edge(Best& best, const Point& p, const Point& a, const Point& b, bool swapped) {
    const Point along = b - a, to = p - a;
    const Integer at = dot(to, along), end = dot(along, along);
    if (at <= 0 || at >= end)
        return;
    const Point moment = cross(to, along);
    best.offer(dot(moment, moment), end, swapped, [&] {
        return std::pair(Site{p, 1}, Site{end * a + at * along, end});
    });
}

/// The inside of the segment pq against that of rs: where the common perpendicular of their lines
/// meets both strictly between the ends. Parallel ones are nearest at some corner too.
void edge_edge(Best& best, const Point& p, const Point& q, const Point& r, const Point& s) {
    const Point u = q - p, v = s - r, w = r - p, n = cross(u, v);
    const Integer nn = dot(n, n), x = dot(cross(w, v), n), y = dot(cross(w, u), n);
    if (x <= 0 || x >= nn || y <= 0 || y >= nn)
        return;
    const Integer height = dot(n, w);
    best.offer(height * height, nn, false, [&] {
        return std::pair(Site{nn * p + x * u, nn}, Site{nn * r + y * v, nn});
    });
}

/// p against the inside of the triangle: where its foot lies strictly inside.
void corner_face(Best& best, const Point& p, const std::array<Point, 3>& t, bool swapped) {
    const Point n = cross(t[1] - t[0], t[2] - t[0]);
    for (std::size_t i = 0; i < 3; ++i)
        if (dot(n, cross(t[(i + 1) % 3] - t[i], p - t[i])) <= 0)
            return;
    const Integer nn = dot(n, n), height = dot(n, p - t[0]);
    best.offer(height * height, nn, swapped, [&] {
        return std::pair(Site{p, 1}, Site{nn * p - height * n, nn});
    });
}

/// 0 if the segment pq passes from one side of the triangle's plane to the other within it.
void through_face(Best& best, const Point& p, const Point& q, const std::array<Point, 3>& t) {
    const Point n = cross(t[1] - t[0], t[2] - t[0]);
    Integer height_p = dot(n, p - t[0]), height_q = dot(n, q - t[0]);
    if (sgn(height_p) * sgn(height_q) >= 0)
        return;
    if (height_p < 0) {
        height_p = -height_p;
        height_q = -height_q;
    }
    const Integer w = height_p - height_q;
    const Point x = height_p * q - height_q * p;
    for (std::size_t i = 0; i < 3; ++i)
        if (dot(n, cross(t[(i + 1) % 3] - t[i], x - w * t[i])) < 0)
            return;
    best.offer(0, 1, false, [&] { return std::pair(Site{x, w}, Site{x, w}); });
}

} // namespace

// Two convex sets that share no point are nearest at a pair of features (corner, inside of an edge,
// inside of the face), and there are such pairs with dimensions 0-0, 0-1, 1-1 or 0-2. Two triangles
// that share a point also do so at one of these, or an edge of one passes through the other's
// inside. A degenerate triangle is the union of its edges.
Nearest nearest(const Triangle<double>& a, const Triangle<double>& b) {
    const Unit unit(a.a, a.b, a.c, b.a, b.b, b.c);
    const std::array<Point, 3> p{unit(a.a), unit(a.b), unit(a.c)},
        q{unit(b.a), unit(b.b), unit(b.c)};
    Best best;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            const std::size_t next_i = (i + 1) % 3, next_j = (j + 1) % 3;
            corner_corner(best, p[i], q[j]);
            corner_edge(best, p[i], q[j], q[next_j], false);
            corner_edge(best, q[j], p[i], p[next_i], true);
            edge_edge(best, p[i], p[next_i], q[j], q[next_j]);
        }
    for (std::size_t i = 0; i < 3; ++i) {
        corner_face(best, p[i], q, false);
        corner_face(best, q[i], p, true);
        through_face(best, p[i], p[(i + 1) % 3], q);
        through_face(best, q[i], q[(i + 1) % 3], p);
    }
    return best.in_units_of(unit);
}

Nearest nearest(const Segment<double>& a, const Segment<double>& b) {
    const Unit unit(a.a, a.b, b.a, b.b);
    const std::array<Point, 2> p{unit(a.a), unit(a.b)}, q{unit(b.a), unit(b.b)};
    Best best;
    for (std::size_t i = 0; i < 2; ++i) {
        corner_corner(best, p[i], q[0]);
        corner_corner(best, p[i], q[1]);
        corner_edge(best, p[i], q[0], q[1], false);
        corner_edge(best, q[i], p[0], p[1], true);
    }
    edge_edge(best, p[0], p[1], q[0], q[1]);
    return best.in_units_of(unit);
}

Nearest nearest(Vec3<double> a, const Triangle<double>& b) {
    const Unit unit(a, b.a, b.b, b.c);
    const Point p = unit(a);
    const std::array<Point, 3> q{unit(b.a), unit(b.b), unit(b.c)};
    Best best;
    for (std::size_t i = 0; i < 3; ++i) {
        corner_corner(best, p, q[i]);
        corner_edge(best, p, q[i], q[(i + 1) % 3], false);
    }
    corner_face(best, p, q, false);
    return best.in_units_of(unit);
}

Nearest nearest(Vec3<double> a, const Segment<double>& b) {
    const Unit unit(a, b.a, b.b);
    const Point p = unit(a), q = unit(b.a), r = unit(b.b);
    Best best;
    corner_corner(best, p, q);
    corner_corner(best, p, r);
    corner_edge(best, p, q, r, false);
    return best.in_units_of(unit);
}

mpq_class squared_distance(const Triangle<double>& a, const Triangle<double>& b) {
    return nearest(a, b).squared;
}
mpq_class squared_distance(const Segment<double>& a, const Segment<double>& b) {
    return nearest(a, b).squared;
}
mpq_class squared_distance(Vec3<double> a, const Triangle<double>& b) {
    return nearest(a, b).squared;
}
mpq_class squared_distance(Vec3<double> a, const Segment<double>& b) {
    return nearest(a, b).squared;
}

} // namespace boxwood::oracle

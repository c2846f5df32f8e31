#include "kernels/oracle/exact_vector.h"
#include "kernels/oracle/oracle.h"

namespace boxwood::oracle {
namespace {

bool on_segment(const Point& p, const Point& a, const Point& b) {
    const Point along = b - a, to = p - a;
    if (is_zero(along))
        return is_zero(to);
    if (!is_zero(cross(along, to)))
        return false;
    const Integer at = dot(to, along);
    return at >= 0 && at <= dot(along, along);
}

/// Do the closed segments pq and rs share a point?
bool segments_meet(const Point& p, const Point& q, const Point& r, const Point& s) {
    const Point u = q - p, v = s - r, n = cross(u, v), w = r - p;
    if (is_zero(n)) // parallel, or a point: if they meet, then at an end of one of them
        return on_segment(p, r, s) || on_segment(q, r, s) || on_segment(r, p, q) ||
               on_segment(s, p, q);
    if (dot(w, n) != 0)
        return false;
    // The lines meet where p + x u = r + y v.
    const Integer scale = dot(n, n), x = dot(cross(w, v), n), y = dot(cross(w, u), n);
    return x >= 0 && x <= scale && y >= 0 && y <= scale;
}

struct Corners {
    Point a, b, c;
};

/// Is x / w (w > 0), which is in the plane of t with normal n != 0, in t?
bool in_triangle(const Point& x, const Integer& w, const Corners& t, const Point& n) {
    const auto inside = [&](const Point& from, const Point& to) {
        return dot(n, cross(to - from, x - w * from)) >= 0;
    };
    return inside(t.a, t.b) && inside(t.b, t.c) && inside(t.c, t.a);
}

/// Does the closed segment pq share a point with t?
bool segment_meets(const Point& p, const Point& q, const Corners& t) {
    const auto meets_an_edge = [&] {
        return segments_meet(p, q, t.a, t.b) || segments_meet(p, q, t.b, t.c) ||
               segments_meet(p, q, t.c, t.a);
    };
    const Point n = cross(t.b - t.a, t.c - t.a);
    if (is_zero(n)) // t is the union of its edges
        return meets_an_edge();
    const Integer height_p = dot(n, p - t.a), height_q = dot(n, q - t.a);
    const int side_p = sgn(height_p), side_q = sgn(height_q);
    if (side_p * side_q > 0)
        return false;
    if (side_p == 0 && side_q == 0)
        return in_triangle(p, 1, t, n) || meets_an_edge();
    // The line of pq meets the plane in (height_p q - height_q p) / (height_p - height_q).
    const Point x = height_p * q - height_q * p;
    const Integer w = height_p - height_q;
    return w > 0 ? in_triangle(x, w, t, n) : in_triangle(Integer(-1) * x, -w, t, n);
}

bool an_edge_meets(const Corners& edges_of, const Corners& t) {
    return segment_meets(edges_of.a, edges_of.b, t) || segment_meets(edges_of.b, edges_of.c, t) ||
           segment_meets(edges_of.c, edges_of.a, t);
}

} // namespace

// If the two share points, take one that is extreme among them. It lies on an edge of one of the
// triangles: were it inside both, then also a piece of the line in which their planes meet.
bool intersect(const Triangle<double>& a, const Triangle<double>& b) {
    const Unit unit(a.a, a.b, a.c, b.a, b.b, b.c);
    const Corners ca{unit(a.a), unit(a.b), unit(a.c)}, cb{unit(b.a), unit(b.b), unit(b.c)};
    return an_edge_meets(ca, cb) || an_edge_meets(cb, ca);
}

} // namespace boxwood::oracle

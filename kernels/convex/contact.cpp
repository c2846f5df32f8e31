#include "kernels/convex/contact.h"

#include "kernels/convex/detail/gjk.h"
#include "kernels/convex/unit_flat.h"

#include <algorithm>
#include <utility>

namespace boxwood::convex {
namespace {

using namespace detail;
using V = Vec3<double>;
using Index = std::size_t;

/// A face of a box, in its frame: the axis that it is square to, and on which side.
struct BoxFace {
    int axis = 0;
    double side = 1, alignment = -1; ///< cosine with the direction asked for
};

BoxFace face_along(const Pose& pose, V direction) {
    const V d = transposed_times(pose.rotation, direction);
    BoxFace face;
    for (int i = 0; i < 3; ++i)
        if (std::abs(d[i]) > face.alignment)
            face = {i, std::copysign(1.0, d[i]), std::abs(d[i])};
    return face;
}

/// A convex polygon of few corners.
struct Polygon {
    std::array<V, 8> corner;
    Index size = 0;

    /// What is left of it where sign x[axis] <= limit. Of four corners cut four times at most eight
    /// are left.
    Polygon cut(int axis, double sign, double limit) const {
        Polygon out;
        for (Index i = 0; i < size; ++i) {
            const V &p = corner[i], &q = corner[i + 1 == size ? 0 : i + 1];
            const double from = sign * p[axis] - limit, to = sign * q[axis] - limit;
            if (from <= 0)
                out.add(p);
            if ((from < 0 && to > 0) || (from > 0 && to < 0))
                out.add(p + (q - p) * (from / (from - to)));
        }
        return out;
    }
    void add(V p) {
        if (size < corner.size())
            corner[size++] = p;
    }
};

/// The face's corners in a frame of another box.
Polygon corners(const Box& box, BoxFace face, const RelativePose& box_in_other) {
    const int i = (face.axis + 1) % 3, j = (face.axis + 2) % 3;
    Polygon polygon;
    for (const auto& [s, t] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
        V p{};
        p[face.axis] = face.side * box.half[face.axis];
        p[i] = s * box.half[i];
        p[j] = t * box.half[j];
        polygon.add(box_in_other(p));
    }
    return polygon;
}

/// Of the points that each(visit) visits the deepest, the farthest from it, and on both sides of
/// those two the farthest from their line; the deepest first.
template <class Each> void keep_four(const Each& each, V normal, Contacts& contacts) {
    const auto keep_best = [&](double least, auto measure) {
        ContactPoint best;
        bool found = false;
        each([&](const ContactPoint& p) {
            if (const double m = measure(p); m > least)
                least = m, best = p, found = true;
        });
        if (found)
            contacts.points[static_cast<Index>(contacts.count++)] = best;
        return found;
    };
    if (!keep_best(-inf, [](const ContactPoint& p) { return p.depth; }))
        return;
    const V deepest = contacts.points[0].point;
    if (!keep_best(0, [&](const ContactPoint& p) { return length(p.point - deepest); }))
        return;
    const V across = cross(normal, contacts.points[1].point - deepest);
    for (const double side : {1.0, -1.0})
        keep_best(0, [&](const ContactPoint& p) { return side * dot(across, p.point - deepest); });
    for (Index i = 1; i < static_cast<Index>(contacts.count); ++i) // std::stable_sort may allocate
        for (Index k = i; k > 0 && contacts.points[k].depth > contacts.points[k - 1].depth; --k)
            std::swap(contacts.points[k], contacts.points[k - 1]);
}

/// Cuts b's face to a's, which is the more square to the normal.
void face_contacts(const Box& a, const Pose& pose_a, BoxFace face, const Box& b, const Pose& pose_b,
                   BoxFace other, double margin, Contacts& contacts) {
    Polygon polygon = corners(b, other, RelativePose(pose_a, pose_b));
    for (const int axis : {(face.axis + 1) % 3, (face.axis + 2) % 3})
        for (const double sign : {1.0, -1.0})
            polygon = polygon.cut(axis, sign, a.half[axis]);
    std::array<ContactPoint, 8> all;
    Index size = 0;
    for (Index i = 0; i < polygon.size; ++i) {
        V p = polygon.corner[i];
        const double depth = a.half[face.axis] - face.side * p[face.axis];
        if (depth < -margin)
            continue;
        p[face.axis] += face.side * depth / 2;
        all[size++] = {pose_a(p), depth};
    }
    const auto each = [&](const auto& visit) {
        for (Index i = 0; i < size; ++i)
            visit(all[i]);
    };
    keep_four(each, contacts.distance.normal, contacts);
}

/// The corners of a shape, or points of its rims, on which it may rest: down is where that is, in
/// its frame, of unit length. Of round shapes none.
template <class S, class Visit> void each_foot(const S&, V, const Visit&) {}
template <class Visit> void each_foot(const Box& s, V, const Visit& visit) {
    for (const double x : {s.half.x, -s.half.x})
        for (const double y : {s.half.y, -s.half.y})
            for (const double z : {s.half.z, -s.half.z})
                visit(V{x, y, z});
}
template <class Visit> void each_foot(const Hull& s, V, const Visit& visit) {
    for (const V& p : s.points())
        visit(p);
}
template <class Visit> void each_foot(const Triangle& s, V, const Visit& visit) {
    visit(s.a), visit(s.b), visit(s.c);
}
template <class Visit> void each_foot(const Capsule& s, V down, const Visit& visit) {
    for (const double z : {s.half_length, -s.half_length})
        visit(V{0, 0, z} + down * s.radius);
}
template <class Visit> void each_on_rim(double radius, double z, V down, const Visit& visit) {
    const V along = unit_or({down.x, down.y, 0}, {1, 0, 0});
    const V across{-along.y, along.x, 0};
    for (const V& way : {along, across, -along, -across})
        visit(way * radius + V{0, 0, z});
}
template <class Visit> void each_foot(const Cylinder& s, V down, const Visit& visit) {
    for (const double z : {s.half_length, -s.half_length})
        each_on_rim(s.radius, z, down, visit);
}
template <class Visit> void each_foot(const Cone& s, V down, const Visit& visit) {
    visit(V{0, 0, s.half_length});
    each_on_rim(s.radius, -s.half_length, down, visit);
}

/// Where a shape lies on a half-space or plane, of whose two sides it is on the one that `up` says.
template <class S, class Flat>
void flat_contacts(const S& shape, const Pose& pose, const Flat& flat, const Pose& pose_flat, V up,
                   double margin, Contacts& contacts) {
    const auto [unit, offset] = unit_flat(flat);
    const V turned = times(pose_flat.rotation, unit);
    const double side = dot(turned, up) < 0 ? -1 : 1;
    const V normal = turned * side;
    const auto each = [&](const auto& visit) {
        each_foot(shape, unit_or(transposed_times(pose.rotation, -normal), {0, 0, -1}),
                  [&](V foot) {
                      const V p = pose(foot);
                      const double depth = side * offset - dot(normal, p - pose_flat.translation);
                      if (depth >= -margin)
                          visit(ContactPoint{p + normal * (depth / 2), depth});
                  });
    };
    keep_four(each, normal, contacts);
}

} // namespace

Contacts contacts(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                  double margin) {
    constexpr double parallel = 1 - 0x1p-30;
    Contacts found;
    found.distance = signed_distance(a, pose_a, b, pose_b);
    const SignedDistance& d = found.distance;
    if (!(d.distance <= margin))
        return found;
    const Box *box_a = a.get_if<Box>(), *box_b = b.get_if<Box>();
    if (box_a && box_b) {
        const BoxFace face_a = face_along(pose_a, d.normal), face_b = face_along(pose_b, -d.normal);
        if (face_a.alignment >= parallel && face_a.alignment >= face_b.alignment)
            face_contacts(*box_a, pose_a, face_a, *box_b, pose_b, face_b, margin, found);
        else if (face_b.alignment >= parallel)
            face_contacts(*box_b, pose_b, face_b, *box_a, pose_a, face_a, margin, found);
    }
    a.visit([&]<class A>(const A& shape_a) {
        b.visit([&]<class B>(const B& shape_b) {
            if constexpr (BoundedShape<A> && !BoundedShape<B>)
                flat_contacts(shape_a, pose_a, shape_b, pose_b, -d.normal, margin, found);
            else if constexpr (!BoundedShape<A> && BoundedShape<B>)
                flat_contacts(shape_b, pose_b, shape_a, pose_a, d.normal, margin, found);
        });
    });
    if (found.count == 0) {
        found.points[0] = {(d.point_a + d.point_b) * 0.5, d.depth()};
        found.count = 1;
    }
    return found;
}

} // namespace boxwood::convex

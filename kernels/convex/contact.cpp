#include "kernels/convex/contact.h"

#include "kernels/convex/detail/relative_pose.h"

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

/// Of up to eight points the deepest, the farthest from it, and on both sides of those two the
/// farthest from their line.
void keep_four(const std::array<ContactPoint, 8>& all, Index size, V normal, Contacts& contacts) {
    Index deepest = 0;
    for (Index i = 1; i < size; ++i)
        if (all[i].depth > all[deepest].depth)
            deepest = i;
    const auto best = [&](auto measure) {
        Index at = size;
        double most = 0;
        for (Index i = 0; i < size; ++i)
            if (const double m = measure(all[i].point); m > most)
                most = m, at = i;
        return at;
    };
    const auto keep = [&](Index i) {
        if (i < size)
            contacts.points[static_cast<Index>(contacts.count++)] = all[i];
    };
    const V p = all[deepest].point;
    const Index far = best([&](V q) { return length(q - p); });
    keep(deepest);
    keep(far);
    if (far == size)
        return;
    const V across = cross(normal, all[far].point - p);
    keep(best([&](V q) { return dot(across, q - p); }));
    keep(best([&](V q) { return -dot(across, q - p); }));
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
    if (size > 0)
        keep_four(all, size, contacts.distance.normal, contacts);
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
    if (found.count == 0) {
        found.points[0] = {(d.point_a + d.point_b) * 0.5, -d.distance};
        found.count = 1;
    }
    return found;
}

} // namespace boxwood::convex

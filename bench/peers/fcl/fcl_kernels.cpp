#include "bench/peers/each_case.h"
#include "bench/peers/kernel_peers.h"
#include "kernels/continuous/continuous_kernel.h"

#include <fcl/math/bv/OBB.h>
#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/detail/traversal/collision/intersect.h>

#include <array>
#include <limits>

namespace boxwood::bench {
namespace {

template <class S> fcl::Vector3<S> vector(Vec3<double> v) {
    return {static_cast<S>(v.x), static_cast<S>(v.y), static_cast<S>(v.z)};
}

template <class S> struct TrianglePair {
    std::array<fcl::Vector3<S>, 3> a, b;
    explicit TrianglePair(const TrianglePairCase& c)
        : a{vector<S>(c.a.a), vector<S>(c.a.b), vector<S>(c.a.c)}, b{vector<S>(c.b.a),
                                                                     vector<S>(c.b.b),
                                                                     vector<S>(c.b.c)} {}
};

template <class S> Decision intersect(const TrianglePair<S>& p) {
    return yes_or_no(fcl::detail::Intersect<S>::intersect_Triangle(p.a[0], p.a[1], p.a[2], p.b[0],
                                                                   p.b[1], p.b[2]));
}

template <class S> Distance distance(const TrianglePair<S>& p) {
    fcl::Vector3<S> on_a, on_b;
    const S d = fcl::detail::TriangleDistance<S>::triDistance(p.a.data(), p.b.data(), on_a, on_b);
    return plain_distance(static_cast<double>(d));
}

struct Motion {
    std::array<fcl::Vector3<double>, 4> start, end;
    explicit Motion(const MotionCase& c) {
        for (std::size_t i = 0; i < 4; ++i) {
            start[i] = vector<double>(c.motion.start[i]);
            end[i] = vector<double>(c.motion.end[i]);
        }
    }
};

Impact impact(bool hit, double t) {
    Impact result;
    if (hit)
        result = {Answer::yes, t, t, 0};
    return result;
}

Impact vertex_face(const Motion& m) {
    double t = std::numeric_limits<double>::quiet_NaN();
    fcl::Vector3<double> point;
    const bool hit = fcl::detail::Intersect<double>::intersect_VF(
        m.start[1], m.start[2], m.start[3], m.start[0], m.end[1], m.end[2], m.end[3], m.end[0], &t,
        &point);
    return impact(hit, t);
}

Impact edge_edge(const Motion& m) {
    double t = std::numeric_limits<double>::quiet_NaN();
    fcl::Vector3<double> point;
    const bool hit = fcl::detail::Intersect<double>::intersect_EE(
        m.start[0], m.start[1], m.start[2], m.start[3], m.end[0], m.end[1], m.end[2], m.end[3], &t,
        &point);
    return impact(hit, t);
}

struct ObbPair {
    fcl::OBB<double> a, b;
    explicit ObbPair(const ObbPairCase& c) : a(obb(c.a)), b(obb(c.b)) {}
    static fcl::OBB<double> obb(const Obb<double>& box) {
        fcl::Matrix3<double> axes;
        for (int k = 0; k < 3; ++k)
            axes.col(k) = vector<double>(box.axis[static_cast<std::size_t>(k)]);
        return {axes, vector<double>(box.centre), vector<double>(box.half)};
    }
};

Decision obbs(const ObbPair& p) { return yes_or_no(p.a.overlap(p.b)); }

} // namespace

std::vector<ContenderEntry> fcl_kernels() {
    using Pair = TrianglePairCase;
    const std::string stateless = "yes or no alone: no contact points; one pair per call";
    return {
        each_case<Pair, TrianglePair<double>, intersect<double>>(
            "triangle_triangle", "fcl", "intersect_triangle", "f64",
            "FCL's Intersect::intersect_Triangle: separating axes", stateless),
        each_case<Pair, TrianglePair<float>, intersect<float>>(
            "triangle_triangle", "fcl", "intersect_triangle_f32", "f32",
            "FCL's Intersect::intersect_Triangle in floats",
            stateless + "; input rounded to float"),
        each_case<Pair, TrianglePair<double>, distance<double>>(
            "triangle_distance", "fcl", "tri_distance", "f64",
            "FCL's TriangleDistance::triDistance, after PQP", "one pair per call"),
        each_case<Pair, TrianglePair<float>, distance<float>>(
            "triangle_distance", "fcl", "tri_distance_f32", "f32",
            "FCL's TriangleDistance::triDistance in floats",
            "one pair per call; input rounded to float"),
        each_case<MotionCase, Motion, vertex_face>(
            "vertex_face", "fcl", "intersect_vf", "f64",
            "FCL's Intersect::intersect_VF: cubic with Newton", "one query per call"),
        each_case<MotionCase, Motion, edge_edge>("edge_edge", "fcl", "intersect_ee", "f64",
                                                 "FCL's Intersect::intersect_EE: cubic with Newton",
                                                 "one query per call"),
        each_case<ObbPairCase, ObbPair, obbs>(
            "obb_obb", "fcl", "obb_overlap", "f64",
            "FCL's OBB::overlap: 15 separating axes with an absolute margin of 1e-6",
            "the same axes as ours; one pair per call"),
    };
}

} // namespace boxwood::bench

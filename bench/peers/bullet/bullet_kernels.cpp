#include "bench/peers/each_case.h"
#include "bench/peers/kernel_peers.h"

#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/Gimpact/btTriangleShapeEx.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <cmath>

namespace boxwood::bench {
namespace {

btVector3 vector(Vec3<double> v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// In floats, without the plane.
btPrimitiveTriangle primitive(const Triangle<double>& t) {
    btPrimitiveTriangle triangle;
    triangle.m_vertices[0] = vector(t.a);
    triangle.m_vertices[1] = vector(t.b);
    triangle.m_vertices[2] = vector(t.c);
    triangle.m_margin = 0;
    return triangle;
}

struct GimpactPair {
    btPrimitiveTriangle a, b;
    explicit GimpactPair(const TrianglePairCase& c) : a(primitive(c.a)), b(primitive(c.b)) {}
};

/// The planes are wanted first, which a mesh would make per query.
Decision gimpact(GimpactPair& p) {
    btPrimitiveTriangle &a = p.a, &b = p.b;
    a.buildTriPlane();
    b.buildTriPlane();
    if (!a.overlap_test_conservative(b))
        return yes_or_no(false);
    GIM_TRIANGLE_CONTACT contact;
    return yes_or_no(a.find_triangle_collision_clip_method(b, contact));
}

struct ShapePair {
    btTriangleShape a, b;
    explicit ShapePair(const TrianglePairCase& c)
        : a(vector(c.a.a), vector(c.a.b), vector(c.a.c)),
          b(vector(c.b.a), vector(c.b.b), vector(c.b.c)) {
        a.setMargin(0);
        b.setMargin(0);
    }
};

/// Without a solver for penetration: touching shapes come back without a result, which is 0.
Distance gjk(const ShapePair& p) {
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector detector(&p.a, &p.b, &simplex, nullptr);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformB.setIdentity();
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    return plain_distance(result.m_hasResult ? static_cast<double>(result.m_distance) : 0.0);
}

} // namespace

std::vector<ContenderEntry> bullet_kernels() {
    return {
        each_case<TrianglePairCase, GimpactPair, gimpact>(
            "triangle_triangle", "bullet", "gimpact", "f32",
            "Bullet's GIMPACT: plane test, then clipping",
            "input rounded to float; margin 0; each call makes both planes and one contact, as its "
            "mesh collision does"),
        each_case<TrianglePairCase, ShapePair, gjk>(
            "triangle_distance", "bullet", "gjk", "f32",
            "Bullet's btGjkPairDetector on two btTriangleShape",
            "input rounded to float; margin 0; no penetration solver: no result is read as 0"),
    };
}

} // namespace boxwood::bench

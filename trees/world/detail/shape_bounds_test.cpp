#include "trees/world/detail/shape_bounds.h"

#include "kernels/convex/signed_distance.h"
#include "trees/testing/shapes_at_random.h"
#include "trees/testing/triangle_soup.h"
#include "trees/world/mesh_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace boxwood::detail {
namespace {

/// Of bounds and what they are below of: none may be above, and few far below.
struct BoundJudge {
    double slack; ///< of what the truth is off by
    double sum = 0, sum_of_distances = 0;

    void operator()(double bound, const convex::SignedDistance& truth) {
        if (bound > 0) {
            EXPECT_LE(bound, truth.hi + slack);
        }
        if (truth.lo > 0) {
            sum += std::max(bound, 0.0);
            sum_of_distances += truth.lo;
        }
    }
};

/// A box of a block as a convex shape: its axes, which are floats, made orthonormal.
convex::SignedDistance distance_of_box(const ObbBlock& block, std::size_t lane,
                                       const convex::Shape& shape, const Pose& pose) {
    Pose at;
    convex::Box box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        at.translation[static_cast<int>(axis)] = block.centre_f64[axis][lane];
        box.half[static_cast<int>(axis)] = double{block.half[axis][lane]};
        for (std::size_t k = 0; k < 3; ++k)
            at.rotation[axis][static_cast<int>(k)] = double{block.axis[k][axis][lane]};
    }
    for (int step = 0; step < 3; ++step)
        at.rotation = orthonormalised(at.rotation);
    return convex::signed_distance(box, at, shape, pose);
}

TEST(ShapeBounds, AreBelowTheDistancesAndNearThem) {
    ShapesAtRandom shapes(11);
    for (const convex::ShapeKind kind : all_shape_kinds()) {
        SCOPED_TRACE(std::string(to_string(kind)));
        BoundJudge of_boxes{1e-6}, of_triangles{0};
        for (std::uint32_t seed = 0; seed < 6; ++seed) {
            const MeshTree tree(seed % 2 == 0 ? noisy_sphere(7, 9, .2, seed)
                                              : triangle_soup(120, seed));
            const convex::Shape shape = shapes.shape(kind);
            const Pose pose = shapes.pose(2.5);
            const Envelope envelope(shape, pose);
            double bounds[8];
            for (const ObbBlock& block : tree.blocks()) {
                bound_boxes(envelope, block, bounds);
                for (std::size_t lane = 0; lane < block.count; ++lane)
                    of_boxes(bounds[lane], distance_of_box(block, lane, shape, pose));
            }
            for (const TriangleLeaf& leaf : tree.leaves()) {
                bound_triangles(envelope, leaf, bounds);
                for (std::size_t lane = 0; lane < leaf.count; ++lane) {
                    const convex::Triangle t{leaf.corner_f64(0, lane), leaf.corner_f64(1, lane),
                                             leaf.corner_f64(2, lane)};
                    of_triangles(bounds[lane], convex::signed_distance(t, Pose{}, shape, pose));
                }
            }
        }
        EXPECT_GT(of_boxes.sum, .8 * of_boxes.sum_of_distances);
        EXPECT_GT(of_triangles.sum, .8 * of_triangles.sum_of_distances);
    }
}

TEST(ShapeBounds, OfPointsAndSegmentsOfAllSizes) {
    for (const double size : {0x1p-60, 1.0, 0x1p40}) {
        TriangleMesh mesh;
        const auto s = static_cast<float>(size);
        mesh.vertices = {{s, 0, 0}, {s, s, 0}, {s, 0, s}, {3 * s, 0, 0}};
        mesh.triangles = {{0, 1, 2}, {3, 3, 3}, {0, 1, 1}};
        const MeshTree tree(mesh);
        for (const convex::Shape& shape :
             {convex::Shape(convex::Sphere{size / 4}), convex::Shape(convex::Box{{0, 0, 0}}),
              convex::Shape(convex::Cylinder{size / 4, size}),
              convex::Shape(convex::Ellipsoid{{size / 2, size, size}})}) {
            double bounds[8];
            for (const TriangleLeaf& leaf : tree.leaves()) {
                bound_triangles(Envelope(shape, Pose{}), leaf, bounds);
                for (std::size_t lane = 0; lane < leaf.count; ++lane) {
                    const convex::Triangle t{leaf.corner_f64(0, lane), leaf.corner_f64(1, lane),
                                             leaf.corner_f64(2, lane)};
                    const convex::SignedDistance d =
                        convex::signed_distance(t, Pose{}, shape, Pose{});
                    EXPECT_LE(bounds[lane], d.hi);
                    EXPECT_GT(bounds[lane], .9 * d.lo) << to_string(shape.kind()) << " " << size;
                }
            }
        }
    }
}

} // namespace
} // namespace boxwood::detail

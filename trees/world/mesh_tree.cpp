/// From triangles to a MeshTree: a binary tree over their boxes, collapsed to blocks of eight, and
/// around each block the smaller of two boxes, along the principal axes of the triangles below and
/// along the mesh's own.

#include "trees/world/mesh_tree.h"

#include "kernels/arithmetic/rounding.h"
#include "kernels/primitives/coordinate_limit.h"
#include "trees/layouts/detail/collapse.h"
#include "trees/triangle_boxes.h"
#include "trees/world/detail/obb_fit.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace boxwood {
namespace {

using namespace detail;

constexpr std::size_t chunk = 64; // blocks to a task

constexpr MeshVolumeEntry volumes[] = {
    {"obb", "eight boxes in any pose side by side, leaves of up to eight triangles",
     MeshVolume::obb},
    {"aabb", "the same with boxes along the mesh's axes: quicker to make, longer to search",
     MeshVolume::aabb},
};

void require_range(const Buffer<Box>& boxes) {
    constexpr float limit = static_cast<float>(coordinate_limit);
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(boxes[i].min[axis] > -limit && boxes[i].max[axis] < limit))
                throw InvalidBox(i, "its triangle has a coordinate beyond 2^60");
}

/// The corners of all triangles in the order of the tree's leaves.
class Corners {
  public:
    Corners(const TriangleMesh& mesh, const Buffer<std::uint32_t>& order, const Executor& executor)
        : stride_((order.size() + 31) / 16 * 16), floats_(9 * stride_) {
        executor.for_each((order.size() + 4095) / 4096, [&](std::size_t c) {
            for (std::size_t slot = c * 4096; slot < std::min(order.size(), (c + 1) * 4096);
                 ++slot) {
                const Triangle<float> t = mesh.triangle(order[slot]);
                const Vec3<float>* corners[3] = {&t.a, &t.b, &t.c};
                for (std::size_t k = 0; k < 3; ++k)
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        row(k, axis)[slot] = (*corners[k])[static_cast<int>(axis)];
            }
        });
        for (std::size_t k = 0; k < 9; ++k)
            std::fill(&floats_[k * stride_ + order.size()], floats_.data() + (k + 1) * stride_,
                      0.0f);
    }
    float* row(std::size_t corner, std::size_t axis) {
        return floats_.data() + (3 * corner + axis) * stride_;
    }
    CornerRows rows() {
        CornerRows rows{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                rows.of[k][axis] = row(k, axis);
        return rows;
    }

  private:
    std::size_t stride_;
    Buffer<float> floats_;
};

/// The boxes of all blocks of a collapsed tree, by the number of the block.
class Fitting {
  public:
    Fitting(const Tree& tree, const Collapsed& collapsed, Corners& corners,
            const Executor& executor)
        : tree_(tree), blocks_(collapsed.blocks), corners_(corners), executor_(executor) {}

    Buffer<PosedBox> along_the_mesh() {
        Buffer<PosedBox> boxes(blocks_.size());
        for_each_block([&](std::size_t i) { boxes[i] = box_of(tree_.nodes[blocks_[i].node].box); });
        return boxes;
    }

    Buffer<PosedBox> in_any_pose() {
        const std::size_t n = (blocks_.size() + 15) / 16 * 16;
        Buffer<float> matrices(6 * n), axes(9 * n);
        find_covariances(matrices, n);
        const auto row = [n](Buffer<float>& rows, std::size_t k) { return rows.data() + k * n; };
        SymmetricRows in{};
        for (std::size_t k = 0; k < 6; ++k)
            in.of[k] = row(matrices, k);
        float* const out[9] = {row(axes, 0), row(axes, 1), row(axes, 2), row(axes, 3), row(axes, 4),
                               row(axes, 5), row(axes, 6), row(axes, 7), row(axes, 8)};
        principal_axes(in, n, out);
        Buffer<PosedBox> boxes(blocks_.size());
        const CornerRows rows = corners_.rows();
        for_each_block([&](std::size_t i) {
            const TreeNode& node = tree_.nodes[blocks_[i].node];
            float own[9];
            for (std::size_t k = 0; k < 9; ++k)
                own[k] = out[k][i];
            const PosedBox straight = box_of(node.box);
            const PosedBox turned =
                box_along(own, rows, node.first, std::size_t{node.first} + node.count, node.box);
            boxes[i] = half_area(turned) < half_area(straight) ? turned : straight;
        });
        return boxes;
    }

  private:
    static double half_area(const PosedBox& box) {
        const double x = double{box.half[0]}, y = double{box.half[1]}, z = double{box.half[2]};
        return x * y + y * z + z * x;
    }
    template <class F> void for_each_block(const F& f) {
        executor_.for_each((blocks_.size() + chunk - 1) / chunk, [&](std::size_t c) {
            for (std::size_t i = c * chunk; i < std::min(blocks_.size(), (c + 1) * chunk); ++i)
                f(i);
        });
    }

    /// Each about its own mean, its trace 1, or 0 where the triangles have no area.
    void find_covariances(Buffer<float>& matrices, std::size_t n) {
        const Aabb<float>& box = tree_.nodes[0].box;
        // Seen from the middle, and about of size 1.
        const Vec3<double> centre = 0.5 * (Vec3<double>(box.min) + Vec3<double>(box.max));
        const Vec3<double> sides = Vec3<double>(box.max) - Vec3<double>(box.min);
        const double largest = std::max({sides.x, sides.y, sides.z});
        const double scale = largest > 0x1p-100 ? 1 / largest : 1;
        const CornerRows rows = corners_.rows();
        Buffer<Moments> moments(blocks_.size());
        for_each_block([&](std::size_t i) {
            moments[i] = {};
            if (blocks_[i].count > 0)
                return;
            const TreeNode& node = tree_.nodes[blocks_[i].node];
            moments[i] = moments_of(rows, node.first, node.count, centre, scale);
        });
        for (std::size_t i = blocks_.size(); i-- > 0;) // children have higher numbers
            for (std::uint32_t k = 0; k < blocks_[i].count; ++k)
                moments[i].add(moments[blocks_[i].first + k]);
        for_each_block([&](std::size_t i) {
            const Moments& m = moments[i];
            double covariance[6] = {};
            std::size_t at = 0;
            if (m.area > 0)
                for (std::size_t j = 0; j < 3; ++j)
                    for (std::size_t k = j; k < 3; ++k, ++at)
                        covariance[at] = m.second[at] - m.first[j] * m.first[k] / m.area;
            const double trace = covariance[0] + covariance[3] + covariance[5];
            for (std::size_t k = 0; k < 6; ++k)
                matrices[k * n + i] = trace > 0 ? static_cast<float>(covariance[k] / trace) : 0.0f;
        });
        for (std::size_t k = 0; k < 6; ++k)
            std::fill(&matrices[k * n + blocks_.size()], matrices.data() + (k + 1) * n, 0.0f);
    }

    const Tree& tree_;
    const Buffer<CollapsedBlock>& blocks_;
    Corners& corners_;
    const Executor& executor_;
};

double sum_of_halves(const PosedBox& box) {
    return double{box.half[0]} + double{box.half[1]} + double{box.half[2]};
}

BoundingSphere bounding_sphere_of(const Aabb<float>& bounds, const CornerRows& corners,
                                  std::size_t triangles) {
    BoundingSphere sphere;
    float centre[3];
    for (int axis = 0; axis < 3; ++axis) {
        const double low = double{bounds.min[axis]}, high = double{bounds.max[axis]};
        centre[axis] = static_cast<float>(0.5 * (low + high));
        sphere.centre[axis] = double{centre[axis]};
        sphere.reach += std::max(std::abs(low), std::abs(high));
    }
    sphere.radius = farthest_from(centre, corners, triangles);
    return sphere;
}

void set_lane(ObbBlock& block, std::size_t lane, const PosedBox& box, std::uint32_t ref) {
    double reach = sum_of_halves(box);
    for (std::size_t k = 0; k < 3; ++k) {
        const double from_own = box.centre[k] - block.own.centre[k];
        reach += std::abs(from_own);
        block.centre[k][lane] = static_cast<float>(from_own);
        block.centre_f64[k][lane] = box.centre[k];
        block.half[k][lane] = box.half[k];
        for (std::size_t axis = 0; axis < 3; ++axis)
            block.axis[k][axis][lane] = box.axis[k][axis];
    }
    block.slack[lane] = box.slack;
    block.ref[lane] = ref;
    block.own.reach = std::max(block.own.reach, round_up(reach * (1 + 0x1p-40)));
}

} // namespace

std::span<const MeshVolumeEntry> mesh_volumes() { return volumes; }

MeshTree::MeshTree(TriangleMesh mesh, const MeshTreeOptions& options) : mesh_(std::move(mesh)) {
    const Executor& executor = options.executor ? *options.executor : serial();
    const Buffer<Box> boxes = triangle_boxes(mesh_, executor);
    if (empty())
        return;
    require_range(boxes);
    const Tree tree = options.builder(boxes.span(), executor);
    if (tree.is_split)
        throw std::invalid_argument("a tree of parts of triangles is for rays, not for pairs");
    bounds_ = tree.nodes[0].box;
    const Collapsed collapsed = collapse<ObbBlock::width>(tree, executor);
    const Buffer<CollapsedBlock>& from = collapsed.blocks;
    depth_ = collapsed.depth;
    Corners corners(mesh_, tree.order, executor);
    bounding_sphere_ = bounding_sphere_of(bounds_, corners.rows(), size());
    Fitting fitting(tree, collapsed, corners, executor);
    const Buffer<PosedBox> fitted =
        options.volume == MeshVolume::obb ? fitting.in_any_pose() : fitting.along_the_mesh();

    // References, inner blocks and leaves counted apart.
    Buffer<std::uint32_t> refs(from.size());
    std::uint32_t inner = 0, leaves = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
        refs[i] = from[i].count > 0 ? inner++ : leaves++ | leaf_bit;
    root_ = refs[0];
    blocks_ = Buffer<ObbBlock>(inner);
    leaves_ = Buffer<TriangleLeaf>(leaves);
    executor.for_each((from.size() + chunk - 1) / chunk, [&](std::size_t c) {
        for (std::size_t i = c * chunk; i < std::min(from.size(), (c + 1) * chunk); ++i) {
            PosedBox own = fitted[i];
            own.reach = round_up(sum_of_halves(own));
            if (from[i].count > 0) {
                ObbBlock& block = blocks_[refs[i]];
                block = {};
                block.own = own;
                block.count = from[i].count;
                for (std::uint32_t k = 0; k < block.count; ++k)
                    set_lane(block, k, fitted[from[i].first + k], refs[from[i].first + k]);
                continue;
            }
            TriangleLeaf& leaf = leaves_[index_of(refs[i])];
            const TreeNode& node = tree.nodes[from[i].node];
            leaf.own = own;
            leaf.count = node.count;
            for (std::uint32_t lane = 0; lane < TriangleLeaf::width; ++lane)
                leaf.triangle[lane] = tree.order[node.first + (lane < node.count ? lane : 0)];
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    float(&row)[TriangleLeaf::width] = leaf.corner[k][axis];
                    std::memcpy(row, corners.row(k, axis) + node.first, sizeof row);
                    std::fill(row + node.count, std::end(row), row[0]);
                }
        }
    });
}

} // namespace boxwood

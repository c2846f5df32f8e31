#include "scenes/sampling/poses.h"

#include "kernels/primitives/rotation.h"
#include "kernels/suggest.h"
#include "scenes/sampling/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

/// How far the two are apart, in parts of the mesh's width along the direction; below 0: overlap.
struct PoseKind {
    std::string_view name, summary;
    double gap;
    bool is_path = false; ///< each is a degree on from the one before
    /// Not turned, apart where the mesh is thinnest, in parts of its greatest width.
    bool is_parallel = false;
    /// Not 1: the copy is so much larger than the mesh, and around it.
    double scale = 1;
};
constexpr PoseKind kinds[] = {
    {"apart", "half its width away from the mesh", .5},
    {"near", "a hundredth of its width away", .01},
    {"shallow", "overlapping by a fiftieth of its width, which need not touch", -.02},
    {"deep", "overlapping by half its width", -.5},
    {"along", "a hundredth of its width away, each a degree on from the one before", .01, true},
    {"parallel", "not turned, a hundredth of its width away from its flattest side", .01, false,
     true},
    {"nested", "around the mesh, not turned: a hundredth larger, and shifted by less", .1, false,
     false, 1.01},
    {"nested_closely", "around the mesh, not turned: a thousandth larger, and shifted by less", .1,
     false, false, 1.001},
};

constexpr PoseKindEntry paths[] = {
    {"linear", "its origin on a straight line, while it turns by the smaller angle"},
    {"screw", "a turn about one axis of space and a slide along it"},
};

struct Extent {
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
};
Extent extent_along(const Vec& direction, const TriangleMesh& mesh) {
    Extent extent;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle) {
            const double h = dot(direction, Vec(mesh.vertices[vertex]));
            extent.least = std::min(extent.least, h);
            extent.greatest = std::max(extent.greatest, h);
        }
    return extent;
}

Vec middle_of(const TriangleMesh& mesh) {
    Aabb<double> box;
    for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t vertex : triangle)
            box.extend(Vec(mesh.vertices[vertex]));
    return 0.5 * (box.min + box.max);
}

/// The copy is shifted by less than what it is larger by.
RigidTransform<double> nested_pose(const TriangleMesh& mesh, const PoseKind& of, Draws& draws) {
    double thinnest = std::numeric_limits<double>::infinity();
    for (const Vec along : {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}}) {
        const Extent extent = extent_along(along, mesh);
        thinnest = std::min(thinnest, extent.greatest - extent.least);
    }
    RigidTransform<double> pose;
    pose.translation = (of.gap * (of.scale - 1) * thinnest / 2) * draws.in_ball();
    return pose;
}

/// The copy is shifted along the mesh, too, by up to a tenth.
RigidTransform<double> parallel_pose(const TriangleMesh& mesh, double gap, Draws& draws) {
    int thinnest = 0, widest = 0;
    Vec widths;
    for (int axis = 0; axis < 3; ++axis) {
        Vec along{};
        along[axis] = 1;
        const Extent extent = extent_along(along, mesh);
        widths[axis] = extent.greatest - extent.least;
        if (widths[axis] < widths[thinnest])
            thinnest = axis;
        if (widths[axis] > widths[widest])
            widest = axis;
    }
    RigidTransform<double> pose;
    for (int axis = 0; axis < 3; ++axis)
        pose.translation[axis] = axis == thinnest ? widths[axis] + gap * widths[widest]
                                                  : .1 * (2 * draws.uniform() - 1) * widths[axis];
    return pose;
}

const PoseKind& kind_named(std::string_view name) {
    check_pose_kind(name);
    return *std::ranges::find(kinds, name, &PoseKind::name);
}

} // namespace

Rotation rotation_of(Draws& draws) {
    for (;;) {
        std::array<double, 4> q{};
        double squared = 0;
        for (double& x : q) {
            x = 2 * draws.uniform() - 1;
            squared += x * x;
        }
        if (squared > 1 || squared < 0x1p-20)
            continue;
        const double s = 2 / squared;
        const auto [w, x, y, z] = q;
        return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
                 {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
                 {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
    }
}

std::span<const PoseKindEntry> pose_kinds() {
    static constexpr auto entries = [] {
        std::array<PoseKindEntry, std::size(kinds)> all;
        std::ranges::transform(kinds, all.begin(), [](const PoseKind& kind) {
            return PoseKindEntry{kind.name, kind.summary};
        });
        return all;
    }();
    return entries;
}

void check_pose_kind(std::string_view kind) { entry_named(kind, pose_kinds(), "kind of poses"); }

std::span<const PoseKindEntry> motion_paths() { return paths; }

void check_motion_path(std::string_view path) {
    entry_named(path, motion_paths(), "path of a motion");
}

std::vector<RigidTransform<double>> make_poses(std::string_view kind, const TriangleMesh& mesh,
                                               std::size_t n, std::uint64_t seed) {
    if (mesh.triangles.empty())
        throw std::invalid_argument("poses: the mesh has no triangles to place a copy of");
    const PoseKind& of = kind_named(kind);
    // About a degree: rational, so that every machine gets the same bits.
    constexpr double t = 1. / 115, sine = 2 * t / (1 + t * t), cosine = (1 - t * t) / (1 + t * t);
    Rotation turned{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, swung = turned;
    const Vec middle = middle_of(mesh);
    const Random numbers(seed, "poses");
    std::vector<RigidTransform<double>> poses(n);
    for (std::size_t i = 0; i < n; ++i) {
        Draws draws = numbers.item(of.is_path ? 0 : i);
        RigidTransform<double>& pose = poses[i];
        if (of.is_parallel || of.scale != 1) {
            pose =
                of.is_parallel ? parallel_pose(mesh, of.gap, draws) : nested_pose(mesh, of, draws);
            continue;
        }
        pose.rotation = rotation_of(draws);
        Vec way = draws.unit_vector();
        if (of.is_path) {
            pose.rotation = product(turned, pose.rotation);
            way = times(swung, way);
            turned =
                orthonormalised(product(rotation_about(draws.unit_vector(), sine, cosine), turned));
            swung =
                orthonormalised(product(rotation_about(draws.unit_vector(), sine, cosine), swung));
        }
        const auto& [r0, r1, r2] = pose.rotation;
        const Vec way_in_copy = way.x * r0 + way.y * r1 + way.z * r2;
        const Extent own = extent_along(way, mesh), copy = extent_along(way_in_copy, mesh);
        // The middles on one line, then apart along it.
        pose.translation = middle - pose(middle);
        const double between = dot(way, pose.translation);
        const double width = own.greatest - own.least;
        pose.translation =
            pose.translation + (own.greatest - (copy.least + between) + of.gap * width) * way;
    }
    return poses;
}

TriangleMesh make_copy(std::string_view kind, const TriangleMesh& mesh) {
    const PoseKind& of = kind_named(kind);
    if (of.scale == 1)
        return {};
    TriangleMesh copy = mesh;
    const Vec middle = middle_of(mesh);
    for (Vec3<float>& v : copy.vertices)
        v = static_cast<Vec3<float>>(middle + of.scale * (Vec(v) - middle));
    return copy;
}

} // namespace boxwood

#include "trees/world/bodies/body_shape.h"

#include "kernels/boxes/fit.h"
#include "kernels/convex/support.h"
#include "kernels/primitives/coordinate_limit.h"
#include "trees/queries/sides.h"

#include <atomic>
#include <cmath>
#include <initializer_list>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

double norm1(const Vec3<double>& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

void require_sizes(convex::ShapeKind kind, std::initializer_list<double> sizes) {
    for (const double size : sizes)
        if (!(size >= 0 && size < coordinate_limit))
            throw std::invalid_argument(std::string(to_string(kind)) + ": its size " +
                                        std::to_string(size) +
                                        " is negative, not a number or beyond 2^60");
}
void require_points(convex::ShapeKind kind, std::span<const Vec3<double>> points) {
    for (const Vec3<double>& p : points)
        if (!is_in_range(p))
            throw std::invalid_argument(std::string(to_string(kind)) + ": point " +
                                        std::to_string(&p - points.data()) +
                                        " is not finite or beyond 2^60");
}

void require_valid(const convex::Shape& shape) {
    const convex::ShapeKind kind = shape.kind();
    shape.visit([&]<class S>(const S& s) {
        if constexpr (std::is_same_v<S, convex::Sphere>) {
            require_sizes(kind, {s.radius});
        } else if constexpr (std::is_same_v<S, convex::Box>) {
            require_sizes(kind, {s.half.x, s.half.y, s.half.z});
        } else if constexpr (std::is_same_v<S, convex::Ellipsoid>) {
            require_sizes(kind, {s.radii.x, s.radii.y, s.radii.z});
        } else if constexpr (std::is_same_v<S, convex::Hull>) {
            if (s.points().empty())
                throw std::invalid_argument("hull: there is no point");
            require_points(kind, s.points());
        } else if constexpr (std::is_same_v<S, convex::Triangle>) {
            const Vec3<double> corners[] = {s.a, s.b, s.c};
            require_points(kind, corners);
        } else if constexpr (convex::BoundedShape<S>) {
            require_sizes(kind, {s.radius, s.half_length});
        } else {
            const double size = norm1(s.normal);
            if (!(size > 0 && size < coordinate_limit && std::abs(s.offset) < coordinate_limit))
                throw std::invalid_argument(std::string(to_string(kind)) +
                                            ": its normal is 0, or a number is not finite or "
                                            "beyond 2^60");
        }
    });
}

/// Those of its triangles. Throws as MeshTree.
Aabb<float> bounds_of(const TriangleMesh& mesh) {
    Aabb<float> bounds;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (const std::uint32_t vertex : mesh.triangles[i]) {
            if (vertex >= mesh.vertices.size())
                throw std::invalid_argument("triangle " + std::to_string(i) + " has vertex " +
                                            std::to_string(vertex) + ", and there are " +
                                            std::to_string(mesh.vertices.size()));
            const Vec3<float>& p = mesh.vertices[vertex];
            if (!is_in_range(p))
                throw InvalidBox(i, "its triangle has a coordinate that is not finite or beyond "
                                    "2^60");
            bounds.extend(p);
        }
    return bounds;
}

} // namespace

struct BodyShape::Held {
    explicit Held(ShapeClass of) : shape_class(of) {}

    ShapeClass shape_class;
    Aabb<double> bounds;
    double radius = 0;

    convex::Shape convex_shape;
    std::vector<Vec3<double>> hull_points;

    MeshTreeOptions options;
    mutable std::once_flag build_once, parts_once;
    mutable std::atomic<bool> is_built = true;
    mutable TriangleMesh mesh; ///< until the tree is built, whose it is then
    mutable std::shared_ptr<const MeshTree> tree;
    mutable std::optional<Solid> solid;
    mutable std::optional<detail::MeshParts> parts;

    bool build() const {
        bool was_to_do = false;
        std::call_once(build_once, [&] {
            // Of a copy, which is asked for again if this throws.
            if (shape_class == ShapeClass::surface && !tree)
                tree = std::make_shared<const MeshTree>(mesh, options);
            else if (shape_class == ShapeClass::solid)
                solid.emplace(mesh, options);
            else
                return;
            mesh = {};
            was_to_do = true;
            is_built = true;
        });
        return was_to_do;
    }
};

BodyShape::BodyShape(const convex::Shape& shape) {
    require_valid(shape);
    const auto held = std::make_shared<Held>(ShapeClass::convex);
    held->convex_shape = shape;
    if (const auto* given = shape.get_if<convex::Hull>()) {
        held->hull_points.assign(given->points().begin(), given->points().end());
        held->convex_shape = convex::Hull(held->hull_points);
    }
    held->bounds = convex::bounds(held->convex_shape, Pose{});
    held_ = held;
}

BodyShape BodyShape::hull(std::vector<Vec3<double>> points) { return convex::Hull(points); }

BodyShape BodyShape::of_mesh(ShapeClass of, TriangleMesh mesh, const MeshTreeOptions& options,
                             double radius) {
    const auto held = std::make_shared<Held>(of);
    held->bounds = Aabb<double>(bounds_of(mesh));
    held->radius = radius;
    held->options = options;
    held->options.executor = nullptr; // it might be gone by then
    held->mesh = std::move(mesh);
    held->is_built = false;
    return BodyShape(held);
}

BodyShape BodyShape::surface(TriangleMesh mesh, const MeshTreeOptions& options) {
    return of_mesh(ShapeClass::surface, std::move(mesh), options, 0);
}

BodyShape BodyShape::surface(std::shared_ptr<const MeshTree> tree) {
    const auto held = std::make_shared<Held>(ShapeClass::surface);
    if (!tree->empty())
        held->bounds = Aabb<double>(tree->bounds());
    held->tree = std::move(tree);
    return BodyShape(held);
}

BodyShape BodyShape::solid(TriangleMesh mesh, const MeshTreeOptions& options) {
    BodyShape shape = of_mesh(ShapeClass::solid, std::move(mesh), options, 0);
    if (const std::size_t open = open_edges(shape.held_->mesh))
        throw std::invalid_argument("the mesh is no solid: " + std::to_string(open) +
                                    " of its edges belong to an odd number of triangles");
    return shape;
}

BodyShape BodyShape::solid_if_closed(TriangleMesh mesh, const MeshTreeOptions& options) {
    const bool is_closed = open_edges(mesh) == 0;
    return of_mesh(is_closed ? ShapeClass::solid : ShapeClass::surface, std::move(mesh), options,
                   0);
}

/// Triangles whose corners are one point.
BodyShape BodyShape::points(std::span<const Vec3<float>> points, double radius) {
    if (!(radius >= 0 && radius < coordinate_limit))
        throw std::invalid_argument("the radius of points is negative, not a number or beyond "
                                    "2^60");
    TriangleMesh mesh{{points.begin(), points.end()}, {}};
    for (std::uint32_t i = 0; i < points.size(); ++i)
        mesh.triangles.push_back({i, i, i});
    return of_mesh(ShapeClass::surface, std::move(mesh), {}, radius);
}

BodyShape BodyShape::height_field(std::size_t columns, std::span<const float> heights, float step_x,
                                  float step_y) {
    const std::size_t rows = columns ? heights.size() / columns : 0;
    if (columns < 2 || rows < 2 || rows * columns != heights.size())
        throw std::invalid_argument("a height field has at least 2 columns and 2 rows, and "
                                    "columns x rows heights: " +
                                    std::to_string(columns) + " columns, " +
                                    std::to_string(heights.size()) + " heights");
    TriangleMesh mesh;
    for (std::size_t j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < columns; ++i)
            mesh.vertices.push_back({static_cast<float>(i) * step_x, static_cast<float>(j) * step_y,
                                     heights[j * columns + i]});
    for (std::size_t j = 0; j + 1 < rows; ++j)
        for (std::size_t i = 0; i + 1 < columns; ++i) {
            const auto a = static_cast<std::uint32_t>(j * columns + i),
                       c = a + static_cast<std::uint32_t>(columns);
            mesh.triangles.push_back({a, a + 1, c + 1});
            mesh.triangles.push_back({a, c + 1, c});
        }
    return surface(std::move(mesh));
}

ShapeClass BodyShape::shape_class() const { return held_->shape_class; }
const Aabb<double>& BodyShape::bounds() const { return held_->bounds; }
bool BodyShape::is_bounded() const {
    const auto kind = held_->convex_shape.kind();
    return shape_class() != ShapeClass::convex ||
           (kind != convex::ShapeKind::half_space && kind != convex::ShapeKind::plane);
}
double BodyShape::radius() const { return held_->radius; }
const convex::Shape& BodyShape::convex_shape() const { return held_->convex_shape; }

const MeshTree& BodyShape::tree() const {
    held_->build();
    return shape_class() == ShapeClass::solid ? held_->solid->surface() : *held_->tree;
}
const Solid& BodyShape::solid() const {
    held_->build();
    return *held_->solid;
}
const detail::MeshParts& BodyShape::parts() const {
    std::call_once(held_->parts_once, [&] { held_->parts.emplace(tree().mesh()); });
    return *held_->parts;
}
bool BodyShape::is_built() const { return held_->is_built; }
bool BodyShape::build() const { return held_->build(); }

/// The corners of a mesh are moved into the frame of another one and rounded there: off by a few
/// units in the last place of where both are and of how far they reach. Bodies whose boxes just
/// miss each other are about as far from the origin as one another, so that each side pads by its
/// own share, with room.
Aabb<double> BodyShape::bounds_at(const Pose& pose) const {
    if (empty())
        return {};
    Aabb<double> box = shape_class() == ShapeClass::convex ? convex::bounds(convex_shape(), pose)
                                                           : fit(pose, bounds());
    if (!is_bounded())
        return box;
    const auto& [low, high] = bounds();
    const double reach = norm1(max(-low, high));
    const double by = radius() * (1 + 0x1p-50) + 0x1p-44 * (norm1(pose.translation) + reach);
    box.min = box.min - Vec3<double>{by, by, by};
    box.max = box.max + Vec3<double>{by, by, by};
    return box;
}

} // namespace boxwood

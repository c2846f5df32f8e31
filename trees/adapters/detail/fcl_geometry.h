#pragma once

#include "trees/adapters/detail/recorded_geometry.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>

#include <array>
#include <cstddef>
#include <vector>

namespace boxwood::detail {

template <class S, class Volume>
void take_mesh(const fcl::CollisionGeometry<S>& from, RecordedGeometry& to) {
    const auto& model = static_cast<const fcl::BVHModel<Volume>&>(from);
    to.shape = recording::Shape::mesh;
    for (int i = 0; i < model.num_vertices; ++i)
        to.add_vertex(model.vertices[i]);
    for (int i = 0; i < model.num_tris; ++i)
        to.add_triangle(model.tri_indices[i]);
}

template <class S> RecordedGeometry recorded(const fcl::CollisionGeometry<S>& from) {
    using recording::Shape;
    RecordedGeometry to;
    const auto round = [&]<class Of>(Shape shape, const Of& of) {
        to.take(shape, {of.radius, of.lz});
    };
    switch (from.getNodeType()) {
    case fcl::BV_AABB:
        take_mesh<S, fcl::AABB<S>>(from, to);
        break;
    case fcl::BV_OBB:
        take_mesh<S, fcl::OBB<S>>(from, to);
        break;
    case fcl::BV_RSS:
        take_mesh<S, fcl::RSS<S>>(from, to);
        break;
    case fcl::BV_kIOS:
        take_mesh<S, fcl::kIOS<S>>(from, to);
        break;
    case fcl::BV_OBBRSS:
        take_mesh<S, fcl::OBBRSS<S>>(from, to);
        break;
    case fcl::BV_KDOP16:
        take_mesh<S, fcl::KDOP<S, 16>>(from, to);
        break;
    case fcl::BV_KDOP18:
        take_mesh<S, fcl::KDOP<S, 18>>(from, to);
        break;
    case fcl::BV_KDOP24:
        take_mesh<S, fcl::KDOP<S, 24>>(from, to);
        break;
    case fcl::GEOM_BOX: {
        const auto& side = static_cast<const fcl::Box<S>&>(from).side;
        to.take(Shape::box, {side[0], side[1], side[2]});
        break;
    }
    case fcl::GEOM_ELLIPSOID: {
        const auto& radii = static_cast<const fcl::Ellipsoid<S>&>(from).radii;
        to.take(Shape::ellipsoid, {radii[0], radii[1], radii[2]});
        break;
    }
    case fcl::GEOM_SPHERE:
        to.take(Shape::sphere, {static_cast<const fcl::Sphere<S>&>(from).radius});
        break;
    case fcl::GEOM_CAPSULE:
        round(Shape::capsule, static_cast<const fcl::Capsule<S>&>(from));
        break;
    case fcl::GEOM_CONE:
        round(Shape::cone, static_cast<const fcl::Cone<S>&>(from));
        break;
    case fcl::GEOM_CYLINDER:
        round(Shape::cylinder, static_cast<const fcl::Cylinder<S>&>(from));
        break;
    case fcl::GEOM_PLANE:
        to.take_flat(Shape::plane, static_cast<const fcl::Plane<S>&>(from));
        break;
    case fcl::GEOM_HALFSPACE:
        to.take_flat(Shape::half_space, static_cast<const fcl::Halfspace<S>&>(from));
        break;
    case fcl::GEOM_CONVEX: {
        const auto& of = static_cast<const fcl::Convex<S>&>(from);
        to.shape = Shape::convex;
        for (const auto& vertex : of.getVertices())
            to.add_vertex(vertex);
        const std::vector<int>& faces = of.getFaces(); // number of corners, corners, ...
        for (std::size_t at = 0; at < faces.size(); at += static_cast<std::size_t>(faces[at]) + 1)
            for (std::size_t i = 3; i <= static_cast<std::size_t>(faces[at]); ++i)
                to.add_triangle(std::array{faces[at + 1], faces[at + i - 1], faces[at + i]});
        break;
    }
    default:
        break;
    }
    return to;
}

} // namespace boxwood::detail

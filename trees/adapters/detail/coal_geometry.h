#pragma once

#include "trees/adapters/detail/recorded_geometry.h"

#include <coal/BVH/BVH_model.h>
#include <coal/shape/convex.h>
#include <coal/shape/geometric_shapes.h>

#include <array>

namespace boxwood::detail {

/// A shape with a swept sphere around it is known by its bounds alone.
inline RecordedGeometry recorded(const coal::CollisionGeometry& from) {
    using recording::Shape;
    RecordedGeometry to;
    const auto round = [&]<class Of>(Shape shape, const Of& of) {
        to.take(shape, {of.radius, 2 * of.halfLength});
    };
    if (const auto* model = dynamic_cast<const coal::BVHModelBase*>(&from)) {
        if (!model->vertices || !model->tri_indices)
            return to;
        to.shape = Shape::mesh;
        for (unsigned i = 0; i < model->num_vertices; ++i)
            to.add_vertex((*model->vertices)[i]);
        for (unsigned i = 0; i < model->num_tris; ++i)
            to.add_triangle((*model->tri_indices)[i]);
        return to;
    }
    const auto* shape = dynamic_cast<const coal::ShapeBase*>(&from);
    if (!shape || shape->getSweptSphereRadius() != 0)
        return to;
    switch (from.getNodeType()) {
    case coal::GEOM_BOX: {
        const auto& half = static_cast<const coal::Box&>(from).halfSide;
        to.take(Shape::box, {2 * half[0], 2 * half[1], 2 * half[2]});
        break;
    }
    case coal::GEOM_ELLIPSOID: {
        const auto& radii = static_cast<const coal::Ellipsoid&>(from).radii;
        to.take(Shape::ellipsoid, {radii[0], radii[1], radii[2]});
        break;
    }
    case coal::GEOM_SPHERE:
        to.take(Shape::sphere, {static_cast<const coal::Sphere&>(from).radius});
        break;
    case coal::GEOM_CAPSULE:
        round(Shape::capsule, static_cast<const coal::Capsule&>(from));
        break;
    case coal::GEOM_CONE:
        round(Shape::cone, static_cast<const coal::Cone&>(from));
        break;
    case coal::GEOM_CYLINDER:
        round(Shape::cylinder, static_cast<const coal::Cylinder&>(from));
        break;
    case coal::GEOM_PLANE:
        to.take_flat(Shape::plane, static_cast<const coal::Plane&>(from));
        break;
    case coal::GEOM_HALFSPACE:
        to.take_flat(Shape::half_space, static_cast<const coal::Halfspace&>(from));
        break;
    case coal::GEOM_CONVEX: {
        const auto* of = dynamic_cast<const coal::Convex<coal::Triangle>*>(&from);
        if (!of || !of->points || !of->polygons)
            break;
        to.shape = Shape::convex;
        for (unsigned i = 0; i < of->num_points; ++i)
            to.add_vertex((*of->points)[i]);
        for (unsigned i = 0; i < of->num_polygons; ++i)
            to.add_triangle((*of->polygons)[i]);
        break;
    }
    default:
        break;
    }
    return to;
}

} // namespace boxwood::detail

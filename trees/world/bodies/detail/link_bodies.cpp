#include "trees/world/bodies/detail/link_bodies.h"

#include "trees/world/bodies/robot_meshes.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace boxwood::detail {

BodyShape LinkBodies::make(const LinkDescription& link, const LinkShape& shape) {
    const auto* named = std::get_if<LinkMesh>(&shape);
    if (!named)
        return BodyShape(*solid_of(shape));
    if (named->mesh >= meshes_.size())
        throw std::invalid_argument("link " + link.name + " names mesh " +
                                    std::to_string(named->mesh) + ", and there are " +
                                    std::to_string(meshes_.size()));
    const std::tuple key{named->mesh, named->scale.x, named->scale.y, named->scale.z};
    auto found = made_.find(key);
    if (found == made_.end()) {
        TriangleMesh mesh = scaled(meshes_[named->mesh], named->scale);
        found = made_
                    .emplace(key, are_solid_ ? BodyShape::solid_if_closed(std::move(mesh))
                                             : BodyShape::surface(std::move(mesh)))
                    .first;
    }
    return found->second;
}

} // namespace boxwood::detail

#pragma once

#include "kernels/primitives/aabb.h"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <cstdint>

namespace boxwood::bench {

inline btDbvtVolume volume_of(const Aabb<float>& box) {
    return btDbvtVolume::FromMM(btVector3(box.min.x, box.min.y, box.min.z),
                                btVector3(box.max.x, box.max.y, box.max.z));
}

/// What a leaf was inserted with.
inline std::uint32_t item_of(const btDbvtNode* leaf) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(leaf->data));
}

} // namespace boxwood::bench

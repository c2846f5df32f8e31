#pragma once

#include "scenes/moving/moving_scene.h"
#include "trees/device.h"

#include <memory>

namespace boxwood::bench {

/// The bodies of a scene on a device, where they stay from frame to frame: of scenes whose effects
/// are steps (EffectEntry::is_step), without margins. The same bits as on the host, without
/// waiting. Errors as those of DeviceBvh.
class DeviceBodies {
  public:
    virtual ~DeviceBodies() = default;

    /// As they stand on the host. Gives how many bytes went up.
    virtual std::size_t upload(MovingScene& scene) = 0;
    /// As MovingScene::advance_effect and move, in the scene's present frame.
    virtual void advance(MovingScene& scene, std::size_t laid) = 0;
    virtual void move(const MovingScene& scene) = 0;
    /// The boxes as they stand, good until the next call; the memory stays where it is.
    virtual DeviceSpan<const Box> fit() = 0;
};

/// Throws DeviceError if there is no such device.
std::unique_ptr<DeviceBodies> make_device_bodies(DevicePlace place);

} // namespace boxwood::bench

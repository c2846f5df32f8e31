// A world of FCL's objects, as a motion planner has it. One line is another than with FCL alone.
#include <boxwood/trees/adapters/fcl_manager.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/fcl.h>

#include <cstdio>
#include <memory>
#include <vector>

int main() {
    boxwood::FclBroadPhase<double> world; // before: fcl::DynamicAABBTreeCollisionManagerd world;

    using Object = fcl::CollisionObjectd;
    std::vector<std::unique_ptr<Object>> objects;
    const auto place = [](Object& object, double x, double z) {
        object.setTranslation({x, 0, z});
        object.computeAABB();
    };
    const auto add = [&](const std::shared_ptr<fcl::CollisionGeometryd>& shape, double x,
                         double z) {
        objects.push_back(std::make_unique<Object>(shape));
        place(*objects.back(), x, z);
        world.registerObject(objects.back().get());
    };
    add(std::make_shared<fcl::Halfspaced>(0, 0, 1, -.5), 0, 0); // the ground
    const auto box = std::make_shared<fcl::Boxd>(1, 1, 1);
    for (int i = 0; i < 1000; ++i)
        add(box, 3 * i, 1);
    world.setup();

    Object hand(std::make_shared<fcl::Sphered>(.4));
    for (int step = 0; step < 3; ++step) {
        place(hand, 30 + 1.2 * step, 1);
        fcl::DefaultCollisionData<double> hit;
        world.collide(&hand, &hit, fcl::DefaultCollisionFunction<double>);
        fcl::DefaultDistanceData<double> nearest;
        if (!hit.result.isCollision())
            world.distance(&hand, &nearest, fcl::DefaultDistanceFunction<double>);
        std::printf("step %d: %s", step, hit.result.isCollision() ? "hits\n" : "is free by ");
        if (!hit.result.isCollision())
            std::printf("%.2f\n", nearest.result.min_distance);
    }
    place(*objects.back(), 0, 1.75); // onto the first box
    world.update(objects.back().get());
    fcl::DefaultCollisionData<double> self;
    world.collide(&self, fcl::DefaultCollisionFunction<double>);
    std::printf("of %zu %s\n", world.size(), self.result.isCollision() ? "two collide" : "none do");
}

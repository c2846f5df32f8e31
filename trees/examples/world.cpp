// Bodies of several shapes that come, go and move: which touch, how near they are, when they meet.
#include <boxwood/boxwood.h>

#include <cstdio>

namespace {

boxwood::Pose at(double x, double z) {
    boxwood::Pose pose;
    pose.translation = {x, 0, z};
    return pose;
}

} // namespace

int main() {
    using namespace boxwood;
    World world;
    // Bits say what a body belongs to and what it may meet: cups and the floor leave each other
    // alone.
    constexpr std::uint32_t hands = 1, cups = 2, floors = 4;
    world.insert(convex::HalfSpace{{0, 0, 1}, 0}, {}, {.group = floors, .mask = hands});
    const BodyShape cup = BodyShape::surface(box_mesh({.125, .125, .25})); // any mesh
    for (int i = 0; i < 1000; ++i) // bodies share its tree, which is built when it is needed
        world.insert(cup, at(.5 * i, .125), {.group = cups, .mask = hands});
    const std::uint32_t hand =
        world.insert(convex::Sphere{.05}, at(1, .5), {.group = hands, .margin = .01});

    std::printf("%zu touch\n", world.collisions().size());
    const auto nearest = world.least_distance();
    std::printf("%u and %u are %.2f apart\n", nearest->bodies.a, nearest->bodies.b,
                nearest->distance);

    const BodyMotion down{hand, at(1, 0)};
    const auto first = world.first_contacts({&down, 1});
    std::printf("on its way down the hand meets %u at t = %.2f\n", first[0].bodies.a,
                first[0].contact.t_hit);

    world.set_pose(hand, at(1, .302));
    for (const BodyContact& contact : world.contacts({.max_contacts = 1})) // the deepest of a pair
        std::printf("%u and %u touch, %.2f deep\n", contact.bodies.a, contact.bodies.b,
                    contact.depth);
    world.allow(first[0].bodies.a, hand); // it is to be held
    std::printf("%zu touch\n", world.collisions().size());
}

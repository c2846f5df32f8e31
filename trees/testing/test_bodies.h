#pragma once

#include "trees/testing/test_meshes.h"
#include "trees/testing/triangle_soup.h"
#include "trees/world/bodies/world.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace boxwood {

inline Pose pose_at(double x, double y = 0, double z = 0) {
    Pose pose;
    pose.translation = {x, y, z};
    return pose;
}

/// One shape of every class and kind that has bounds, about as large as a ball of radius .6.
inline std::vector<BodyShape> shapes_of_all_kinds() {
    TriangleMesh soup = triangle_soup(40, 3);
    for (Vec3<float>& v : soup.vertices)
        v = v * .5f;
    std::vector<Vec3<float>> cloud;
    for (const Vec3<float>& v : noisy_sphere(5, 6, .3, 2, .5).vertices)
        cloud.push_back(v);
    const std::vector<float> heights{0, .2f, -.1f, .1f, .3f, .2f, 0, -.2f, .1f, 0, .2f, .1f};
    return {BodyShape::surface(noisy_sphere(6, 7, .3, 1, .6)),
            BodyShape::surface(std::move(soup)),
            BodyShape::solid(noisy_sphere(5, 8, .2, 4, .7)),
            BodyShape::points(cloud, .1),
            BodyShape::height_field(4, heights, .4f, .4f),
            convex::Sphere{.5},
            convex::Box{{.3, .5, .4}},
            convex::Capsule{.3, .4},
            convex::Cylinder{.4, .5},
            convex::Cone{.5, .5},
            convex::Ellipsoid{{.6, .3, .4}},
            BodyShape::hull({{.5, 0, 0}, {-.4, .1, 0}, {0, .6, .1}, {0, -.3, .5}, {.1, 0, -.5}}),
            convex::Triangle{{.5, 0, .1}, {-.4, .4, 0}, {0, -.5, .2}}};
}

/// A world, and what it should know, kept in another way.
struct MirroredWorld {
    struct Body {
        std::uint32_t shape;
        Pose pose;
        double margin;
        std::uint32_t group, mask;
    };

    explicit MirroredWorld(const std::vector<BodyShape>& of, const WorldOptions& options = {})
        : shapes(of), world(options) {}

    std::uint32_t insert(const Body& body) {
        const std::uint32_t at =
            world.insert(shapes[body.shape], body.pose,
                         {.group = body.group, .mask = body.mask, .margin = body.margin});
        if (at >= bodies.size())
            bodies.resize(std::size_t{at} + 1);
        bodies[at] = body;
        return at;
    }
    void remove(std::uint32_t at) {
        world.remove(at);
        bodies[at].reset();
        std::erase_if(allowed, [&](Pair p) { return p.a == at || p.b == at; });
    }
    void allow(std::uint32_t a, std::uint32_t b) {
        world.allow(a, b);
        allowed.insert({std::min(a, b), std::max(a, b)});
    }
    void disallow(std::uint32_t a, std::uint32_t b) {
        world.disallow(a, b);
        allowed.erase({std::min(a, b), std::max(a, b)});
    }

    bool contains(std::uint32_t at) const { return at < bodies.size() && bodies[at].has_value(); }
    PosedShape posed(std::uint32_t at) const {
        return {shapes[bodies[at]->shape], bodies[at]->pose, bodies[at]->margin};
    }
    /// All that may meet, by going through all of them.
    std::vector<Pair> may_meet() const {
        std::vector<Pair> pairs;
        for (std::uint32_t a = 0; a < bodies.size(); ++a)
            for (std::uint32_t b = a + 1; b < bodies.size(); ++b)
                if (contains(a) && contains(b) && (bodies[a]->group & bodies[b]->mask) != 0 &&
                    (bodies[b]->group & bodies[a]->mask) != 0 && !allowed.contains({a, b}))
                    pairs.push_back({a, b});
        return pairs;
    }
    template <class Decide> std::vector<Pair> pairs_where(const Decide& decide) const {
        std::vector<Pair> pairs = may_meet();
        std::erase_if(pairs, [&](Pair p) { return !decide(posed(p.a), posed(p.b)); });
        return pairs;
    }
    std::vector<Pair> collisions() const {
        return pairs_where(
            [](const PosedShape& a, const PosedShape& b) { return collide(a, b) != Answer::no; });
    }

    std::vector<BodyShape> shapes;
    World world;
    std::vector<std::optional<Body>> bodies;
    std::set<Pair> allowed;
};

/// Bodies in a cube, half of them with margins, in four groups with random masks.
class RandomBodies {
  public:
    RandomBodies(std::uint32_t seed, std::size_t shapes, double reach)
        : random_(seed), shapes_(shapes), place_(-reach, reach) {}

    Pose pose() {
        return random_pose(random_, {place_(random_), place_(random_), place_(random_)});
    }
    MirroredWorld::Body body() {
        const std::uint32_t group = 1u << below(4);
        const std::uint32_t mask = below(4) == 0 ? below(16) : ~0u;
        return {below(shapes_), pose(), below(2) ? 0.0 : .05 * (1 + below(4)), group, mask};
    }
    std::uint32_t below(std::size_t n) {
        return static_cast<std::uint32_t>(random_() % static_cast<std::uint32_t>(n));
    }

  private:
    std::mt19937 random_;
    std::size_t shapes_;
    std::uniform_real_distribution<double> place_;
};

/// The shapes of all kinds, and behind them a half-space and a plane.
inline std::vector<BodyShape> with_unbounded() {
    std::vector<BodyShape> shapes = shapes_of_all_kinds();
    shapes.emplace_back(convex::HalfSpace{{0, 0, 1}, -.8});
    shapes.emplace_back(convex::Plane{{1, 2, 0}, .4});
    return shapes;
}

/// n random bodies and the two without bounds, of which some pairs are allowed to collide.
inline void fill(MirroredWorld& mirror, std::uint32_t seed, std::size_t n, double reach) {
    RandomBodies random(seed, mirror.shapes.size() - 2, reach);
    for (std::size_t i = 0; i < n; ++i)
        mirror.insert(random.body());
    for (const std::size_t unbounded : {mirror.shapes.size() - 2, mirror.shapes.size() - 1}) {
        MirroredWorld::Body body = random.body();
        body.shape = static_cast<std::uint32_t>(unbounded);
        body.mask = ~0u;
        mirror.insert(body);
    }
    for (std::size_t i = 0; i < n / 2; ++i) {
        const std::uint32_t a = random.below(n), b = random.below(n);
        if (a != b)
            mirror.allow(a, b);
    }
}

inline std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

} // namespace boxwood

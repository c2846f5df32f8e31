#pragma once

#include "bench/tasks/contender.h"
#include "bench/truth/point_truth.h"
#include "trees/layout.h"
#include "trees/queries/box_distance.h"

#include <cmath>
#include <limits>
#include <span>

#include <vector>

/// What the peers offer for points and regions. Each is made in peers/NAME/NAME_points.cpp and
/// appended to the contenders of its peer.
namespace boxwood::bench {

std::vector<ContenderEntry> fcl_points();
std::vector<ContenderEntry> cgal_points();
std::vector<ContenderEntry> embree_points();
std::vector<ContenderEntry> bullet_points();

inline bool meets(const Sphere<float>& ball, const Aabb<float>& box) {
    const double radius = static_cast<double>(ball.radius);
    return squared_distance(ball.centre, box) <= radius * radius;
}

/// The box around a ball, rounded outward.
inline Aabb<float> bounds_of(const Sphere<float>& ball) {
    Aabb<float> box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::nextafter(ball.centre[axis] - ball.radius, -HUGE_VALF);
        box.max[axis] = std::nextafter(ball.centre[axis] + ball.radius, HUGE_VALF);
    }
    return box;
}

/// The boxes that contain the queries: flat ones for points.
inline std::vector<Aabb<float>> query_boxes(const Scene& scene, PointQuery query) {
    std::vector<Aabb<float>> boxes;
    if (query != PointQuery::overlapping)
        for (const Vec3<float> p : scene.points)
            boxes.push_back({p, p});
    else if (scene.spheres.empty())
        boxes = scene.regions;
    else
        for (const Sphere<float>& ball : scene.spheres)
            boxes.push_back(bounds_of(ball));
    return boxes;
}

/// The nearest items of one point so far: `keep` in ascending order.
class NearestOfPeer {
  public:
    explicit NearestOfPeer(std::span<Neighbour> keep) : keep_(keep) {
        std::ranges::fill(keep_, Neighbour{});
    }
    double worst() const { return keep_.back().squared_distance; }
    void offer(const Neighbour& near) {
        if (!(near.squared_distance < worst()))
            return;
        std::size_t i = keep_.size() - 1;
        for (; i > 0 && keep_[i - 1].squared_distance > near.squared_distance; --i)
            keep_[i] = keep_[i - 1];
        keep_[i] = near;
    }

  private:
    std::span<Neighbour> keep_;
};

} // namespace boxwood::bench

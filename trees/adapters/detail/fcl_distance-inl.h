#pragma once

#include "trees/adapters/fcl_manager.h"

namespace boxwood {

/// The least distance so far, and who is told of pairs that may be nearer. What the callback makes
/// of that distance is taken as it is, as FCL does.
template <class S> class FclBroadPhase<S>::Nearest {
  public:
    Nearest(void* data, fcl::DistanceCallBack<S> callback) : data_(data), callback_(callback) {}

    const float& squared_limit() const { return squared_limit_; }
    /// False once the callback has had enough, or nothing can be nearer.
    bool offer(Object* a, Object* b, const Bounds& bounds_a, const Bounds& bounds_b) {
        if (!(bounds_a.distance(bounds_b) < least_))
            return goes_on_;
        goes_on_ = !callback_(a, b, data_, least_) && least_ > 0;
        squared_limit_ = detail::NearestFirst::squared_limit(least_);
        return goes_on_;
    }
    bool goes_on() const { return goes_on_; }

  private:
    void* data_;
    fcl::DistanceCallBack<S> callback_;
    S least_ = std::numeric_limits<S>::max();
    float squared_limit_ = std::numeric_limits<float>::infinity();
    bool goes_on_ = true;
};

template <class S> bool FclBroadPhase<S>::distance_one(Object* object, Nearest& nearest) const {
    const Bounds& bounds = object->getAABB();
    const Box box = detail::box_around(bounds);
    const auto offer = [&](std::uint32_t item, std::uint32_t) {
        return nearest.offer(bodies_[item].object, object, bodies_[item].bounds, bounds);
    };
    if (box == Box{}) { // it is tested with all
        for (std::uint32_t item = 0; item < bodies_.size(); ++item)
            if (bodies_[item].object && !offer(item, 0))
                return false;
        return true;
    }
    if (!detail::NearestFirst(nearest.squared_limit()).near_box(tree_.layout(), box, offer))
        return false;
    for (const std::uint32_t item : wide_)
        if (!offer(item, 0))
            return false;
    return true;
}

template <class S> bool FclBroadPhase<S>::distance_self(Nearest& nearest) const {
    const auto offer = [&](std::uint32_t a, std::uint32_t b) {
        return nearest.offer(bodies_[a].object, bodies_[b].object, bodies_[a].bounds,
                             bodies_[b].bounds);
    };
    if (!detail::NearestFirst(nearest.squared_limit()).self_pairs(tree_.layout(), offer))
        return false;
    for (const std::uint32_t a : wide_)
        for (std::uint32_t b = 0; b < bodies_.size(); ++b)
            if (b != a && bodies_[b].object && (!is_wide_[b] || a < b) && !offer(a, b))
                return false;
    return true;
}

template <class S>
bool FclBroadPhase<S>::distance_two(const FclBroadPhase& other, Nearest& nearest) const {
    const auto offer = [&](std::uint32_t a, std::uint32_t b) {
        return nearest.offer(bodies_[a].object, other.bodies_[b].object, bodies_[a].bounds,
                             other.bodies_[b].bounds);
    };
    const detail::NearestFirst search(nearest.squared_limit());
    if (!search.tree_pairs(tree_.layout(), other.tree_.layout(), offer))
        return false;
    for (const std::uint32_t a : wide_)
        for (std::uint32_t b = 0; b < other.bodies_.size(); ++b)
            if (other.bodies_[b].object && !offer(a, b))
                return false;
    for (const std::uint32_t b : other.wide_)
        for (std::uint32_t a = 0; a < bodies_.size(); ++a)
            if (bodies_[a].object && !is_wide_[a] && !offer(a, b))
                return false;
    return true;
}

} // namespace boxwood

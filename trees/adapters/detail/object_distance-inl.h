#pragma once

#include "trees/adapters/detail/object_broad_phase.h"

namespace boxwood::detail {

/// The least distance so far, and who is told of pairs that may be nearer. What the callback makes
/// of that distance is taken as it is, as FCL and Coal do.
template <class Library> template <class Callback> class ObjectBroadPhase<Library>::Nearest {
  public:
    explicit Nearest(const Callback& callback) : callback_(callback) {}

    const float& squared_limit() const { return squared_limit_; }
    /// False once the callback has had enough, or nothing can be nearer.
    bool offer(Object* a, Object* b, const Bounds& bounds_a, const Bounds& bounds_b) {
        if (!(bounds_a.distance(bounds_b) < least_))
            return goes_on_;
        goes_on_ = !callback_(a, b, least_) && least_ > 0;
        squared_limit_ = NearestFirst::squared_limit(least_);
        return goes_on_;
    }
    bool goes_on() const { return goes_on_; }

  private:
    const Callback& callback_;
    S least_ = std::numeric_limits<S>::max();
    float squared_limit_ = std::numeric_limits<float>::infinity();
    bool goes_on_ = true;
};

template <class Library>
template <class Callback>
bool ObjectBroadPhase<Library>::distance_one(Object* object, Nearest<Callback>& nearest) const {
    const Bounds& bounds = std::as_const(*object).getAABB();
    const Box box = box_around(bounds);
    const auto offer = [&](std::uint32_t item, std::uint32_t) {
        return nearest.offer(bodies_[item].object, object, bodies_[item].bounds, bounds);
    };
    if (box == Box{}) { // it is tested with all
        for (std::uint32_t item = 0; item < bodies_.size(); ++item)
            if (bodies_[item].object && !offer(item, 0))
                return false;
        return true;
    }
    if (!NearestFirst(nearest.squared_limit()).near_box(tree_.layout(), box, offer))
        return false;
    for (const std::uint32_t item : wide_)
        if (!offer(item, 0))
            return false;
    return true;
}

template <class Library>
template <class Callback>
bool ObjectBroadPhase<Library>::distance_self(Nearest<Callback>& nearest) const {
    const auto offer = [&](std::uint32_t a, std::uint32_t b) {
        return nearest.offer(bodies_[a].object, bodies_[b].object, bodies_[a].bounds,
                             bodies_[b].bounds);
    };
    if (!NearestFirst(nearest.squared_limit()).self_pairs(tree_.layout(), offer))
        return false;
    for (const std::uint32_t a : wide_)
        for (std::uint32_t b = 0; b < bodies_.size(); ++b)
            if (b != a && bodies_[b].object && (!is_wide_[b] || a < b) && !offer(a, b))
                return false;
    return true;
}

template <class Library>
template <class Callback>
bool ObjectBroadPhase<Library>::distance_two(const ObjectBroadPhase& other,
                                             Nearest<Callback>& nearest) const {
    const auto offer = [&](std::uint32_t a, std::uint32_t b) {
        return nearest.offer(bodies_[a].object, other.bodies_[b].object, bodies_[a].bounds,
                             other.bodies_[b].bounds);
    };
    const NearestFirst search(nearest.squared_limit());
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

} // namespace boxwood::detail

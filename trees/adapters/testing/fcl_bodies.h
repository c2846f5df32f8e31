#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <fcl/narrowphase/collision_object.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace boxwood {

/// An object that is nothing but its bounds, which are exactly these and need no computeAABB.
template <class S> class FclBody final : public fcl::CollisionObject<S> {
  public:
    using Bounds = fcl::AABB<S>;

    explicit FclBody(const Bounds& bounds, unsigned number = 0)
        : fcl::CollisionObject<S>(std::shared_ptr<fcl::CollisionGeometry<S>>(new Nothing)),
          number_(number) {
        move(bounds);
    }
    void move(const Bounds& bounds) { this->aabb = bounds; }
    unsigned number() const { return number_; }

  private:
    unsigned number_;
    struct Nothing final : fcl::CollisionGeometry<S> {
        void computeLocalAABB() override {}
    };
};

template <class S> fcl::AABB<S> bounds_of(S x, S y, S z, S side = 1) {
    fcl::AABB<S> bounds;
    bounds.min_ = {x, y, z};
    bounds.max_ = {x + side, y + side, z + side};
    return bounds;
}

template <class S> using FclPair = std::pair<fcl::CollisionObject<S>*, fcl::CollisionObject<S>*>;

/// What a callback was shown, and the call at which it says that it has had enough.
template <class S> struct ShownPairs {
    std::vector<FclPair<S>> pairs;
    std::size_t enough = std::numeric_limits<std::size_t>::max();

    static bool add(fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b, void* shown) {
        auto& self = *static_cast<ShownPairs*>(shown);
        self.pairs.emplace_back(a, b);
        return self.pairs.size() >= self.enough;
    }

    /// Those whose bounds overlap now, in one order.
    std::vector<FclPair<S>> overlapping() const {
        std::vector<FclPair<S>> found;
        for (const auto& [a, b] : pairs)
            if (a->getAABB().overlap(b->getAABB()))
                found.push_back(std::minmax(a, b));
        std::ranges::sort(found);
        return found;
    }
    std::vector<FclPair<S>> sorted() const {
        std::vector<FclPair<S>> found;
        for (const auto& [a, b] : pairs)
            found.push_back(std::minmax(a, b));
        std::ranges::sort(found);
        return found;
    }
};

} // namespace boxwood

#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace boxwood {

/// An Api says how a library's managers are called: Scalar, Object, Bounds, Manager; Ours, and its
/// own Naive and Tree (tree_takes_flat: also bounds of no volume); Body, an object that is nothing
/// but its bounds (move(bounds), number()); collide(manager, shown, of...) and distance(manager,
/// shown, of...), which hand what a callback is shown to shown.add; the objects or managers `of`
/// are those of the call.
template <class Api> using ObjectPair = std::pair<typename Api::Object*, typename Api::Object*>;

/// What a callback was shown, and the call at which it says that it has had enough.
template <class Api> struct ShownPairs {
    using Object = typename Api::Object;

    std::vector<ObjectPair<Api>> pairs;
    std::size_t enough = std::numeric_limits<std::size_t>::max();

    bool add(Object* a, Object* b) {
        pairs.emplace_back(a, b);
        return pairs.size() >= enough;
    }

    /// Those whose bounds overlap now, in one order.
    std::vector<ObjectPair<Api>> overlapping() const {
        std::vector<ObjectPair<Api>> found;
        for (const auto& [a, b] : pairs)
            if (a->getAABB().overlap(b->getAABB()))
                found.push_back(std::minmax(a, b));
        std::ranges::sort(found);
        return found;
    }
    std::vector<ObjectPair<Api>> sorted() const {
        std::vector<ObjectPair<Api>> found;
        for (const auto& [a, b] : pairs)
            found.push_back(std::minmax(a, b));
        std::ranges::sort(found);
        return found;
    }
};

template <class Api>
typename Api::Bounds bounds_of(typename Api::Scalar x, typename Api::Scalar y,
                               typename Api::Scalar z, typename Api::Scalar side = 1) {
    typename Api::Bounds bounds;
    bounds.min_ << x, y, z;
    bounds.max_ << x + side, y + side, z + side;
    return bounds;
}

} // namespace boxwood

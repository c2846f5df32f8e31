#pragma once

#include "trees/adapters/detail/object_broad_phase.h"

namespace boxwood::detail {

/// Hands pairs of two managers, or of one and itself, to the callback.
template <class Library>
template <class Callback>
class ObjectBroadPhase<Library>::ShowPairs final : public PairSink {
  public:
    ShowPairs(const ObjectBroadPhase& a, const ObjectBroadPhase& b, const Callback& callback)
        : a_(a), b_(b), callback_(callback) {}

    void begin(std::size_t, bool) override {}
    bool take(std::size_t, std::span<const Pair> pairs) override {
        constexpr std::size_t ahead = 16; // they lie anywhere
        for (std::size_t i = 0; i < pairs.size() && goes_on_; ++i) {
            if (i + ahead < pairs.size()) {
                detail::prefetch(&a_.bodies_[pairs[i + ahead].a]);
                detail::prefetch(&b_.bodies_[pairs[i + ahead].b]);
            }
            const Body &a = a_.bodies_[pairs[i].a], &b = b_.bodies_[pairs[i].b];
            if (is_exact || detail::overlap(a.bounds, b.bounds))
                goes_on_ = !callback_(a.object, b.object);
        }
        return goes_on_;
    }
    void end() override {}
    bool goes_on() const { return goes_on_; }

  private:
    const ObjectBroadPhase &a_, &b_;
    const Callback& callback_;
    bool goes_on_ = true;
};

/// The pairs themselves are kept where few objects change between two queries for all of them, and
/// these queries are not ended early.
template <class Library> const std::vector<Pair>* ObjectBroadPhase<Library>::cached_pairs() const {
    const std::lock_guard lock(changing_);
    if (unpaired_.empty() && has_pairs_)
        return &pairs_;
    if (unpaired_.are_many() || stops_early_.load(std::memory_order_relaxed)) {
        if (!unpaired_.empty())
            has_pairs_ = false;
        unpaired_.clear();
        return nullptr;
    }
    has_pairs_ ? follow_pairs() : find_pairs();
    has_pairs_ = true;
    unpaired_.clear();
    return &pairs_;
}

template <class Library> void ObjectBroadPhase<Library>::find_pairs() const {
    pairs_.clear();
    AppendPairs all(pairs_);
    if constexpr (is_exact) {
        boxwood::self_pairs(tree_.layout(), serial(), all);
    } else {
        FilteredPairs exact([this](Pair pair) { return overlap(pair); }, all);
        boxwood::self_pairs(tree_.layout(), serial(), exact);
    }
}

/// Takes out the pairs of objects that changed, and finds these again.
template <class Library> void ObjectBroadPhase<Library>::follow_pairs() const {
    const std::uint8_t* const changed = unpaired_.marks(bodies_.size());
    Pair* kept = pairs_.data();
    for (const Pair pair : pairs_) {
        *kept = pair;
        kept += (changed[pair.a] | changed[pair.b]) == 0;
    }
    pairs_.resize(static_cast<std::size_t>(kept - pairs_.data()));
    std::vector<std::uint32_t> items;
    std::vector<Box> boxes;
    items.reserve(unpaired_.items().size());
    boxes.reserve(unpaired_.items().size());
    for (const std::uint32_t item : unpaired_.items())
        if (!(tree_.box(item) == Box{})) {
            items.push_back(item);
            boxes.push_back(tree_.box(item));
        }
    ForEachPair found([&](Pair answer) {
        const std::uint32_t a = items[answer.a], b = answer.b;
        const bool is_first = !changed[b] || a < b; // two that changed find each other
        if (is_first && (is_exact || overlap(Pair{a, b})))
            pairs_.push_back({std::min(a, b), std::max(a, b)});
        return true;
    });
    regions(tree_.layout(), std::span<const Box>(boxes), serial(), found);
}

template <class Library>
template <class Callback>
bool ObjectBroadPhase<Library>::collide_self(const Callback& callback,
                                             const std::vector<Pair>* cached) const {
    for (std::size_t i = 0; i < wide_.size(); ++i)
        for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
            const std::uint32_t a = wide_[i];
            const bool once = b != a && bodies_[b].object && (!is_wide_[b] || a < b);
            if (once && overlap(a, bodies_[b].bounds) &&
                callback(bodies_[a].object, bodies_[b].object))
                return false;
        }
    if (cached) {
        for (const Pair pair : *cached)
            if (callback(objects_[pair.a], objects_[pair.b]))
                return false;
        return true;
    }
    ShowPairs<Callback> show(*this, *this, callback);
    boxwood::self_pairs(tree_.layout(), serial(), show);
    return show.goes_on();
}

template <class Library>
template <class Callback>
bool ObjectBroadPhase<Library>::collide_one(Object* object, const Callback& callback) const {
    const Bounds& bounds = std::as_const(*object).getAABB();
    const Box box = box_around(bounds);
    const bool is_wide = box == Box{};
    if (is_wide) {
        for (std::uint32_t item = 0; item < bodies_.size(); ++item)
            if (bodies_[item].object && overlap(item, bounds) &&
                callback(bodies_[item].object, object))
                return false;
        return true;
    }
    for (const std::uint32_t item : wide_)
        if (overlap(item, bounds) && callback(bodies_[item].object, object))
            return false;
    bool goes_on = true;
    ForEachPair show([&](Pair answer) {
        if (goes_on && (is_exact || detail::overlap(bodies_[answer.b].bounds, bounds)))
            goes_on = !callback(bodies_[answer.b].object, object);
        return goes_on;
    });
    regions(tree_.layout(), std::span<const Box>(&box, 1), serial(), show);
    return goes_on;
}

template <class Library>
template <class Callback>
bool ObjectBroadPhase<Library>::collide_two(const ObjectBroadPhase& other,
                                            const Callback& callback) const {
    for (const std::uint32_t a : wide_)
        for (std::uint32_t b = 0; b < other.bodies_.size(); ++b)
            if (other.bodies_[b].object && overlap(a, other.bodies_[b].bounds) &&
                callback(bodies_[a].object, other.bodies_[b].object))
                return false;
    for (const std::uint32_t b : other.wide_)
        for (std::uint32_t a = 0; a < bodies_.size(); ++a)
            if (bodies_[a].object && !is_wide_[a] && overlap(a, other.bodies_[b].bounds) &&
                callback(bodies_[a].object, other.bodies_[b].object))
                return false;
    ShowPairs<Callback> show(*this, other, callback);
    tree_pairs(tree_.layout(), other.tree_.layout(), serial(), show);
    return show.goes_on();
}

} // namespace boxwood::detail

#pragma once

#include "bench/peers/answering.h"
#include "scenes/moving/frames.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// What a frame reports to a manager.
enum class Reported : std::uint8_t {
    all_may_have_moved, ///< update()
    which_moved         ///< update(moved)
};

/// The item that an object of FCL's or Coal's stands for.
template <class Object> std::uint32_t item_of(const Object* object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object->getUserData()));
}

/// An object of these bounds that stands for item i.
template <class Object, class Bounds>
std::unique_ptr<Object> object_for(std::shared_ptr<Bounds> bounds, std::size_t i) {
    auto object = std::make_unique<Object>(std::move(bounds));
    object->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
    return object;
}

/// Broad phase managers as FCL and its successor Coal have them: objects are registered, moved, and
/// collided with a callback. A Kind says in which library's words:
///
///     using Object, Manager;
///     using Bounds;                  // a geometry that is nothing but its bounds; take(box)
///     Reported reported;
///     std::unique_ptr<Manager> make(boxes) const;      // an empty one for a scene of these boxes
///     void collide(Manager&, std::vector<Pair>&) const;
///     void collide(Manager&, Manager&, std::vector<Pair>&) const;
template <class Kind> class ManagerContender final : public Contender {
    using Object = typename Kind::Object;
    using Manager = typename Kind::Manager;
    using Bounds = typename Kind::Bounds;

  public:
    ManagerContender(const Job& job, Sides sides, Kind kind)
        : scene_(*job.scene), kind_(kind), between_halves_(sides == Sides::two_halves) {
        const std::vector<Aabb<float>>& boxes = scene_.boxes;
        const std::size_t split = between_halves_ ? tree_pairs_split(boxes.size()) : 0;
        is_present_.resize(boxes.size());
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            bounds_.push_back(std::make_shared<Bounds>(boxes[i]));
            objects_.push_back(object_for<Object>(bounds_.back(), i));
            (i < split ? first_ : rest_).push_back(objects_.back().get());
        }
    }

    void build() override {
        first_manager_.reset();
        rest_manager_.reset();
        if (std::exchange(moved_, false))
            for (std::size_t i = 0; i < objects_.size(); ++i)
                give(i, scene_.boxes[i]);
        for (std::size_t i = 0; i < objects_.size(); ++i)
            is_present_[i] = !scene_.boxes[i].is_empty();
        first_manager_ = make_manager(first_);
        rest_manager_ = make_manager(rest_);
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        if (between_halves_)
            kind_.collide(*first_manager_, *rest_manager_, pairs);
        else
            kind_.collide(*rest_manager_, pairs);
    }

    void update(const Frame& now) override {
        moved_ = true;
        changed_.clear();
        for (const std::uint32_t i : now.moved) {
            Object* const object = objects_[i].get();
            const bool was_present = std::exchange(is_present_[i], !now.boxes[i].is_empty());
            if (!is_present_[i]) {
                rest_manager_->unregisterObject(object);
                continue;
            }
            give(i, now.boxes[i]);
            if (was_present)
                changed_.push_back(object);
            else
                rest_manager_->registerObject(object);
        }
        if (kind_.reported == Reported::which_moved)
            rest_manager_->update(changed_);
        else
            rest_manager_->update();
    }

  private:
    void give(std::size_t i, const Aabb<float>& box) {
        if (box.is_empty())
            return;
        bounds_[i]->take(box);
        objects_[i]->computeAABB();
    }

    std::unique_ptr<Manager> make_manager(const std::vector<Object*>& objects) {
        std::unique_ptr<Manager> manager = kind_.make(scene_.boxes);
        changed_.clear();
        for (Object* const object : objects)
            if (is_present_[item_of(object)])
                changed_.push_back(object);
        manager->registerObjects(changed_);
        manager->setup();
        return manager;
    }

    const Scene& scene_;
    Kind kind_;
    bool between_halves_;
    bool moved_ = false;           ///< whether the boxes are those of a frame
    std::vector<char> is_present_; ///< by item
    std::vector<std::shared_ptr<Bounds>> bounds_;
    std::vector<std::unique_ptr<Object>> objects_;
    std::vector<Object*> changed_;
    std::vector<Object*> first_, rest_; ///< all of them in `rest_` but for two halves
    std::unique_ptr<Manager> first_manager_, rest_manager_;
};

/// What a spatial hash is to be made with.
struct HashGrid {
    double cell;         ///< the mean of the boxes' longest sides
    Aabb<double> limits; ///< three times as wide as the scene
    unsigned slots;      ///< as many as boxes
};

/// Of the limits only the numbers of the cells depend: boxes may leave the scene without being kept
/// in lists.
inline HashGrid hash_grid(const std::vector<Aabb<float>>& boxes) {
    const auto longest = [](const Aabb<double>& box) {
        const Vec3<double> sides = box.max - box.min;
        return std::max({sides.x, sides.y, sides.z});
    };
    Aabb<double> limits;
    double sides = 0;
    unsigned present = 0;
    for (const Aabb<float>& single : boxes) {
        if (single.is_empty())
            continue;
        const Aabb<double> box(single);
        limits.extend(box);
        sides += longest(box);
        ++present;
    }
    if (present == 0)
        return {1, {{-1, -1, -1}, {1, 1, 1}}, 1};
    const double cell = sides > 0 ? sides / present : std::max(longest(limits) / 10, 1.0);
    const Vec3<double> room = limits.max - limits.min + Vec3<double>{cell, cell, cell};
    return {cell, {limits.min - room, limits.max + room}, present};
}

} // namespace boxwood::bench

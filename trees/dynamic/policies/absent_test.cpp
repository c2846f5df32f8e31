#include "trees/dynamic/update.h"

#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>

/// Items that come and go: every policy against brute force in every frame.
namespace boxwood {
namespace {

/// All policies, taken through the same frames.
class Everybody {
  public:
    explicit Everybody(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
        for (const UpdateEntry& entry : updates()) {
            all_.push_back(entry.make({}));
            all_.back()->start(boxes_, serial());
        }
        check("start");
    }
    void go_to(const std::vector<Box>& next, const std::string& what) {
        std::vector<std::uint32_t> moved;
        for (std::uint32_t i = 0; i < next.size(); ++i)
            if (!(next[i] == boxes_[i]))
                moved.push_back(i);
        boxes_ = next;
        for (const auto& updater : all_)
            updater->update(boxes_, moved, serial());
        check(what);
    }
    const std::vector<Box>& boxes() const { return boxes_; }

  private:
    void check(const std::string& what) const {
        const auto expected = brute_force(boxes_);
        for (std::size_t p = 0; p < all_.size(); ++p) {
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            all_[p]->self_pairs(serial(), sink);
            std::ranges::sort(pairs);
            ASSERT_EQ(pairs, expected) << updates()[p].name << ", " << what;
            ASSERT_EQ(all_[p]->fault(), "") << updates()[p].name << ", " << what;
        }
    }

    std::vector<Box> boxes_;
    std::vector<std::unique_ptr<Updater>> all_;
};

TEST(AbsentItems, ComeAndGoWhileOthersMove) {
    for (const std::size_t n : {1u, 2u, 17u, 300u})
        for (const float far : {.003f, .3f}) {
            std::mt19937 random(21);
            std::uniform_real_distribution<float> by(-far, far);
            const auto home = random_boxes(n, .2f, 22);
            auto boxes = home;
            for (std::size_t i = 0; i < n; i += 3)
                boxes[i] = Box{};
            Everybody all(boxes);
            for (int frame = 0; frame < 25; ++frame) {
                for (std::size_t i = 0; i < n; ++i) {
                    if (random() % 10 == 0)
                        boxes[i] = boxes[i] == Box{} ? home[i] : Box{};
                    if (boxes[i] == Box{} || random() % 2 == 0)
                        continue;
                    const Vec3<float> d{by(random), by(random), by(random)};
                    boxes[i] = {boxes[i].min + d, boxes[i].max + d};
                }
                all.go_to(boxes, "n " + std::to_string(n) + ", frame " + std::to_string(frame));
                if (HasFatalFailure())
                    return;
            }
        }
}

TEST(AbsentItems, NobodyOneAndEverybody) {
    for (const std::size_t n : {1u, 16u, 17u, 300u}) {
        const std::vector<Box> home = random_boxes(n, .2f, 23);
        const std::vector<Box> nobody(n);
        std::vector<Box> one = nobody;
        one[n / 2] = home[n / 2];
        Everybody from_none(nobody), from_one(one), from_all(home);
        for (Everybody* all : {&from_none, &from_one, &from_all})
            for (const std::vector<Box>* next : std::initializer_list<const std::vector<Box>*>{
                     &one, &nobody, &home, &one, &home, &nobody, &nobody, &home}) {
                all->go_to(*next, "n " + std::to_string(n));
                if (HasFatalFailure())
                    return;
            }
    }
}

TEST(AbsentItems, OtherEmptyBoxesAreRefused) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    auto boxes = random_boxes(40, .2f, 24);
    boxes[7] = Box{};
    Box inverted = boxes[9], half = Box{}, flipped = {{-inf, -inf, -inf}, {inf, inf, inf}};
    std::swap(inverted.min.y, inverted.max.y);
    half.max.z = 1;
    for (const UpdateEntry& entry : updates()) {
        const auto updater = entry.make({});
        updater->start(boxes, serial());
        for (const Box& bad : {inverted, half, flipped}) {
            auto wrong = boxes;
            wrong[12] = bad;
            std::vector<std::uint32_t> all(wrong.size());
            for (std::uint32_t i = 0; i < all.size(); ++i)
                all[i] = i;
            for (const auto& moved : {all, std::vector<std::uint32_t>{7, 12}})
                EXPECT_THROW(updater->update(wrong, moved, serial()), InvalidBox) << entry.name;
            EXPECT_THROW(updater->start(wrong, serial()), InvalidBox) << entry.name;
        }
        std::vector<Pair> pairs;
        AppendPairs sink(pairs);
        updater->self_pairs(serial(), sink);
        std::ranges::sort(pairs);
        EXPECT_EQ(pairs, brute_force(boxes)) << entry.name;
    }
}

} // namespace
} // namespace boxwood

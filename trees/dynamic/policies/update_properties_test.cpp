#include "trees/dynamic/update.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

/// What holds for every policy, whatever moves where: RapidCheck prints the history that a failure
/// shrinks to.
namespace boxwood {
namespace {

/// Few distinct coordinates, so that flat, identical, nested and touching boxes are common, and now
/// and then one far away.
rc::Gen<Box> any_box() {
    return rc::gen::map(
        rc::gen::pair(rc::gen::container<std::vector<int>>(6, rc::gen::inRange(-3, 4)),
                      rc::gen::weightedElement<float>({{8, 1.f}, {1, 1e6f}, {1, 1e-30f}})),
        [](const std::pair<std::vector<int>, float>& of) {
            Box box;
            const auto at = [&](std::size_t i) {
                return static_cast<float>(of.first[i]) * of.second;
            };
            box.extend(Vec3<float>{at(0), at(1), at(2)});
            box.extend(Vec3<float>{at(3), at(4), at(5)});
            return box;
        });
}

/// Each setting, all of which are numbers, at its minimum, its default or between or above: the
/// maximum may be a million.
Settings any_settings(const UpdateEntry& entry) {
    Settings settings;
    for (const SettingInfo& info : entry.settings) {
        const double usual = std::get<double>(info.default_value);
        settings[std::string(info.name)] = *rc::gen::element(
            info.min, usual, (info.min + usual) / 2, std::min(info.max, 3 * usual + 1));
    }
    return settings;
}

RC_GTEST_PROP(UpdateProperties, EveryPolicyAnswersForTheNewestFrame, ()) {
    auto boxes = *rc::gen::container<std::vector<Box>>(any_box());
    const auto frames = *rc::gen::inRange(1, 6);
    std::vector<std::unique_ptr<Updater>> all;
    for (const UpdateEntry& entry : updates()) {
        all.push_back(entry.make(any_settings(entry)));
        all.back()->start(boxes, serial());
    }
    for (int frame = 0; frame < frames; ++frame) {
        std::vector<std::uint32_t> moved;
        for (std::uint32_t i = 0; i < boxes.size(); ++i)
            if (*rc::gen::inRange(0, 3) == 0) {
                boxes[i] = *any_box();
                moved.push_back(i);
            }
        std::vector<Pair> expected;
        for (std::uint32_t a = 0; a < boxes.size(); ++a)
            for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
                if (overlaps(boxes[a], boxes[b]))
                    expected.push_back({a, b});
        for (std::size_t p = 0; p < all.size(); ++p) {
            all[p]->update(boxes, moved, serial());
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            all[p]->self_pairs(serial(), sink);
            std::ranges::sort(pairs);
            const std::string fault = all[p]->fault();
            if (!fault.empty() || pairs != expected)
                RC_FAIL(std::string(updates()[p].name) + ", frame " + std::to_string(frame) + ": " +
                        (fault.empty() ? "wrong pairs" : fault));
        }
    }
}

} // namespace
} // namespace boxwood

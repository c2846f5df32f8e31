// A builder of one's own: a split of the items, for which the library has the loop.
#include <boxwood/boxwood.h>

#include <cstdio>
#include <vector>

struct HalvingBuilder {
    static constexpr std::string_view name = "halving";
    static constexpr std::string_view summary = "top-down, halves the items in the order they come";

    boxwood::Tree build(boxwood::Boxes boxes, const boxwood::Executor& executor) const {
        return boxwood::build_top_down(
            boxes, executor, [](std::span<boxwood::BuildItem> items) { return items.size() / 2; });
    }
};

int main() {
    std::vector<boxwood::Box> boxes;
    for (int i = 0; i < 1000; ++i) {
        const auto x = static_cast<float>(i);
        boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}}); // each touches the next
    }
    const boxwood::Bvh ours(boxes,
                            {.builder = HalvingBuilder{}, .layout = boxwood::LayoutName::wide8});
    const boxwood::Bvh usual(boxes);
    std::printf("%zu pairs, %zu pairs\n", ours.self_pairs().size(), usual.self_pairs().size());
}

// Boxes that move: the tree follows them, and is built again when that pays.
#include <boxwood/boxwood.h>

#include <cstdio>
#include <vector>

int main() {
    std::vector<boxwood::Box> boxes;
    for (int i = 0; i < 100; ++i) {
        const auto x = static_cast<float>(i);
        boxes.push_back({{x, 0, 0}, {x + .5f, 1, 1}}); // half a unit apart from the next
    }
    boxwood::Bvh bvh(boxes, {.threads = 2}); // the answers do not depend on the number of threads
    for (int frame = 1; frame <= 3; ++frame) {
        for (std::size_t i = 0; i < boxes.size(); i += 2) { // every other one drifts to the right
            boxes[i].min.x += .25f;
            boxes[i].max.x += .25f;
        }
        bvh.update(boxes);
        std::printf("frame %d: %llu pairs\n", frame,
                    static_cast<unsigned long long>(bvh.self_pair_count()));
    }
    bvh.self_pairs([](boxwood::Pair pair) { // or one by one, until the function says false
        std::printf("the first: %u and %u\n", pair.a, pair.b);
        return false;
    });
}

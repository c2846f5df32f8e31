#include <boxwood/boxwood.h>

#include <cstdio>
#include <vector>

int main() {
    const std::vector<boxwood::Box> boxes{
        {{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{3, 3, 3}, {4, 4, 4}}};
    const boxwood::Bvh bvh(boxes);
    // Each pair once; boxes are closed, so that one shared point counts.
    for (const auto [a, b] : bvh.self_pairs())
        std::printf("%u,%u\n", a, b); // 0,1
}

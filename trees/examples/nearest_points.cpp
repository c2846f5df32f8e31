// What is near a point: boxes, and the surface of a mesh.
#include <boxwood/boxwood.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
    std::vector<boxwood::Box> boxes;
    for (int i = 0; i < 10; ++i) {
        const auto x = static_cast<float>(10 * i);
        boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
    }
    const boxwood::Bvh bvh(boxes);
    for (const auto& [item, squared] : bvh.nearest({22, .5f, .5f}, 3))
        std::printf("box %u, %g away\n", item, std::sqrt(squared));
    const boxwood::Sphere<float> ball{{22, .5f, .5f}, 8};
    std::printf("%zu within 8\n", bvh.overlapping(ball).size());

    const boxwood::MeshBvh mesh(
        {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}});
    if (const auto found = mesh.closest_point({.25f, .25f, 3}))
        std::printf("the surface is %g away\n", std::sqrt(found->squared_distance));
}

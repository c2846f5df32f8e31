// Rays at a mesh: one at a time, or many.
#include <boxwood/boxwood.h>

#include <cstdio>
#include <vector>

int main() {
    const std::vector<boxwood::Vec3<float>> vertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const std::vector<boxwood::MeshBvh::Corners> square{{0, 1, 2}, {0, 2, 3}};
    const boxwood::MeshBvh mesh(vertices, square);

    const boxwood::Ray<float> ray{.origin = {.25f, .5f, 2}, .direction = {0, 0, -1}};
    if (const auto hit = mesh.closest_hit(ray))
        std::printf("triangle %u at t = %g\n", hit->triangle, static_cast<double>(hit->t));
    if (!mesh.any_hit({.origin = {2, 2, 2}, .direction = {0, 0, -1}}))
        std::printf("a miss\n");

    std::vector<boxwood::Ray<float>> rays(1000, ray);
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].origin.x = static_cast<float>(i) / 500 + .0005f; // half of them beside it
    std::size_t hits = 0;
    for (const boxwood::RayHit& hit : mesh.closest_hits(rays))
        hits += hit.hit();
    std::printf("%zu of %zu hit\n", hits, rays.size());
}

// A world in which bodies come, go and move one at a time, and queries come in between.
#include <boxwood/boxwood.h>

#include <cstdio>

int main() {
    boxwood::DynamicBvh world;
    for (std::uint32_t body = 0; body < 1000; ++body) { // bodies are numbered by the program
        const auto x = static_cast<float>(2 * body);
        world.insert(body, {{x, 0, 0}, {x + 1, 1, 1}});
    }
    world.remove(500);

    const boxwood::Box moved{{20.5f, 0, 0}, {21.5f, 1, 1}};
    world.move(7, moved); // O(log n), as is the query of its surroundings
    for (const std::uint32_t body : world.overlapping(moved))
        if (body != 7)
            std::printf("7 meets %u\n", body);

    // What the ray meets first: each box that comes before what was hit already is shown once.
    std::uint32_t first = 0;
    world.meeting({.origin = {-1, .5f, .5f}, .direction = {1, 0, 0}},
                  [&](std::uint32_t body, const boxwood::Ray<float>& ray) {
                      // Along x at this speed; boxwood::clip says it for every direction.
                      const float t = world.box(body).min.x - ray.origin.x;
                      if (t >= ray.t_max)
                          return ray.t_max;
                      first = body;
                      return t;
                  });
    std::printf("the ray meets %u first; %zu pairs in all\n", first, world.self_pairs().size());
}

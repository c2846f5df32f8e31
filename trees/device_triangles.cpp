#include "trees/device_triangles.h"

#include <stdexcept>
#include <string>

namespace boxwood {
namespace {

static_assert(sizeof(Triangle<float>) == 3 * sizeof(Vec3<float>));

/// Both sides and the pairs on a device.
struct Uploaded {
    DeviceArray<Triangle<float>> a, b;
    DeviceArray<Pair> pairs;

    Uploaded(std::span<const Triangle<float>> of_a, std::span<const Triangle<float>> of_b,
             std::span<const Pair> of, DevicePlace place) {
        for (std::size_t i = 0; i < of.size(); ++i)
            if (of[i].a >= of_a.size() || of[i].b >= of_b.size())
                throw std::invalid_argument(
                    "pair " + std::to_string(i) + " is of the triangles " +
                    std::to_string(of[i].a) + " and " + std::to_string(of[i].b) + ", of " +
                    std::to_string(of_a.size()) + " and " + std::to_string(of_b.size()));
        a = DeviceArray<Triangle<float>>(of_a, place);
        b = DeviceArray<Triangle<float>>(of_b, place);
        pairs = DeviceArray<Pair>(of, place);
    }
    static DeviceTriangles side(const DeviceArray<Triangle<float>>& of) {
        return {{reinterpret_cast<const Vec3<float>*>(of.span().data), 3 * of.size()}};
    }
};

} // namespace

std::vector<Answer> triangles_touch(std::span<const Triangle<float>> a,
                                    std::span<const Triangle<float>> b, std::span<const Pair> pairs,
                                    DeviceAccuracy accuracy, DevicePlace place) {
    const Uploaded there(a, b, pairs, place);
    return triangles_touch(Uploaded::side(there.a), Uploaded::side(there.b), there.pairs.span(),
                           accuracy, place)
        .of.to_host();
}
std::vector<DistanceBounds> triangle_distances(std::span<const Triangle<float>> a,
                                               std::span<const Triangle<float>> b,
                                               std::span<const Pair> pairs, DeviceAccuracy accuracy,
                                               DevicePlace place) {
    const Uploaded there(a, b, pairs, place);
    return triangle_distances(Uploaded::side(there.a), Uploaded::side(there.b), there.pairs.span(),
                              accuracy, place)
        .of.to_host();
}

} // namespace boxwood

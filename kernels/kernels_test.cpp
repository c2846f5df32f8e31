#include "kernels/kernels.h" // alone: it must be all that a user needs

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace boxwood {
namespace {

TEST(KernelsHeader, IsAllThatAUserNeeds) {
    const Triangle<double> a{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, b{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
    EXPECT_EQ(GuigueDevillersExact::intersect(a, b), (Decision{Answer::no, 0}));
    EXPECT_EQ(CertifiedDistance::distance(a, b).distance, 2);
    EXPECT_EQ(FeaturesF64::distance(a, b).distance, 2);
    RayHit hit;
    const Ray<float> ray{{.25f, .25f, 1}, {0, 0, -1}};
    const auto t = Triangle<float>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_TRUE(Watertight::intersect(Watertight::prepare(ray), ray, t, ray.t_max, hit));
    EXPECT_EQ(hit.t, 1);
}

/// The headers below kernels/ that are public: neither internal nor for tests, the oracle or SIMD.
std::set<std::string> public_headers() {
    const std::set<std::string> others{"detail", "testing", "oracle", "simd"};
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator("kernels")) {
        const std::filesystem::path& path = entry.path();
        const bool is_public = std::none_of(path.begin(), path.end(), [&](const auto& part) {
            return others.contains(part.string());
        });
        if (path.extension() == ".h" && is_public)
            found.insert(path.generic_string());
    }
    found.erase("kernels/kernels.h");
    found.erase("kernels/settings.h"); // of registry types, not of kernels
    found.erase("kernels/suggest.h");  // of registry lookups, likewise
    return found;
}

TEST(KernelsHeader, HoldsAllThatIsPublicAndNothingElse) {
    std::set<std::string> included;
    std::ifstream header("kernels/kernels.h");
    for (std::string line; std::getline(header, line);)
        if (line.starts_with("#include \""))
            included.insert(line.substr(10, line.find('"', 10) - 10));
    EXPECT_EQ(included, public_headers());
}

} // namespace
} // namespace boxwood

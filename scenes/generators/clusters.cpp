#include "scenes/registry.h"
#include "scenes/sampling/scatter.h"

#include <fmt/format.h>

namespace boxwood {
namespace {

constexpr int n_clusters = 16;
constexpr double background =
    0.2; ///< share of the items that lie anywhere; the clusters share the rest

struct Cluster {
    Vec3<double> centre;
    double side;
};

/// The sides fall from 0.3 to 0.03 and every cluster has as many items, so that the densities span
/// a factor of 1000. Clusters may overlap each other.
std::vector<Cluster> make_clusters(std::uint64_t seed) {
    const Random random(seed, "clusters.centres");
    std::vector<Cluster> clusters;
    for (int c = 0; c < n_clusters; ++c) {
        Draws draws = random.item(static_cast<std::uint64_t>(c));
        const double side = 0.3 / (1 + 0.6 * c);
        clusters.push_back({0.7 * draws.in_cube() + Vec3<double>{0.15, 0.15, 0.15}, side});
    }
    return clusters;
}

/// The cluster of item i, n_clusters for the background. A Weyl sequence: each cluster gets its
/// share of the items up to a few, for any n.
int cluster_of(std::uint64_t i) {
    const double u = static_cast<double>((i * 0x9e3779b97f4a7c15u) >> 11) * 0x1p-53;
    return u < background ? n_clusters
                          : static_cast<int>((u - background) / (1 - background) * n_clusters);
}

/// A centre is the mean of three uniform ones (a bell with soft edges): two are drawn here, and the
/// third is the centre of the placement.
Placement place(std::span<const Cluster> clusters, int c, Draws& draws) {
    Placement placement{.half = draws.in_cube() + Vec3<double>{0.5, 0.5, 0.5}};
    if (c < n_clusters) {
        const auto& [centre, side] = clusters[static_cast<std::size_t>(c)];
        const Vec3<double> first = draws.in_cube(), second = draws.in_cube();
        const double third = side / 3;
        placement.low = centre + third * (first + second - Vec3<double>{1.5, 1.5, 1.5});
        placement.side = {third, third, third};
    }
    return placement;
}

double share(int c) { return c == n_clusters ? background : (1 - background) / n_clusters; }

/// Every pair of clusters is sampled in proportion to its weight; pairs within a cluster, which
/// hold nearly all overlaps, are sampled more.
double clusters_scale(const SceneSpec& spec, std::span<const Cluster> clusters) {
    const double probability = overlap_probability(spec);
    const Random random(spec.seed, "clusters.sample");
    std::vector<PlacementPair> sample;
    for (int c = 0; c <= n_clusters; ++c)
        for (int d = c; d <= n_clusters; ++d) {
            const int n_pairs = c == d ? 512 : 16;
            const double weight = share(c) * share(d) * (c == d ? 1 : 2) / n_pairs;
            for (int k = 0; k < n_pairs; ++k) {
                Draws draws = random.item(sample.size());
                const Placement a = place(clusters, c, draws), b = place(clusters, d, draws);
                sample.push_back({a, b, weight});
            }
        }
    return scale_of(sample, probability);
}

/// Dense clusters of very different size and density on a sparse background.
struct Clusters {
    static constexpr std::string_view name = "clusters";
    static constexpr std::string_view human_name = "{n} clustered boxes";
    static constexpr std::string_view summary =
        "n boxes in 16 clusters of densities 1:1000 and a sparse background in the unit cube";
    static constexpr bool has_mesh = false, uses_overlaps = true;

    static Scene generate(const SceneSpec& spec) {
        const std::vector<Cluster> clusters = make_clusters(spec.seed);
        const double scale = clusters_scale(spec, clusters);
        Scene scene;
        scene.boxes = draw_boxes(spec, name, scale, [&](std::size_t i, Draws& draws) {
            return place(clusters, cluster_of(i), draws);
        });
        scene.params_json =
            fmt::format(R"({{"overlaps":{},"scale":{},"clusters":{},"background":{}}})",
                        spec.overlaps, scale, n_clusters, background);
        return scene;
    }
};

} // namespace

SceneEntry clusters_scene() { return scene_entry<Clusters>(); }

} // namespace boxwood

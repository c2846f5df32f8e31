#pragma once

#include "scenes/moving/moving_scene.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstddef>
#include <string>
#include <vector>

namespace boxwood::bench {

/// The present boxes of a moment, the bodies they belong to, and a tree of them.
struct BoxedBodies {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> body; ///< of each box
    Tree tree;
};
BoxedBodies boxed(const Bodies& bodies);

/// Every pair of present bodies whose boxes overlap, without the expected ones; ascending.
std::vector<Pair> overlapping_bodies(const MovingScene& scene, const BoxedBodies& boxed);

enum class MeshesAs : std::uint8_t { triangles, hulls };

/// Draws frames of one scene side by side, all to one scale.
class ScenePicture {
  public:
    /// depth: of the tree's boxes to draw, the root's is 0; negative: none.
    ScenePicture(const MovingScene& scene, int depth, MeshesAs meshes = MeshesAs::triangles);

    /// The scene as it is now, with the bodies that its last step changed.
    void add(const MovingScene& scene, std::span<const std::uint32_t> changed);
    std::string svg() const;

  private:
    struct Point {
        double x, y; ///< scene units, in the plane of the view
    };
    using Polygon = std::vector<Point>;
    struct Frame {
        std::string title;
        std::vector<Polygon> resting, changed, meeting; ///< bodies; the last are in a pair
        std::vector<Polygon> lines;                     ///< from centre to centre of each pair
        std::vector<Polygon> nodes;                     ///< boxes of the tree at the wanted depth
        std::vector<Polygon> queries;                   ///< some of the queries
    };

    Point seen(Vec3<double> p) const { return {p[across_], p[up_]}; }
    void add_outline(const Bodies& bodies, std::uint32_t i, std::vector<Polygon>& to) const;
    Polygon rectangle(const Box& box) const;
    void add_queries(const MovingScene& scene, Frame& frame) const;
    std::string path(const std::vector<Polygon>& polygons, double scale,
                     std::string_view style) const;

    std::string name_;
    int across_, up_, depth_;
    MeshesAs meshes_;
    Aabb<double> drawn_; ///< all points of all frames; z unused
    std::vector<Frame> frames_;
};

} // namespace boxwood::bench

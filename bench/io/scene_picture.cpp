#include "bench/io/scene_picture.h"

#include "trees/trees.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boxwood::bench {
namespace {

constexpr double panel = 440, margin = 16, head = 44, foot = 40; // pixels

int axis_of(char letter) { return letter - 'x'; }

/// The corners of the hull, counter-clockwise: Andrew's monotone chain.
template <class Point> std::vector<Point> hull(std::vector<Point> points) {
    std::ranges::sort(points, [](Point a, Point b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    const auto turns_right = [](Point a, Point b, Point c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= 0;
    };
    std::vector<Point> corners;
    for (int pass = 0; pass < 2; ++pass) {
        const std::size_t first = corners.size();
        for (const Point p : points) {
            while (corners.size() >= first + 2 &&
                   turns_right(corners[corners.size() - 2], corners.back(), p))
                corners.pop_back();
            corners.push_back(p);
        }
        corners.pop_back(); // the first of the other pass
        std::ranges::reverse(points);
    }
    return corners;
}

} // namespace

BoxedBodies boxed(const Bodies& bodies) {
    BoxedBodies made;
    for (std::uint32_t i = 0; i < bodies.size(); ++i)
        if (bodies.present[i]) {
            made.boxes.push_back(fitted_box(bodies, i));
            made.body.push_back(i);
        }
    made.tree = BinnedSahBuilder{}.build(made.boxes, serial());
    return made;
}

std::vector<Pair> overlapping_bodies(const MovingScene& scene, const BoxedBodies& boxed) {
    const BinaryLayout layout(boxed.tree, serial());
    std::vector<Pair> found;
    AppendPairs sink(found);
    self_pairs(layout, serial(), sink);
    std::vector<Pair> pairs;
    for (const Pair p : found) {
        const auto [a, b] = std::minmax(boxed.body[p.a], boxed.body[p.b]);
        if (!scene.is_ignored(a, b))
            pairs.push_back({a, b});
    }
    std::ranges::sort(pairs);
    return pairs;
}

ScenePicture::ScenePicture(const MovingScene& scene, int depth, MeshesAs meshes)
    : name_(scene.file().name), across_(axis_of(scene.file().view[0])),
      up_(axis_of(scene.file().view[1])), depth_(depth), meshes_(meshes) {}

ScenePicture::Polygon ScenePicture::rectangle(const Box& box) const {
    const Point a = seen(static_cast<Vec3<double>>(box.min));
    const Point b = seen(static_cast<Vec3<double>>(box.max));
    return {{a.x, a.y}, {b.x, a.y}, {b.x, b.y}, {a.x, b.y}};
}

/// Of a mesh its triangles or their hull, of a box its silhouette.
void ScenePicture::add_outline(const Bodies& bodies, std::uint32_t i,
                               std::vector<Polygon>& to) const {
    const auto& pose = bodies.pose[i];
    if (bodies.mesh[i] != no_mesh) {
        const TriangleMesh& mesh = bodies.meshes[bodies.mesh[i]];
        if (meshes_ == MeshesAs::hulls) {
            Polygon corners;
            for (const auto& vertex : mesh.vertices)
                corners.push_back(seen(pose(static_cast<Vec3<double>>(vertex))));
            to.push_back(hull(std::move(corners)));
            return;
        }
        for (const auto& triangle : mesh.triangles) {
            Polygon corners;
            for (const std::uint32_t v : triangle)
                corners.push_back(seen(pose(static_cast<Vec3<double>>(mesh.vertices[v]))));
            to.push_back(std::move(corners));
        }
        return;
    }
    const auto low = static_cast<Vec3<double>>(bodies.rest[i].min);
    const auto high = static_cast<Vec3<double>>(bodies.rest[i].max);
    Polygon corners;
    for (unsigned corner = 0; corner < 8; ++corner)
        corners.push_back(seen(pose({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                     corner & 4 ? high.z : low.z})));
    to.push_back(hull(std::move(corners)));
}

/// At most `max_queries` of each kind: boxes, points as small squares, and rays as far as a third
/// of the room.
void ScenePicture::add_queries(const MovingScene& scene, Frame& frame) const {
    const Bodies& bodies = scene.bodies();
    const auto some = [](auto& queries) {
        constexpr std::size_t max_queries = 24;
        const std::size_t step = (queries.size() + max_queries - 1) / max_queries;
        for (std::size_t i = 0; i * step < queries.size(); ++i)
            queries[i] = queries[i * step];
        queries.resize(std::min(queries.size(), max_queries));
    };
    for (const SceneQuery& query : scene.file().queries) {
        std::vector<Box> regions;
        std::vector<Ray<float>> rays;
        std::vector<Vec3<float>> points;
        switch (probes_of(query.name)) {
        case Probes::regions:
            regions_of_frame(scene, query, regions);
            break;
        case Probes::rays:
            rays_of_frame(scene, query, rays);
            break;
        case Probes::points:
            points_of_frame(scene, query, points);
            break;
        case Probes::none:
            break;
        }
        some(regions);
        some(rays);
        some(points);
        const auto dot = static_cast<float>(.1 * bodies.side);
        for (const Vec3<float>& p : points)
            regions.push_back({p - Vec3<float>{dot, dot, dot}, p + Vec3<float>{dot, dot, dot}});
        for (const Box& region : regions)
            frame.queries.push_back(rectangle(region));
        for (const Ray<float>& ray : rays) {
            const auto from = static_cast<Vec3<double>>(ray.origin);
            const auto along = static_cast<Vec3<double>>(ray.direction);
            const double far = bodies.length_of(0, 1. / 3) / length(along);
            frame.queries.push_back({seen(from), seen(from + far * along)});
        }
    }
}

void ScenePicture::add(const MovingScene& scene, std::span<const std::uint32_t> changed) {
    const Bodies& bodies = scene.bodies();
    const BoxedBodies present = boxed(bodies);
    const std::vector<Pair> pairs = overlapping_bodies(scene, present);
    std::vector<std::uint8_t> is_meeting(bodies.size());
    Frame frame;
    for (const auto& [a, b] : pairs) {
        is_meeting[a] = is_meeting[b] = 1;
        frame.lines.push_back({seen(bodies.pose[a].translation), seen(bodies.pose[b].translation)});
    }
    for (const std::uint32_t i : present.body)
        add_outline(bodies, i,
                    is_meeting[i]                            ? frame.meeting
                    : std::ranges::binary_search(changed, i) ? frame.changed
                                                             : frame.resting);
    if (depth_ >= 0 && !present.tree.empty()) {
        std::vector<std::pair<std::size_t, int>> stack{{0, 0}};
        while (!stack.empty()) {
            const auto [node, depth] = stack.back();
            stack.pop_back();
            if (depth == depth_ || present.tree.is_leaf(node)) {
                frame.nodes.push_back(rectangle(present.tree.nodes[node].box));
                continue;
            }
            stack.emplace_back(Tree::left(node), depth + 1);
            stack.emplace_back(present.tree.right(node), depth + 1);
        }
    }
    add_queries(scene, frame);
    for (const auto* polygons :
         {&frame.resting, &frame.changed, &frame.meeting, &frame.nodes, &frame.queries})
        for (const Polygon& polygon : *polygons)
            for (const Point p : polygon)
                drawn_.extend(Vec3<double>{p.x, p.y, 0});
    frame.title = fmt::format("frame {}: {} bodies, {} changed, {} pairs", scene.frame(),
                              present.body.size(), changed.size(), pairs.size());
    frames_.push_back(std::move(frame));
}

std::string ScenePicture::path(const std::vector<Polygon>& polygons, double scale,
                               std::string_view style) const {
    if (polygons.empty())
        return "";
    const auto tenths = [scale](double length) { return std::lround(10 * scale * length); };
    std::string out = fmt::format("<path vector-effect=\"non-scaling-stroke\" {} d=\"", style);
    for (const Polygon& polygon : polygons) {
        std::string_view before = "M";
        long x = 0, y = 0;
        for (const Point p : polygon) {
            const long to_x = tenths(p.x - drawn_.min.x), to_y = tenths(drawn_.max.y - p.y);
            out += fmt::format("{}{} {}", before, to_x - x, to_y - y);
            before = before == "M" ? "l" : " ";
            x = to_x;
            y = to_y;
        }
        out += 'Z';
    }
    return out + "\"/>\n";
}

std::string ScenePicture::svg() const {
    const bool is_empty = drawn_.is_empty();
    const double across = is_empty ? 1 : drawn_.max.x - drawn_.min.x;
    const double up = is_empty ? 1 : drawn_.max.y - drawn_.min.y;
    const double scale = std::max(across, up) > 0 ? panel / std::max(across, up) : 1;
    const double width = std::max(across * scale, 330.), height = up * scale;
    const auto n = static_cast<double>(frames_.size());
    const double all = std::max(n * (width + margin) + margin, 660.);
    std::string out = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"13\">\n"
        "<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        "<text x=\"{3}\" y=\"18\" font-weight=\"bold\">{2}, seen in the plane {4}{5}</text>\n",
        all, head + height + margin + foot, name_, margin, static_cast<char>('x' + across_),
        static_cast<char>('x' + up_));
    const std::string_view resting =
        "fill=\"#bbb\" fill-opacity=\".3\" stroke=\"#777\" stroke-width=\".7\"";
    const std::string_view changing =
        "fill=\"#56b4e9\" fill-opacity=\".3\" stroke=\"#0072b2\" stroke-width=\".7\"";
    const std::string_view meeting =
        "fill=\"#e69f00\" fill-opacity=\".3\" stroke=\"#d55e00\" stroke-width=\".7\"";
    const std::string_view line =
        "fill=\"none\" stroke=\"#d55e00\" stroke-opacity=\".4\" stroke-width=\".7\"";
    const std::string_view node =
        "fill=\"none\" stroke=\"#009e73\" stroke-width=\"1\" stroke-dasharray=\"5 3\"";
    const std::string_view query =
        "fill=\"none\" stroke=\"#cc79a7\" stroke-opacity=\".8\" stroke-width=\"1\"";
    bool has_queries = false;
    double x = margin;
    for (const Frame& frame : frames_) {
        has_queries |= !frame.queries.empty();
        out += fmt::format("<text x=\"{0:.0f}\" y=\"36\" fill=\"#444\">{1}</text>\n"
                           "<g transform=\"translate({0:.0f} {2:.0f}) scale(.1)\">\n",
                           x, frame.title, head);
        out += path(frame.resting, scale, resting) + path(frame.changed, scale, changing) +
               path(frame.meeting, scale, meeting) + path(frame.lines, scale, line) +
               path(frame.nodes, scale, node) + path(frame.queries, scale, query) + "</g>\n";
        x += width + margin;
    }
    const double y = head + height + margin + 8;
    x = margin;
    const auto key = [&](std::string_view style, std::string_view text) {
        out += fmt::format("<rect x=\"{0:.0f}\" y=\"{1:.0f}\" width=\"14\" height=\"14\" {2}/>"
                           "<text x=\"{3:.0f}\" y=\"{4:.0f}\">{5}</text>\n",
                           x, y, style, x + 20, y + 12, text);
        x += 36 + 7 * static_cast<double>(text.size());
    };
    key(resting, "at rest");
    key(changing, "changed since the frame before");
    key(meeting, "box overlaps another's");
    if (depth_ >= 0)
        key(node, fmt::format("tree, depth {}", depth_));
    if (has_queries)
        key(query, "some of the queries");
    return out + "</svg>\n";
}

} // namespace boxwood::bench

#include "kernels/convex/detail/epa.h"

/// Outline. 1. A tetrahedron of points of the difference D, grown from GJK's simplex; if none has a
/// volume, D is flat, and the direction square to it says so. 2. The face of least offset from the
/// origin is replaced: the farthest point w of D along its normal is added, the faces that see w
/// go, and w is joined with the rim of the hole. 3. Bounds:
///   lo: D ends at n.w along every normal n tried, so that the signed distance is at least -n.w.
///   hi: a closed surface of triangles between points of D goes around the origin, and each of its
///       triangles is in the half-space m.x >= offset of its own m: the ball of the least offset is
///       in D. No matter how well m was computed, as offset is the least of its corners' m.w.
/// It goes around the origin if the first tetrahedron does (all offsets more than rounding), and
/// still does when face f makes place for faces to w, as f and w are both in m.x >= offset > 0, and
/// the origin is not. Where an offset was less, the crossings of a ray are counted at the end.
namespace boxwood::convex::detail {
namespace {

using V = Vec3<double>;
using Index = std::size_t;

struct Face {
    std::array<std::uint8_t, 3> corner; ///< anticlockwise from outside
    V normal;
    double plane; ///< the greatest of normal . corner
};
struct Edge {
    std::uint8_t from, to;
};

class Polytope {
  public:
    static constexpr int max_vertices = 128, max_faces = 2 * max_vertices, max_edges = 192;

    explicit Polytope(double size) : rounding_(8 * u * size) {}

    /// From a tetrahedron with a volume.
    void begin(const Simplex& s) {
        for (Index i = 0; i < 4; ++i)
            vertices_[i] = s.vertex[i];
        vertex_count_ = 4;
        const V a = w(0), b = w(1), c = w(2), d = w(3);
        const bool outward = dot(cross(b - a, c - a), d - a) < 0;
        const auto face = [&](std::uint8_t i, std::uint8_t j, std::uint8_t k) {
            outward ? add_face(i, j, k) : add_face(i, k, j);
        };
        face(0, 1, 2);
        face(0, 3, 1);
        face(1, 3, 2);
        face(2, 3, 0);
        sure_ = true;
        for (Index i = 0; i < 4; ++i)
            sure_ &= offset_[i] > rounding_;
    }

    Index least_face() const {
        Index best = 0;
        for (Index i = 1; i < face_count_; ++i)
            if (offset_[i] < offset_[best])
                best = i;
        return best;
    }
    const V& normal(Index face) const { return faces_[face].normal; }
    double plane(Index face) const { return faces_[face].plane; }
    double offset(Index face) const { return offset_[face]; }

    /// Adds a point beyond face `seen`. False if there is no room: then nothing has changed.
    bool expand(const Vertex& point, Index seen) {
        if (vertex_count_ == max_vertices || face_count_ + 2 > max_faces)
            return false;
        if (!find_hole(point.w, seen) || face_count_ - hole_count_ + rim_count_ > max_faces) {
            hole_count_ = 1; // hole_[0] is `seen`: split into three
            rim_count_ = 3;
            const auto [a, b, c] = faces_[seen].corner;
            rim_[0] = {a, b}, rim_[1] = {b, c}, rim_[2] = {c, a};
        }
        for (Index i = 0; i < hole_count_; ++i)
            sure_ &= offset_[hole_[i]] > 2 * rounding_ &&
                     dot(faces_[hole_[i]].normal, point.w) > offset_[hole_[i]] - rounding_;
        std::sort(hole_.begin(), hole_.begin() + static_cast<std::ptrdiff_t>(hole_count_));
        for (Index i = hole_count_; i-- > 0;)
            remove_face(hole_[i]);
        const auto top = static_cast<std::uint8_t>(vertex_count_);
        vertices_[static_cast<Index>(vertex_count_++)] = point;
        for (Index i = 0; i < rim_count_; ++i)
            add_face(rim_[i].from, rim_[i].to, top);
        return true;
    }

    /// The points of the face whose normal is nearest to the one that was found, among those that
    /// are as near to the origin as the bounds say, up to `slack`: of symmetric shapes several are.
    /// offset: the least of all.
    void take_points(double offset, double slack, CoreDistance& found) const {
        const double depth = std::max(offset, -found.lo) * (1 + 0x1p-36) + slack;
        double nearest = inf, alignment = -inf;
        for (Index face = 0; face < face_count_; ++face) {
            const double aligned = dot(faces_[face].normal, found.normal);
            if (!(offset_[face] <= depth) || (nearest == depth && !(aligned > alignment)))
                continue;
            const auto [i, j, k] = faces_[face].corner;
            const Vertices corners{vertices_[i], vertices_[j], vertices_[k]};
            Nearest on_face;
            find_nearest(corners, 0b111, true, on_face);
            const double d = std::max(length(on_face.point), depth);
            if (d < nearest || (d == nearest && aligned > alignment)) {
                nearest = d;
                alignment = aligned;
                found.between = on_face.point;
                found.on_a = on_face.on_a(corners);
            }
        }
    }

    bool is_sure() const { return sure_; }
    /// Whether the surface goes around the origin, once all offsets are positive.
    bool goes_around() const {
        if (sure_)
            return true;
        constexpr V ways[] = {{.1, .7, .5},  {-.6, .2, .3},  {.4, -.3, .8}, {-.2, -.5, -.9},
                              {.9, .1, -.4}, {-.7, .6, -.1}, {.3, -.8, -.2}};
        for (const V& way : ways)
            if (const int n = crossings(way); n != unclear)
                return n != 0;
        return false;
    }

  private:
    static constexpr int unclear = 1 << 20;
    static constexpr double sliver = 0x1p-70; ///< squared sine of an angle

    const V& w(Index i) const { return vertices_[i].w; }

    void add_face(std::uint8_t i, std::uint8_t j, std::uint8_t k) {
        const V p = w(j) - w(i), q = w(k) - w(i);
        V n = cross(p, q);
        if (is_sliver(p, q)) {
            Nearest nearest;
            find_nearest({vertices_[i], vertices_[j], vertices_[k]}, 0b111, true, nearest);
            n = nearest.point;
        }
        n = unit_or(n, {0, 0, 1});
        const double a = dot(n, w(i)), b = dot(n, w(j)), c = dot(n, w(k));
        faces_[face_count_] = {{i, j, k}, n, std::max({a, b, c})};
        offset_[face_count_] = std::min({a, b, c});
        link(face_count_++, i, j, k);
    }

    void link(Index i, std::uint8_t a, std::uint8_t b, std::uint8_t c) {
        left_of_[a][b] = left_of_[b][c] = left_of_[c][a] = static_cast<std::uint16_t>(i);
    }
    void remove_face(Index i) {
        --face_count_;
        if (i == face_count_)
            return;
        faces_[i] = faces_[face_count_];
        offset_[i] = offset_[face_count_];
        const auto [a, b, c] = faces_[i].corner;
        link(i, a, b, c);
    }

    bool is_sliver(const V& p, const V& q) const {
        const V n = cross(p, q);
        return !(dot(n, n) > sliver * (dot(p, p) * dot(q, q)));
    }

    /// The faces that see p or are level with it, as far as they hang together with `seen`, and the
    /// edges around them. False if that is more than one loop, by rounding.
    bool find_hole(const V& p, Index seen) {
        hole_count_ = 0;
        std::array<bool, max_faces> in_hole{};
        const auto take = [&](Index face) {
            in_hole[face] = true;
            hole_[hole_count_++] = static_cast<std::uint16_t>(face);
        };
        const auto for_edges = [&](Index face, auto f) {
            const auto [a, b, c] = faces_[face].corner;
            const auto cross_over = [&](std::uint8_t from, std::uint8_t to) {
                if (const Index next = left_of_[to][from]; !in_hole[next])
                    f(Edge{from, to}, next);
            };
            cross_over(a, b);
            cross_over(b, c);
            cross_over(c, a);
        };
        take(seen);
        for (Index done = 0; done < hole_count_; ++done)
            for_edges(hole_[done], [&](Edge, Index next) {
                if (dot(faces_[next].normal, p) > offset_[next] - rounding_)
                    take(next);
            });
        // A loop that comes twice through a vertex would put two more faces on one edge.
        std::array<bool, max_vertices> begun{};
        rim_count_ = 0;
        bool loop = true;
        for (Index i = 0; i < hole_count_; ++i)
            for_edges(hole_[i], [&](Edge e, Index) {
                loop &= !begun[e.from] && rim_count_ < max_edges;
                begun[e.from] = true;
                if (loop)
                    rim_[rim_count_++] = e;
            });
        return loop && rim_count_ >= 3;
    }

    /// How often a ray from the origin leaves through the surface, less how often it enters.
    int crossings(const V& way) const {
        int count = 0;
        for (Index f = 0; f < face_count_; ++f) {
            const auto [i, j, k] = faces_[f].corner;
            const V& a = w(i);
            const V& b = w(j);
            const V& c = w(k);
            const auto side = [&](const V& p, const V& q) {
                const double s = dot(way, cross(p, q));
                return std::abs(s) > 16 * u * norm1(p) * norm1(q) ? (s > 0 ? 1 : -1) : 0;
            };
            const int ab = side(a, b), bc = side(b, c), ca = side(c, a);
            const bool out = ab >= 0 && bc >= 0 && ca >= 0, in = ab <= 0 && bc <= 0 && ca <= 0;
            if (!out && !in)
                continue;
            const double ahead = dot(faces_[f].normal, way);
            if (ahead < -8 * u)
                continue;
            if (ab == 0 || bc == 0 || ca == 0 || ahead < 8 * u)
                return unclear;
            count += out ? 1 : -1;
        }
        return count;
    }

    std::array<Vertex, max_vertices> vertices_;
    std::array<Face, max_faces> faces_;
    std::array<double, max_faces> offset_;
    /// The face on the left of the edge from one vertex to another, where there is one.
    std::array<std::array<std::uint16_t, max_vertices>, max_vertices> left_of_;
    std::array<std::uint16_t, max_faces> hole_;
    std::array<Edge, max_edges> rim_;
    int vertex_count_ = 0;
    Index face_count_ = 0, hole_count_ = 0, rim_count_ = 0;
    double rounding_;
    bool sure_ = false;
};

/// What directions were tried, and the least that D extends along one of them.
struct Probe {
    const AnyDifference& difference;
    CoreDistance& found;

    Vertex along(const V& d) const {
        const Vertex p = difference.along(d);
        if (const double gap = -dot(d, p.w); gap > found.lo)
            found.lo = gap, found.normal = d;
        return p;
    }
    /// Adds the point among those along `ways` that is the farthest by `measure`; false if none is
    /// more than `least` away.
    template <class Measure, std::size_t n>
    bool grow(Simplex& s, const std::array<V, n>& ways, double least, Measure measure) const {
        Vertex best;
        double most = -inf;
        for (const V& d : ways)
            for (const V& way : {d, -d}) {
                const Vertex p = along(way);
                if (const double m = measure(p.w); m > most)
                    most = m, best = p;
            }
        if (most > least)
            s.add(best);
        return most > least;
    }
};

/// Makes the simplex a tetrahedron with a volume. False if D is flat: then found.lo is that of a
/// direction square to D.
bool grow_to_tetrahedron(const Probe& probe, Simplex& s, double least) {
    const auto w = [&](Index i) { return s.vertex[i].w; };
    if (s.size == 4) {
        const V n = unit_or(cross(w(1) - w(0), w(2) - w(0)), {});
        if (std::abs(dot(n, w(3) - w(0))) > least)
            return true;
        s.size = 3;
    }
    if (s.size == 3) {
        const V e = unit_or(w(1) - w(0), {});
        if (!(length(cross(w(2) - w(0), e)) > least))
            s.size = 2;
    }
    if (s.size == 2 && !(length(w(1) - w(0)) > least))
        s.size = 1;
    if (s.size == 1 && !probe.grow(s, std::array<V, 3>{V{1, 0, 0}, V{0, 1, 0}, V{0, 0, 1}}, least,
                                   [&](const V& p) { return length(p - w(0)); }))
        return false;
    if (s.size == 2) {
        const V e = unit_or(w(1) - w(0), {0, 0, 1});
        const V across = unit_or(square_to(e), {1, 0, 0});
        if (!probe.grow(s, std::array<V, 2>{across, cross(e, across)}, least,
                        [&](const V& p) { return length(cross(p - w(0), e)); }))
            return false;
    }
    const V n = unit_or(cross(w(1) - w(0), w(2) - w(0)), {0, 0, 1});
    return probe.grow(s, std::array<V, 1>{n}, least,
                      [&](const V& p) { return std::abs(dot(n, p - w(0))); });
}

/// Expands a tetrahedron until the bounds are good enough, or nothing more is gained. False if
/// rounding has torn the surface, so that another tetrahedron may do better.
bool expand(const Probe& probe, const Simplex& tetrahedron, const Goal& goal) {
    const double least = touching_size(goal.size);
    CoreDistance& found = probe.found;
    Polytope polytope(goal.size);
    polytope.begin(tetrahedron);
    Index face = 0;
    for (;;) {
        face = polytope.least_face();
        const double hi = -polytope.offset(face);
        if (hi < goal.hi_enough && polytope.goes_around())
            break;
        const V n = polytope.normal(face);
        const Vertex point = probe.along(n);
        if (goal.reached(found.lo, hi) || dot(n, point.w) <= polytope.plane(face) + least / 2 ||
            !polytope.expand(point, face))
            break;
    }
    const double offset = polytope.offset(face);
    if (offset > 0 && -offset < found.hi && polytope.goes_around()) {
        polytope.take_points(offset, least, found);
        found.hi = -offset;
    }
    return polytope.is_sure() || goal.reached(found.lo, found.hi);
}

} // namespace

void find_depth(const AnyDifference& difference, Simplex simplex, const Goal& goal,
                CoreDistance& found) {
    const Probe probe{difference, found};
    for (int tries = 0; tries < 3; ++tries) {
        if (!grow_to_tetrahedron(probe, simplex, touching_size(goal.size)) ||
            goal.reached(found.lo, found.hi) || expand(probe, simplex, goal) ||
            found.hi - found.lo <= 0x1p-20 * std::abs(found.hi))
            break;
        simplex = {};
        simplex.add(probe.along(tries == 0 ? found.normal : -found.normal));
    }
}

} // namespace boxwood::convex::detail

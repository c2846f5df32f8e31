#include "bench/stages/world_meshes.h"

#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "trees/queries/touching_pairs.h"
#include "trees/queries/tree_pairs.h"

#include <algorithm>
#include <unordered_map>

namespace boxwood::bench {
namespace {

/// Exact, and the float filter decides nearly all.
using Kernel = GuigueDevillersExactF32Batch;

struct PosedMesh {
    const std::vector<Vec3<float>>& vertices;
    const std::vector<std::array<std::uint32_t, 3>>& triangles;

    Triangle<float> triangle(std::uint32_t i) const {
        const auto& t = triangles[i];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
};

/// The triangles of two meshes that share a point, of each candidate pair of bodies with meshes.
/// Where neither of the two has changed since triangles were last found, they are the same.
class TrianglePairs final : public SceneStage {
  public:
    std::size_t start(Playing&) override {
        meetings_.clear();
        return 0;
    }

    std::size_t run(Playing& playing) override {
        if (!playing.pairs_are_new)
            return 0;
        std::vector<TouchingTriangles>& out = playing.answers.triangle_pairs;
        list_meetings(playing);
        found_in_ = playing.scene.frame();
        find(playing);

        next_.clear();
        for (const Meeting& meeting : meetings_)
            if (meeting.is_kept)
                next_.insert(next_.end(), out.begin() + at(meeting.first),
                             out.begin() + at(meeting.last));
            else
                for (const Pair p : found_[meeting.first])
                    next_.push_back({meeting.bodies.a, meeting.bodies.b, p.a, p.b});
        // where each meeting's now lie
        std::size_t end = 0;
        for (Meeting& meeting : meetings_) {
            const std::size_t n =
                meeting.is_kept ? meeting.last - meeting.first : found_[meeting.first].size();
            meeting.first = end;
            meeting.last = end += n;
        }
        out.swap(next_);
        return meetings_.size();
    }
    std::size_t bytes(const Playing&) const override {
        std::size_t bytes = bytes_of(meetings_) + bytes_of(next_) + bytes_of(found_);
        for (const auto& pairs : found_)
            bytes += bytes_of(pairs);
        return bytes;
    }

  private:
    /// Of two bodies, and which of the answers are theirs; until they are found, if not kept, the
    /// place in found_.
    struct Meeting {
        Pair bodies;
        std::size_t first, last;
        bool is_kept;
    };
    static std::ptrdiff_t at(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

    /// The meetings of this frame, with the answers of those before where they still hold.
    void list_meetings(const Playing& playing) {
        const WorldMeshes& meshes = *playing.meshes;
        std::unordered_map<std::uint64_t, std::size_t> before;
        const bool may_keep =
            !playing.is_full() && playing.changed.size() < playing.scene.bodies().size();
        const auto key = [](Pair p) { return std::uint64_t{p.a} << 32 | p.b; };
        if (may_keep)
            for (std::size_t i = 0; i < meetings_.size(); ++i)
                if (meshes.rests(meetings_[i].bodies, found_in_))
                    before.emplace(key(meetings_[i].bodies), i);
        std::vector<Meeting> now;
        std::size_t to_find = 0;
        for (const Pair p : *playing.pairs) {
            if (!meshes.has(p.a) || !meshes.has(p.b))
                continue;
            const auto same = before.find(key(p));
            if (same != before.end())
                now.push_back(
                    {p, meetings_[same->second].first, meetings_[same->second].last, true});
            else
                now.push_back({p, to_find++, 0, false});
        }
        meetings_.swap(now);
        if (found_.size() < to_find)
            found_.resize(to_find);
    }

    /// Side by side, or one after another if there are few.
    void find(const Playing& playing) {
        wanted_.clear();
        for (const Meeting& meeting : meetings_)
            if (!meeting.is_kept)
                wanted_.push_back(meeting.bodies);
        constexpr std::size_t few = 16;
        if (wanted_.size() < few) {
            for (std::size_t i = 0; i < wanted_.size(); ++i)
                meet(playing, wanted_[i], playing.executor, found_[i]);
            return;
        }
        playing.executor.for_each(
            wanted_.size(), [&](std::size_t i) { meet(playing, wanted_[i], serial(), found_[i]); });
    }

    static void meet(const Playing& playing, Pair bodies, const Executor& executor,
                     std::vector<Pair>& found) {
        found.clear();
        const WorldMesh& a = playing.meshes->of(bodies.a);
        const WorldMesh& b = playing.meshes->of(bodies.b);
        const Bodies& all = playing.scene.bodies();
        const PosedMesh mesh_a{a.vertices, all.meshes[all.mesh[bodies.a]].triangles};
        const PosedMesh mesh_b{b.vertices, all.meshes[all.mesh[bodies.b]].triangles};
        AppendPairs append(found);
        TouchingPairs<Kernel, PosedMesh> touching(mesh_a, mesh_b, append);
        tree_pairs(a.tree, b.tree, executor, touching);
    }

    std::vector<Meeting> meetings_;
    std::uint64_t found_in_ = 0;           ///< the frame of the meetings
    std::vector<Pair> wanted_;             ///< bodies whose triangles are to be found
    std::vector<std::vector<Pair>> found_; ///< triangles, of each of those
    std::vector<TouchingTriangles> next_;
};

} // namespace

std::unique_ptr<SceneStage> triangle_pairs_query() { return std::make_unique<TrianglePairs>(); }

} // namespace boxwood::bench

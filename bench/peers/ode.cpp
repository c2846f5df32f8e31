#include "bench/peers/answering.h"
#include "scenes/moving/frames.h"

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boxwood::bench {
namespace {

/// Of a geom: which box it is, and its sides as ODE wants them: min and max of x, of y, of z.
struct GeomData {
    std::uint32_t item;
    dReal bounds[6];
};

GeomData& data_of(dGeomID geom) { return *static_cast<GeomData*>(dGeomGetClassData(geom)); }

/// ODE while a contender lives, with a class of geoms that are a box each and nothing else.
class Library {
  public:
    Library() {
        dInitODE2(0);
        dAllocateODEDataForThread(dAllocateMaskAll);
        const dGeomClass boxes{
            sizeof(GeomData), [](int) { return static_cast<dColliderFn*>(nullptr); },
            [](dGeomID geom, dReal bounds[6]) { std::ranges::copy(data_of(geom).bounds, bounds); },
            nullptr, nullptr};
        box_class = dCreateGeomClass(&boxes);
    }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
    ~Library() { dCloseODE(); }

    static std::shared_ptr<Library> open() {
        static std::weak_ptr<Library> opened;
        std::shared_ptr<Library> library = opened.lock();
        if (!library)
            opened = library = std::make_shared<Library>();
        return library;
    }

    int box_class = 0;
};

struct Destroy {
    void operator()(dxGeom* geom) const { dGeomDestroy(geom); }
    void operator()(dxSpace* space) const { dSpaceDestroy(space); }
};
using Geom = std::unique_ptr<dxGeom, Destroy>;
using Space = std::unique_ptr<dxSpace, Destroy>;
using MakeSpace = dSpaceID (*)(const std::vector<Aabb<float>>& boxes);

void append(void* pairs, dGeomID a, dGeomID b) {
    static_cast<std::vector<Pair>*>(pairs)->push_back(
        ordered_pair(data_of(a).item, data_of(b).item));
}

class Collide final : public Contender {
  public:
    Collide(const Job& job, Sides sides, MakeSpace make)
        : library_(Library::open()), scene_(*job.scene), make_(make),
          is_present_(scene_.boxes.size()) {
        const std::size_t n = scene_.boxes.size(),
                          split = sides == Sides::two_halves ? tree_pairs_split(n) : 0;
        for (std::size_t i = 0; i < n; ++i) {
            geoms_.emplace_back(dCreateGeom(library_->box_class));
            dxGeom* const geom = geoms_.back().get();
            data_of(geom).item = static_cast<std::uint32_t>(i);
            give(i, scene_.boxes[i]);
            if (sides == Sides::two_halves) { // each half collides with the other alone
                dGeomSetCategoryBits(geom, i < split ? 1 : 2);
                dGeomSetCollideBits(geom, i < split ? 2 : 1);
            }
        }
    }

    void build() override {
        if (std::exchange(moved_, false))
            for (std::size_t i = 0; i < geoms_.size(); ++i)
                give(i, scene_.boxes[i]);
        if (space_ && dSpaceGetClass(space_.get()) == dQuadTreeSpaceClass)
            for (std::size_t i = 0; i < geoms_.size(); ++i) // its destructor forgets those
                if (is_present_[i])
                    dSpaceRemove(space_.get(), geoms_[i].get());
        space_.reset(); // which takes the geoms out of it
        space_.reset(make_(scene_.boxes));
        dSpaceSetCleanup(space_.get(), 0);
        for (std::size_t i = 0; i < geoms_.size(); ++i) {
            is_present_[i] = !scene_.boxes[i].is_empty();
            if (is_present_[i])
                dSpaceAdd(space_.get(), geoms_[i].get());
        }
        dSpaceClean(space_.get());
    }

    void update(const Frame& now) override {
        moved_ = true;
        for (const std::uint32_t i : now.moved) {
            const bool was_present = std::exchange(is_present_[i], !now.boxes[i].is_empty());
            if (!is_present_[i]) {
                dSpaceRemove(space_.get(), geoms_[i].get());
                continue;
            }
            give(i, now.boxes[i]);
            if (!was_present)
                dSpaceAdd(space_.get(), geoms_[i].get());
        }
        dSpaceClean(space_.get());
    }

    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        dSpaceCollide(space_.get(), &pairs, append);
    }

  private:
    void give(std::size_t i, const Aabb<float>& box) {
        dxGeom* const geom = geoms_[i].get();
        for (int axis = 0; axis < 3; ++axis) {
            data_of(geom).bounds[2 * axis] = static_cast<dReal>(box.min[axis]);
            data_of(geom).bounds[2 * axis + 1] = static_cast<dReal>(box.max[axis]);
        }
        dGeomSetPosition(geom, 0, 0, 0); // which tells the space that its bounds are new
    }

    std::shared_ptr<Library> library_;
    const Scene& scene_;
    MakeSpace make_;
    bool moved_ = false; ///< whether the boxes are those of a frame
    std::vector<char> is_present_;
    std::vector<Geom> geoms_; ///< by item
    Space space_;             ///< destroyed before the geoms
};

dSpaceID sap_space(const std::vector<Aabb<float>>&) {
    return dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
}

/// Cells of the mean of the longest sides and half of it: boxes that are longer than the largest
/// cell are compared with all others. With larger cells a tenth of a query less on cubes, and pairs
/// of long bars are lost.
dSpaceID hash_space(const std::vector<Aabb<float>>& boxes) {
    double sides = 0, present = 0;
    for (const Aabb<float>& box : boxes)
        if (!box.is_empty()) {
            const Vec3<float> side = box.max - box.min;
            sides += static_cast<double>(std::max({side.x, side.y, side.z}));
            ++present;
        }
    const int level = sides > 0 ? static_cast<int>(std::ceil(std::log2(sides / present))) : 0;
    const dSpaceID space = dHashSpaceCreate(nullptr);
    dHashSpaceSetLevels(space, level - 1, level);
    return space;
}

/// About as many leaves as boxes, in four to each level.
dSpaceID quadtree_space(const std::vector<Aabb<float>>& boxes) {
    Aabb<float> all; // empty
    std::size_t present = 0;
    for (const Aabb<float>& box : boxes)
        if (!box.is_empty()) {
            all.extend(box);
            ++present;
        }
    dVector3 centre{}, half{};
    for (int axis = 0; present > 0 && axis < 3; ++axis) {
        centre[axis] = .5 * (static_cast<dReal>(all.min[axis]) + static_cast<dReal>(all.max[axis]));
        half[axis] = .5 * (static_cast<dReal>(all.max[axis]) - static_cast<dReal>(all.min[axis]));
    }
    const double levels = .5 * std::log2(static_cast<double>(std::max<std::size_t>(present, 1)));
    return dQuadTreeSpaceCreate(nullptr, centre, half,
                                std::max(1, static_cast<int>(std::lround(levels))));
}

ContenderEntry entry(std::string name, std::string summary, const std::string& setting,
                     std::size_t most, MakeSpace make) {
    ContenderEntry e;
    e.name = "ode." + std::move(name);
    e.library = "ode";
    e.summary = "ODE's " + std::move(summary);
    e.notes =
        "each box is a geom of a class of ours that has bounds and nothing else; build = dSpaceAdd "
        "of each and dSpaceClean; query = dSpaceCollide with a callback that appends the pair; a "
        "frame: the geoms of the moved bodies are told of and dSpaceClean; " +
        setting + "; one thread, double precision";
    e.precision = "f64";
    e.runs_on = RunsOn::one_thread;
    e.cannot = [most](const Job& job) -> std::optional<std::string> {
        if (job.scene->boxes.size() <= most)
            return std::nullopt;
        return fmt::format("takes seconds for more than {} boxes", most);
    };
    e.answers = answering_all_pairs<Collide>(make);
    return e;
}

} // namespace

Peer ode_peer() {
    static_assert(std::is_same_v<dReal, double>);
    Peer peer;
    peer.name = "ode";
    peer.title = "ODE";
    peer.summary = "Open Dynamics Engine: collision spaces";
    peer.version = BOXWOOD_ODE_VERSION;
    peer.build = "the distribution's package: double precision";
    peer.contenders = {entry("sweep_and_prune", "dSweepAndPruneSpace, sorted along one axis",
                             "axes in the order x, y, z (the others were the same on cubes, and x, "
                             "z, y up to a sixth "
                             "slower on a layer, z first fifteen times)",
                             100'000, sap_space),
                       entry("hash_space", "dHashSpace, a hierarchy of grids",
                             "cells of the mean longest side and half of it", 20'000, hash_space),
                       entry("quadtree_space", "dQuadTreeSpace", "as deep as it has a leaf a box",
                             20'000, quadtree_space)};
    return peer;
}

} // namespace boxwood::bench

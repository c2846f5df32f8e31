/// Where and how deep the triangles of a mesh and a copy of it touch.

#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/truth/mesh_pair_truth.h"
#include "trees/world/mesh_contacts.h"

#include <xxhash.h>

#include <algorithm>
#include <bit>

namespace boxwood::bench {
namespace {

class AllContacts final : public MeshPairContender {
  public:
    using MeshPairContender::MeshPairContender;

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<PosedContact>& found = list_of<PosedContact>(answers);
        found.clear();
        for (std::uint32_t i = 0; i < scene_.poses.size(); ++i)
            for (const Contact& c : contacts(mesh(), copy(), scene_.poses[i], {}, work))
                found.push_back({c.point, c.normal, c.depth, {i, c.triangles.a, c.triangles.b}});
    }
};

class Contacts final : public MeshPairTask {
  public:
    std::string_view name() const override { return "contacts"; }
    std::string title() const override { return "contacts of two meshes"; }
    std::string_view summary() const override {
        return "of every pair of triangles of the scene's mesh and a copy of it that touch: where, "
               "along which normal and how deep; pose after pose, the deepest first";
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<PosedContact>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<PosedContact> sorted = list_of<PosedContact>(answers);
        std::ranges::sort(sorted, is_before);
        std::vector<std::uint64_t> words;
        for (const PosedContact& c : sorted)
            for (const std::uint64_t word :
                 {std::uint64_t{c.triangles.pose}, std::uint64_t{c.triangles.a},
                  std::uint64_t{c.triangles.b}, std::bit_cast<std::uint64_t>(c.depth)})
                words.push_back(word);
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_contact_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"contacts", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    Make make(const Choice&) const override { return mesh_pair_contender<AllContacts>; }
    Promise promise() const override { return Promise::exact; }
    std::vector<std::string> usual_poses() const override { return {"shallow", "deep"}; }
    std::string_view query_notes() const override {
        return "pose after pose, the contacts of each sorted by depth";
    }
};

} // namespace

const Task& contacts_task() {
    static const Contacts task;
    return task;
}

} // namespace boxwood::bench

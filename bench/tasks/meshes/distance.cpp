/// How far a mesh and a copy of it are apart.

#include "bench/plan/block_reader.h"
#include "bench/tasks/detail/mesh_pair_task.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/mesh_pair_truth.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace boxwood::bench {
namespace {

constexpr double errors_per_one = 1e6; ///< relative errors are in steps of a millionth

class LeastDistance final : public MeshPairContender {
  public:
    LeastDistance(const Job& job, BuildFunction build, MeshVolume volume, const Choice& choice)
        : MeshPairContender(job, std::move(build), volume),
          measure_(choice.is_plain ? plain_distance : distance), is_warm_(choice.warm_start) {
        options_.relative = choice.relative_error;
    }

  private:
    void run(Answers& answers, Work* work) override {
        std::vector<PosedDistance>& distances = list_of<PosedDistance>(answers);
        distances.clear();
        DistanceOptions options = options_;
        for (const Pose& pose : scene_.poses) {
            const MeshDistance d = measure_(mesh(), copy(), pose, options, work);
            distances.push_back(
                {d.distance, d.lo, d.hi, d.triangles, PosedDistance::Points{d.point_a, d.point_b}});
            if (is_warm_ && d.found())
                options.start = d.triangles;
        }
    }

    decltype(&distance) measure_;
    DistanceOptions options_;
    bool is_warm_;
};

class DistanceOfMeshes final : public MeshPairTask {
  public:
    std::string_view name() const override { return "distance"; }
    std::string title() const override { return "distance of two meshes"; }
    std::string_view summary() const override {
        return "how far the scene's mesh and a copy of it are apart, pose after pose";
    }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = MeshPairTask::keys();
        all.insert(all.end(), {"starts", "relative_errors", "certificates"});
        return all;
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<PosedDistance>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const PosedDistance& d : list_of<PosedDistance>(answers))
            words.push_back(std::bit_cast<std::uint64_t>(d.distance));
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_mesh_distance_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"answers", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    std::vector<Choice> variants(const BlockReader& block) const override {
        std::vector<Choice> all;
        for (const std::string& start : block.names("starts", {"cold", "warm"}, {"cold"}))
            for (const double error : block.numbers("relative_errors", 0, 0.99, {0.0})) {
                if (error > 0 && error * errors_per_one < 1)
                    block.fail("relative_errors: 0, or 0.000001 to 0.99", "relative_errors");
                Choice& choice = all.emplace_back();
                choice.warm_start = start == "warm";
                choice.relative_error = std::round(error * errors_per_one) / errors_per_one;
            }
        const std::vector<Choice> certified = std::exchange(all, {});
        for (const std::string& certificate :
             block.names("certificates", {"certified", "plain"}, {"certified"}))
            for (Choice choice : certified) {
                choice.is_plain = certificate == "plain";
                all.push_back(choice);
            }
        return all;
    }
    void add_variant(const Choice& choice, ContenderEntry& entry) const override {
        std::string of_class;
        Settings settings = choice.settings;
        entry.relative_width = choice.relative_error + 0x1p-32;
        if (choice.warm_start) {
            entry.name += ".warm";
            entry.notes += "; each begins at the triangles of the answer before";
            of_class = warm_start_class;
        }
        if (choice.relative_error > 0) {
            std::string error = fmt::format("{:.6f}", choice.relative_error);
            error.erase(error.find_last_not_of('0') + 1);
            (entry.name += results::error_mark) += error;
            entry.notes += fmt::format("; up to {} of the answer too far", error);
            settings["relative_error"] = choice.relative_error;
            of_class += fmt::format("{}relative error {}", of_class.empty() ? "" : " with ", error);
        }
        if (choice.is_plain) {
            entry.name += results::plain_mark;
            entry.notes += "; as plain doubles measure it, with no bound";
            entry.promise = Promise::none;
            settings["certified"] = std::int64_t{0};
            of_class += of_class.empty() ? "not certified" : ", not certified";
        }
        if (!of_class.empty())
            entry.classes = {of_class};
        if (settings.size() > choice.settings.size())
            entry.params_json = settings_json(settings);
    }
    Make make(const Choice& choice) const override {
        return [choice](const Job& job, BuildFunction build, MeshVolume volume) {
            return std::make_unique<LeastDistance>(job, std::move(build), volume, choice);
        };
    }
    Promise promise() const override { return Promise::certified; }
};

} // namespace

const Task& distance_task() {
    static const DistanceOfMeshes task;
    return task;
}

} // namespace boxwood::bench

#include "bench/plan/plan.h"

#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/plan/cell_name.h"
#include "bench/plan/families.h"
#include "bench/tasks/kernels/kernels.h"
#include "bench/tasks/moving_pairs.h"
#include "bench/tasks/ours.h"
#include "bench/tasks/scene_queries.h"
#include "scenes/effects/effect_scene.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <regex>

namespace boxwood::bench {
namespace {

/// The contenders that a block's `peers` names. A library stands for those of its contenders that
/// answer the ask; a contender named in full is planned even if all it can say is "unsupported".
std::vector<ContenderEntry> chosen_peers(const std::vector<std::string>& words, Ask ask) {
    const auto named = [&](std::string_view word) {
        return std::ranges::find(words, word) != words.end();
    };
    std::vector<ContenderEntry> chosen;
    for (const Peer& peer : peers())
        for (const ContenderEntry& contender : peer.contenders)
            if (named(contender.name) ||
                ((named("all") || named(peer.name)) && answers_at_all(contender, ask)))
                chosen.push_back(contender);
    return chosen;
}

class Expansion {
  public:
    explicit Expansion(std::vector<PlannedCell>& cells) : cells_(cells) {}

    void add(const Block& block, const SceneSpec& spec, Ask ask) {
        if (is_kernel_ask(ask))
            return add_kernels(block, spec, ask);
        for (const unsigned threads : block.threads) {
            const std::string usual = threads == 1 ? "serial" : "tbb";
            for (const std::string& executor :
                 block.executors.empty() ? std::vector{usual} : block.executors)
                if (threads == 1 || executor != "serial")
                    add_ours(block, spec, ask, executor, threads);
            for (const ContenderEntry& peer : chosen_peers(block.peers, ask))
                add_cell(block, spec, ask, peer, usual, threads);
        }
    }

  private:
    /// One pair of primitives at a time: on one thread, whatever the sweep says.
    void add_kernels(const Block& block, const SceneSpec& spec, Ask ask) {
        for (const std::string& kernel : kernels_of(block, ask))
            add_cell(block, spec, ask, rung_contender(ask, kernel), "serial", 1);
        for (const ContenderEntry& peer : chosen_peers(block.peers, ask))
            add_cell(block, spec, ask, peer, "serial", 1);
    }

    void add_ours(const Block& block, const SceneSpec& spec, Ask ask, const std::string& executor,
                  unsigned threads) {
        if (ask == Ask::moving_pairs) {
            for (const BuilderChoice& update : block.updates)
                add_cell(block, spec, ask, moving_contender(update), executor, threads);
            return;
        }
        if (ask == Ask::scene_queries) {
            for (const ContenderEntry& contender :
                 scene_contenders(block.stages, block.without, *spec.moving))
                add_cell(block, spec, ask, contender, executor, threads);
            return;
        }
        const std::vector<std::string> kernels =
            takes_kernel(ask) ? kernels_of(block, ask) : std::vector<std::string>{""};
        for (const BuilderChoice& builder : block.builders)
            for (const std::string& layout : block.layouts)
                for (const std::string& kernel : kernels)
                    for (const std::string& order : block.ray_order)
                        add_cell(block, spec, ask,
                                 our_contender(
                                     {builder.name, builder.settings, layout, kernel, order}, ask),
                                 executor, threads);
    }

    /// Equal cells collapse; two cells of one name that are not equal are an error.
    void add_cell(const Block& block, const SceneSpec& spec, Ask ask, ContenderEntry contender,
                  const std::string& executor, unsigned threads) {
        const std::string name =
            format_cell_name({scene_name(spec), spec.n, spec.seed, std::string(to_string(ask)),
                              contender.name, contender.precision, executor, threads});
        const auto [seen, is_new] = index_of_.try_emplace(name, cells_.size());
        if (is_new) {
            cells_.push_back(
                {name, spec, ask, std::move(contender), executor, threads, block.rounds});
            return;
        }
        if (auto& rounds = cells_[seen->second].rounds; rounds && block.rounds)
            rounds = std::max(*rounds, *block.rounds);
        else
            rounds.reset();
        const SceneSpec& other = cells_[seen->second].scene;
        if (other.overlaps != spec.overlaps || other.n_rays != spec.n_rays ||
            other.n_points != spec.n_points || other.file != spec.file)
            throw BadInput(fmt::format("{}: the cell {} stands twice with different scenes "
                                       "(overlaps {} and {}, n_rays {} and {}, n_points {} and "
                                       "{}, file \"{}\" and \"{}\"); make them equal",
                                       block.place, name, other.overlaps, spec.overlaps,
                                       other.n_rays, spec.n_rays, other.n_points, spec.n_points,
                                       other.file.string(), spec.file.string()));
    }

    std::vector<PlannedCell>& cells_;
    std::map<std::string, std::size_t, std::less<>> index_of_;
};

/// The number of triangles of a mesh file, so that cell names can say it.
std::size_t mesh_size(const std::filesystem::path& file) {
    SceneSpec spec;
    spec.generator = "mesh";
    spec.file = file;
    try {
        return make_scene(spec).boxes.size();
    } catch (const std::exception& error) {
        throw BadInput(fmt::format("--mesh: {}", error.what()));
    }
}

bool is_mesh(const Block& block) { return block.scenes.front() == "mesh"; }

/// Every family that the block's words stand for, at every k and scale. A group of families passes
/// over those that a scale is out of range for; a named family refuses it.
void expand_families(const Block& block, std::uint64_t seed, Expansion& expansion) {
    const std::vector<int> scales = block.scales.empty() ? std::vector{0} : block.scales;
    std::vector<std::optional<int>> all_k(block.k.begin(), block.k.end());
    if (all_k.empty())
        all_k.emplace_back();
    SceneSpec spec;
    spec.seed = seed;
    for (const std::string& word : block.scenes)
        for (const Ask ask : block.tasks)
            for (const HardCaseFamily* family : families_of(word, ask))
                for (const std::size_t n : block.n)
                    for (const std::optional<int> k : all_k)
                        for (const int scale : scales) {
                            if (is_group(word) &&
                                (scale < family->scale_min || scale > family->scale_max))
                                continue;
                            spec.generator = family->name;
                            spec.n = n;
                            spec.k = k;
                            spec.scale = scale;
                            expansion.add(block, spec, ask);
                        }
}

/// The kinds of regions, or the numbers of neighbours, of the asks that have them.
void add_queries(const Block& block, SceneSpec spec, Ask ask, Expansion& expansion) {
    for (const std::string& regions :
         ask == Ask::regions ? block.regions : std::vector<std::string>{""}) {
        spec.regions = regions;
        spec.k.reset();
        if (ask != Ask::nearest || block.k.empty()) {
            expansion.add(block, spec, ask);
            continue;
        }
        for (const int k : block.k) {
            spec.k = k;
            expansion.add(block, spec, ask);
        }
    }
}

bool is_generator(std::string_view word) {
    return std::ranges::any_of(scene_generators(),
                               [&](const SceneEntry& entry) { return entry.name == word; });
}

void add_moving(const Block& block, SceneSpec spec, SceneFile file, Expansion& expansion) {
    file.n = spec.n;
    file.seed = spec.seed;
    if (block.n_frames && *block.n_frames != file.frames) {
        file.frames = *block.n_frames;
        file.name += fmt::format("_frames{}", file.frames);
    }
    spec.moving = std::make_shared<const SceneFile>(std::move(file));
    for (const Ask ask : block.tasks)
        expansion.add(block, spec, ask);
}

/// Every moving scene that is named, and every generator with each of the effects.
void expand_moving(const Block& block, std::uint64_t seed, Expansion& expansion) {
    SceneSpec spec;
    spec.seed = seed;
    for (const std::string& scene : block.scenes) {
        spec.generator = scene;
        if (is_generator(scene)) {
            for (const std::size_t n : block.n.empty() ? std::vector{SceneSpec{}.n} : block.n)
                for (const double overlaps : block.overlaps)
                    for (const std::vector<EffectChoice>& effects : block.effects) {
                        spec.n = n;
                        spec.overlaps = overlaps;
                        add_moving(block, spec, effect_scene(spec, effects), expansion);
                    }
            continue;
        }
        const SceneFile file = load_scene(scene);
        spec.overlaps = SceneSpec{}.overlaps;
        spec.file = scene.ends_with(".toml") ? scene : "";
        for (const std::size_t n : block.n.empty() ? std::vector{file.n} : block.n) {
            spec.n = n;
            add_moving(block, spec, file, expansion);
        }
        spec.file.clear();
    }
}

void expand(const Block& block, std::uint64_t seed, const std::filesystem::path& mesh,
            Expansion& expansion) {
    if (is_kernel_ask(block.tasks.front()))
        return expand_families(block, seed, expansion);
    if (is_moving_ask(block.tasks.front()))
        return expand_moving(block, seed, expansion);
    SceneSpec spec;
    spec.seed = seed;
    spec.file = is_mesh(block) ? mesh : "";
    for (const std::string& scene : block.scenes)
        for (const Ask ask : block.tasks)
            for (const std::size_t n : block.n)
                for (const double overlaps : block.overlaps)
                    for (const std::string& rays :
                         is_ray_ask(ask) ? block.rays : std::vector<std::string>{""}) {
                        spec.generator = scene;
                        spec.n = n;
                        spec.overlaps = overlaps;
                        spec.n_points = is_point_ask(ask) ? block.n_points : 0;
                        spec.rays = rays;
                        spec.n_rays = rays.empty() ? 0 : block.n_rays;
                        add_queries(block, spec, ask, expansion);
                    }
}

void keep_only(const std::string& pattern, std::vector<PlannedCell>& cells) {
    try {
        const std::regex only(pattern);
        std::erase_if(cells,
                      [&](const PlannedCell& cell) { return !std::regex_search(cell.name, only); });
    } catch (const std::regex_error& error) {
        throw BadInput(
            fmt::format("--only \"{}\" is not a regular expression: {}", pattern, error.what()));
    }
}

} // namespace

Plan make_plan(const std::string& config_text, const std::string& config_file,
               const Overrides& overrides) {
    Config config = parse_config(config_text, config_file);
    Plan plan;
    plan.config_text = config_text;
    plan.rounds = overrides.rounds.value_or(config.rounds);
    plan.min_time_ms = config.min_time_ms;
    plan.delta = config.delta;
    plan.seed = overrides.seed.value_or(config.seed);

    std::uint64_t mesh_hash = 0;
    std::size_t mesh_items = 0;
    if (!overrides.mesh.empty()) {
        if (std::ranges::none_of(config.blocks, is_mesh))
            throw BadInput(fmt::format("--mesh: {} has no [[cells]] block with scene = \"mesh\" "
                                       "that would use it",
                                       config_file));
        mesh_items = mesh_size(overrides.mesh);
        const std::string bytes = read_text(overrides.mesh.string());
        mesh_hash = XXH3_64bits(bytes.data(), bytes.size());
    }
    Expansion expansion(plan.cells);
    for (Block& block : config.blocks) {
        if (is_mesh(block) && overrides.mesh.empty())
            continue;
        if (is_mesh(block))
            block.n = {mesh_items};
        if (!overrides.threads.empty())
            block.threads = overrides.threads;
        try {
            expand(block, plan.seed, overrides.mesh, expansion);
        } catch (const BadInput&) {
            throw;
        } catch (const std::exception& error) { // a scene file that cannot be read, too
            throw BadInput(fmt::format("{}: {}", block.place, error.what()));
        }
    }
    if (!overrides.only.empty())
        keep_only(overrides.only, plan.cells);
    if (plan.cells.empty())
        throw BadInput(overrides.only.empty()
                           ? fmt::format("{}: no cell to measure; blocks of scene \"mesh\" need "
                                         "--mesh FILE",
                                         config_file)
                           : fmt::format("--only \"{}\" leaves no cell of {}; --dry-run without "
                                         "it lists all",
                                         overrides.only, config_file));
    plan.sweep_hash = sweep_hash_of(plan, mesh_hash);
    return plan;
}

namespace {

/// The content of the user's own scene file, as a hash.
std::string scene_file_text(const SceneSpec& spec) {
    if (!spec.moving || spec.file.empty())
        return {};
    const std::string text = read_text(spec.file.string());
    return fmt::format(" file {:x}", XXH3_64bits(text.data(), text.size()));
}

} // namespace

std::string sweep_hash_of(const Plan& plan, std::uint64_t mesh_hash) {
    std::string canonical =
        fmt::format("min_time_ms {} seed {} mesh {:x}\n", plan.min_time_ms, plan.seed, mesh_hash);
    std::vector<std::string> lines;
    for (const PlannedCell& cell : plan.cells)
        lines.push_back(fmt::format(
            "{} overlaps {} n_rays {}{}{}{}\n", cell.name, cell.scene.overlaps, cell.scene.n_rays,
            cell.scene.n_points == 0 ? std::string()
                                     : fmt::format(" n_points {}", cell.scene.n_points),
            scene_file_text(cell.scene),
            cell.rounds ? fmt::format(" rounds {}", *cell.rounds) : std::string()));
    std::ranges::sort(lines); // the order of blocks does not matter
    for (const std::string& line : lines)
        canonical += line;
    const XXH128_hash_t hash = XXH3_128bits(canonical.data(), canonical.size());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::uint64_t order_seed_of(std::uint64_t seed, unsigned round) {
    const std::uint64_t key[2] = {seed, round};
    return XXH3_64bits(key, sizeof key);
}

std::vector<std::size_t> shuffled_order(std::size_t count, std::uint64_t order_seed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    // Fisher-Yates by hand: std::shuffle may differ between standard libraries. The modulo's bias
    // is below count / 2^64.
    std::mt19937_64 random(order_seed);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[random() % i]);
    return order;
}

} // namespace boxwood::bench

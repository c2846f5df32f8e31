#include "bench/plan/plan.h"

#include "bench/io/bad_input.h"
#include "bench/io/csv.h"
#include "bench/io/pattern.h"
#include "bench/plan/cell_name.h"
#include "bench/plan/config.h"
#include "scenes/moving/recording.h"
#include "scenes/robots/robot_scene.h"
#include "scenes/sampling/rays.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <xxhash.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>

namespace boxwood::bench {
namespace {

/// The cells of all blocks, each once.
class Expansion {
  public:
    explicit Expansion(std::vector<PlannedCell>& cells) : cells_(cells) {}

    void add(const Block& block) {
        for (const Task* task : block.tasks)
            task->expand(block.reader, [&](const SceneSpec& scene, const ContenderEntry& contender,
                                           const std::string& executor, unsigned threads) {
                for (const std::string& isa : block.instruction_sets)
                    add_cell(
                        block,
                        {"", scene, task, contender, executor, threads, block.rounds, isa,
                         block.cold_build && task->phases() == Phases::build_and_query &&
                             !is_device(executor),
                         block.cold_caches && std::ranges::count(task->keys(), "cold_caches") > 0});
            });
    }

  private:
    /// Equal cells collapse.
    void add_cell(const Block& block, PlannedCell cell) {
        const SceneSpec& spec = cell.scene;
        refuse_another(spec, block);
        cell.name = format_cell_name(
            {scene_name(spec), spec.n, spec.seed, std::string(cell.task->name()),
             cell.contender.name, cell.contender.precision, cell.executor, cell.threads, cell.isa});
        const auto [seen, is_new] = index_of_.try_emplace(cell.name, cells_.size());
        if (is_new) {
            cells_.push_back(std::move(cell));
            return;
        }
        cells_[seen->second].cold_build |= cell.cold_build;
        cells_[seen->second].cold_caches |= cell.cold_caches;
        if (auto& rounds = cells_[seen->second].rounds; rounds && block.rounds)
            rounds = std::max(*rounds, *block.rounds);
        else
            rounds.reset();
    }

    /// A scene is made once for all of its cells, whatever their tasks: by one of them.
    void refuse_another(const SceneSpec& spec, const Block& block) {
        const auto [seen, is_new] = scenes_.try_emplace(scene_key(spec), spec);
        const SceneSpec& other = seen->second;
        if (other.overlaps != spec.overlaps || other.n_rays != spec.n_rays ||
            other.n_points != spec.n_points || other.n_poses != spec.n_poses ||
            other.file != spec.file || other.rays_file != spec.rays_file)
            throw BadInput(fmt::format("{}: the scene {} stands twice and differs "
                                       "(overlaps {} and {}, n_rays {} and {}, n_points {} and "
                                       "{}, n_poses {} and {}, file \"{}\" and \"{}\", rays \"{}\" "
                                       "and \"{}\"); make them equal",
                                       block.reader.place(), seen->first, other.overlaps,
                                       spec.overlaps, other.n_rays, spec.n_rays, other.n_points,
                                       spec.n_points, other.n_poses, spec.n_poses,
                                       other.file.string(), spec.file.string(),
                                       other.rays_file.string(), spec.rays_file.string()));
    }

    std::vector<PlannedCell>& cells_;
    std::map<std::string, std::size_t, std::less<>> index_of_;
    std::map<std::string, SceneSpec, std::less<>> scenes_; ///< by scene_key
};

struct OwnOption {
    std::string_view option, scene; ///< of the blocks that use its files
    std::vector<std::filesystem::path> Overrides::*files;
};
constexpr OwnOption own_options[] = {{"--mesh", "mesh", &Overrides::meshes},
                                     {"--boxes", "boxes", &Overrides::boxes},
                                     {"--motion", motion_scene, &Overrides::motions},
                                     {"--robot", robot_scene, &Overrides::robots},
                                     {"--rays", "mesh", &Overrides::rays}};

/// The number of items of a file, so that cell names can say it.
std::size_t size_of(const OwnOption& own, const std::filesystem::path& file) {
    SceneSpec spec;
    spec.generator = own.scene;
    spec.file = file;
    try {
        if (own.files == &Overrides::rays)
            return read_rays(file).size();
        if (own.files == &Overrides::motions)
            return read_recording(file).front().size();
        return make_scene(spec).boxes.size();
    } catch (const std::exception& error) {
        throw BadInput(fmt::format("{}: {}", own.option, error.what()));
    }
}

/// Adds the user's files to the inputs; gives a hash of their content, 0 if there are none.
std::uint64_t add_own_files(const Config& config, const std::string& config_file,
                            const Overrides& overrides, SweepInputs& inputs) {
    std::string content;
    for (const OwnOption& own : own_options)
        for (const std::filesystem::path& file : overrides.*own.files) {
            if (std::ranges::none_of(config.blocks, [&own](const Block& block) {
                    return block.reader.takes(own.scene);
                }))
                throw BadInput(fmt::format("{}: {} has no [[cells]] block with scene = \"{}\" "
                                           "that would use it",
                                           own.option, config_file, own.scene));
            if (own.files == &Overrides::rays)
                inputs.own_rays.push_back({file, size_of(own, file)});
            else
                inputs.own.push_back({std::string(own.scene), file, size_of(own, file)});
            content += read_text(file.string());
        }
    if (!overrides.rays.empty() && overrides.meshes.empty())
        throw BadInput("--rays: there is no mesh to cast them at; give --mesh FILE, too");
    return content.empty() ? 0 : XXH3_64bits(content.data(), content.size());
}

void keep_only(const std::string& pattern, std::vector<PlannedCell>& cells) {
    const Pattern only(pattern);
    std::erase_if(cells, [&](const PlannedCell& cell) { return !only.is_in(cell.name); });
}

} // namespace

std::vector<std::string> Overrides::arguments() const {
    std::vector<std::string> words;
    if (!threads.empty())
        words.insert(words.end(), {"--threads", fmt::format("{}", fmt::join(threads, ","))});
    if (!only.empty())
        words.insert(words.end(), {"--only", only});
    if (seed)
        words.insert(words.end(), {"--seed", std::to_string(*seed)});
    for (const OwnOption& own : own_options)
        for (const std::filesystem::path& file : this->*own.files)
            words.insert(words.end(), {std::string(own.option), file.string()});
    return words;
}

Plan make_plan(const std::string& config_text, const std::string& config_file,
               const Overrides& overrides) {
    Config config = parse_config(config_text, config_file);
    Plan plan;
    plan.config_text = config_text;
    plan.rounds = overrides.rounds.value_or(config.rounds);
    plan.min_time_ms = config.min_time_ms;
    plan.delta = config.delta;
    plan.inputs = config.inputs;
    plan.seed = overrides.seed.value_or(config.seed);

    SweepInputs inputs{plan.seed,
                       overrides.threads.empty() ? config.threads : overrides.threads,
                       !overrides.threads.empty(),
                       {},
                       {}};
    const std::uint64_t files_hash = add_own_files(config, config_file, overrides, inputs);
    Expansion expansion(plan.cells);
    for (Block& block : config.blocks) {
        block.reader.set_inputs(inputs);
        try {
            expansion.add(block);
        } catch (const BadInput&) {
            throw;
        } catch (const std::exception& error) { // a scene file that cannot be read, too
            throw BadInput(fmt::format("{}: {}", block.reader.place(), error.what()));
        }
    }
    if (!overrides.only.empty())
        keep_only(overrides.only, plan.cells);
    if (plan.cells.empty())
        throw BadInput(
            overrides.only.empty()
                ? fmt::format(
                      "{}: no cell to measure; blocks of scene \"mesh\" need "
                      "--mesh FILE, of \"boxes\" --boxes FILE, of \"motion\" --motion FILE, "
                      "of \"robot\" --robot FILE",
                      config_file)
                : fmt::format("--only \"{}\" leaves no cell of {}; --dry-run without "
                              "it lists all",
                              overrides.only, config_file));
    plan.sweep_hash = sweep_hash_of(plan, files_hash);
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

std::string sweep_hash_of(const Plan& plan, std::uint64_t files_hash) {
    std::string canonical =
        fmt::format("min_time_ms {} seed {} mesh {:x}{}\n", plan.min_time_ms, plan.seed, files_hash,
                    plan.inputs > 1 ? fmt::format(" inputs {}", plan.inputs) : std::string());
    std::vector<std::string> lines;
    for (const PlannedCell& cell : plan.cells)
        lines.push_back(fmt::format(
            "{} overlaps {} n_rays {}{}{}{}{}{}{}\n", cell.name, cell.scene.overlaps,
            cell.scene.n_rays,
            cell.scene.n_points == 0 ? std::string()
                                     : fmt::format(" n_points {}", cell.scene.n_points),
            cell.scene.n_poses == 0 ? std::string()
                                    : fmt::format(" n_poses {}", cell.scene.n_poses),
            scene_file_text(cell.scene),
            cell.rounds ? fmt::format(" rounds {}", *cell.rounds) : std::string(),
            cell.cold_build ? " cold_build" : "", cell.cold_caches ? " cold_caches" : ""));
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

std::string scene_key(const SceneSpec& spec) {
    return fmt::format("{}/n{}-s{}", scene_name(spec), spec.n, spec.seed);
}

} // namespace boxwood::bench

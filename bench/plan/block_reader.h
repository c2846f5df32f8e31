#pragma once

#include "bench/tasks/contender.h"
#include "scenes/moving/scene_file.h"
#include "trees/builder.h"
#include "trees/function_ref.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

class ConfigReader;

/// A builder or policy as a sweep file names it: `"median"` or `{name = "binned_sah", bins = 16}`.
struct BuilderChoice {
    std::string name;
    Settings settings;
};

/// A file of the user's: of which generator, and how many items it holds.
struct OwnScene {
    std::string generator;
    std::filesystem::path file;
    std::size_t items = 0;
};

/// A file with rays of the user's, for the blocks with scene = "mesh".
struct OwnRays {
    std::filesystem::path file;
    std::size_t n = 0;
};

/// What holds for all blocks of a sweep.
struct SweepInputs {
    std::uint64_t seed = 1;
    std::vector<unsigned> threads;  ///< of blocks that name none
    bool overrides_threads = false; ///< also of those that do
    std::vector<OwnScene> own;      ///< of the user's files
    std::vector<OwnRays> own_rays;
};

/// Where a contender of a block runs.
struct Place {
    std::string executor;
    unsigned threads = 1;
};

/// One [[cells]] block of a sweep file, from which tasks read their keys. Every bad value throws
/// BadInput, "file:line: what is wrong and what is allowed".
class BlockReader {
  public:
    using Names = std::vector<std::string_view>;
    struct Table; ///< the block as parsed

    BlockReader(std::shared_ptr<const ConfigReader> reader, std::shared_ptr<const Table> table);

    const SweepInputs& inputs() const { return inputs_; }
    void set_inputs(SweepInputs inputs) { inputs_ = std::move(inputs); }
    /// "FILE:LINE"
    std::string place() const;
    /// The keys that the block has, in the order of the alphabet.
    Names keys() const;
    bool has(std::string_view key) const;
    /// Whether its scene is a file of the user's, for that generator.
    bool takes(std::string_view generator) const;
    /// At the line of the key, or of the block.
    [[noreturn]] void fail(const std::string& message, std::string_view key = {}) const;

    // A list, or one value; `otherwise` if the block does not have the key.
    std::vector<std::string> names(std::string_view key, const Names& known,
                                   std::vector<std::string> otherwise = {}) const;
    std::vector<std::int64_t> integers(std::string_view key, std::int64_t min, std::int64_t max,
                                       std::vector<std::int64_t> otherwise = {}) const;
    std::vector<double> numbers(std::string_view key, double min, double max,
                                std::vector<double> otherwise = {}) const;
    std::vector<BuilderChoice> builders() const;
    /// try_out throws std::invalid_argument for a bad setting.
    std::vector<BuilderChoice>
    choices(std::string_view key, std::string_view what, const Names& known,
            FunctionRef<void(const std::string& name, const Settings& settings)> try_out) const;
    /// Each element is what is laid on the bodies of one scene.
    std::vector<std::vector<EffectChoice>> effects() const;
    /// Generators, built-in moving scenes, or paths of scene files.
    std::vector<std::string> moving_scenes() const;

    std::optional<std::uint64_t> integer(std::string_view key, std::int64_t min,
                                         std::int64_t max) const;

    // Keys of many tasks.
    std::vector<std::size_t> sizes(std::vector<std::size_t> otherwise) const; ///< n
    /// Registry names, "all" resolved.
    std::vector<std::string> kernels(const Names& known, std::vector<std::string> otherwise) const;
    /// A library stands for those of its contenders that answer the task; a contender named in full
    /// is there even if all it can say is "unsupported".
    std::vector<ContenderEntry> peers(std::string_view task) const;
    /// By the keys threads and executors: where ours run, and where peers do, those that run on
    /// devices alone at the places of a device.
    std::vector<Place> places() const;
    std::vector<Place> usual_places() const;
    std::vector<Place> device_places() const;

  private:
    std::vector<unsigned> threads() const;
    std::vector<std::string> executor_names() const;

    std::shared_ptr<const ConfigReader> reader_;
    std::shared_ptr<const Table> table_;
    SweepInputs inputs_;
};

} // namespace boxwood::bench

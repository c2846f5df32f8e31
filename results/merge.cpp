#include "results/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace boxwood::results {
namespace {

/// The ids of one table of one part, as ids of the joined table.
class Renumbering {
  public:
    explicit Renumbering(std::string_view table) : table_(table) {}
    void set(std::uint32_t from, std::uint32_t to) {
        if (!ids_.emplace(from, to).second)
            throw std::runtime_error(fmt::format("cannot merge: {} has id {} twice", table_, from));
    }
    std::uint32_t operator()(std::uint32_t id) const {
        const auto found = ids_.find(id);
        if (found == ids_.end())
            throw std::runtime_error(fmt::format(
                "cannot merge: a row refers to id {}, which {} does not have", id, table_));
        return found->second;
    }

  private:
    std::string_view table_;
    std::map<std::uint32_t, std::uint32_t> ids_;
};

/// Rows that are one when their keys are equal; the first one stays.
template <class Key, class Row> class Merged {
  public:
    explicit Merged(std::vector<Row>& rows) : rows_(rows) {}
    /// The number of the row of this key, and whether it is new.
    std::pair<std::uint32_t, bool> add(const Key& key, const Row& row) {
        const auto next = static_cast<std::uint32_t>(rows_.size());
        const auto [found, is_new] = index_.emplace(key, next);
        if (is_new)
            rows_.push_back(row);
        return {found->second, is_new};
    }

  private:
    std::vector<Row>& rows_;
    std::map<Key, std::uint32_t> index_;
};

using Strings = std::vector<std::string>;

/// What two parts that hold one shard must agree on.
auto content_of(const Sample& s) {
    return std::tuple(s.cell_id, s.position, s.phase, std::bit_cast<std::uint64_t>(s.wall_ns),
                      std::bit_cast<std::uint64_t>(s.cpu_ns), s.iterations, s.flags);
}
/// By shard.
using Contents = std::map<std::uint32_t, std::multiset<decltype(content_of(Sample{}))>>;

/// Gives the old id.
template <class Row> std::uint32_t renumber(std::uint32_t& id, const std::vector<Row>& rows) {
    return std::exchange(id, static_cast<std::uint32_t>(rows.size()));
}

class Merger {
  public:
    void add(const Results& part, std::string name) {
        name_ = std::move(name);
        add_header(part);
        add_machines_and_cells(part);
        add_samples(part);
        add_facts(part);
    }
    Results take() { return std::move(all_); }

  private:
    void add_header(const Results& part);
    void add_machines_and_cells(const Results& part);
    void add_samples(const Results& part);
    /// Those of new shards.
    template <class Row> void add_rounds(const std::vector<Row>& rows, std::vector<Row>& all);
    /// Shards that both have must be the same: neither file is to win silently.
    void compare_known(const Results& part) const;
    void add_facts(const Results& part);

    Results all_;
    bool first_ = true;
    Merged<std::string, Env> env_{all_.env};
    Merged<std::pair<std::uint32_t, std::string>, Package> packages_{all_.packages};
    Merged<std::tuple<std::string, std::uint64_t, std::uint64_t, std::uint64_t>, SceneRow> scenes_{
        all_.scenes};
    Merged<std::string, TaskRow> tasks_{all_.tasks};
    Merged<Strings, Variant> variants_{all_.variants};
    Merged<std::tuple<std::string, std::uint32_t, std::uint32_t, std::string>, Cell> cells_{
        all_.cells};
    Merged<std::tuple<std::uint32_t, std::uint32_t, std::uint64_t, std::uint32_t>, Shard> shards_{
        all_.shards};
    Merged<std::pair<std::uint32_t, std::string>, Counter> counters_{all_.counters};
    Merged<std::pair<std::uint32_t, std::string>, Check> checks_{all_.checks};
    Merged<std::uint32_t, TreeRow> trees_{all_.trees};
    Merged<std::pair<std::uint32_t, std::string>, KernelRow> kernels_{all_.kernels};
    Merged<std::pair<std::uint32_t, double>, ConditionRow> conditions_{all_.conditions};
    std::map<std::string, std::uint64_t> content_of_; ///< of the scene of a cell name
    Strings names_of_shards_;                         ///< of the parts that brought them
    // Of the part that is being added.
    std::string name_;
    Renumbering env_ids_{"env"}, scene_ids_{"scenes"}, variant_ids_{"variants"}, cell_ids_{"cells"},
        shard_ids_{"shards"};
    std::set<std::uint32_t> new_shards_; ///< old ids
};

/// The first part gives the header. A text that differs is kept beside it as "name.2" and so on.
void Merger::add_header(const Results& part) {
    if (first_) {
        all_.run_uuid = part.run_uuid;
        all_.created_utc = part.created_utc;
        all_.sweep_hash = part.sweep_hash;
        all_.generator = part.generator;
    }
    first_ = false;
    if (all_.sweep_hash != part.sweep_hash)
        all_.sweep_hash = "mixed";
    all_.complete = all_.complete && part.complete;
    for (const auto& [name, text] : part.texts) {
        std::string free = name;
        for (int i = 2; all_.texts.contains(free) && all_.texts[free] != text; ++i)
            free = fmt::format("{}.{}", name, i);
        all_.texts[free] = text;
    }
}

void Merger::add_machines_and_cells(const Results& part) {
    env_ids_ = Renumbering("env");
    for (Env row : part.env) {
        if (!all_.env.empty() && processor(row) != processor(all_.env[0]))
            throw std::runtime_error(fmt::format(
                "cannot merge: {} was measured on '{}', those before it on '{}'; times of two "
                "processor models are never pooled: keep a file for each",
                name_, processor(row), processor(all_.env[0])));
        const auto id = renumber(row.env_id, all_.env);
        env_ids_.set(id, env_.add(row.env_hash, row).first);
    }
    for (Package row : part.packages) {
        row.env_id = env_ids_(row.env_id);
        packages_.add({row.env_id, row.library}, row);
    }
    scene_ids_ = Renumbering("scenes");
    for (SceneRow row : part.scenes) {
        const auto id = renumber(row.scene_id, all_.scenes);
        scene_ids_.set(id,
                       scenes_.add({row.name, row.n_items, row.seed, row.content_hash}, row).first);
    }
    for (const TaskRow& row : part.tasks)
        tasks_.add(row.task, row);
    variant_ids_ = Renumbering("variants");
    for (Variant row : part.variants) {
        const auto id = renumber(row.variant_id, all_.variants);
        variant_ids_.set(
            id,
            variants_.add({row.name, row.library, row.lib_version, row.params_json}, row).first);
    }
    cell_ids_ = Renumbering("cells");
    for (Cell row : part.cells) {
        const auto id = renumber(row.cell_id, all_.cells);
        row.scene_id = scene_ids_(row.scene_id);
        row.variant_id = variant_ids_(row.variant_id);
        const auto content = all_.scenes[row.scene_id].content_hash;
        if (const auto [known, is_new] = content_of_.emplace(row.name, content);
            known->second != content)
            throw std::runtime_error(
                fmt::format("cannot merge: cell '{}' stands for different scene contents ({:016x} "
                            "and {:016x}); give one of the scenes another name",
                            row.name, known->second, content));
        cell_ids_.set(id, cells_.add({row.name, row.scene_id, row.variant_id, row.isa}, row).first);
    }
}

template <class Row> void Merger::add_rounds(const std::vector<Row>& rows, std::vector<Row>& all) {
    for (Row row : rows) {
        const auto id = std::exchange(row.shard_id, shard_ids_(row.shard_id));
        row.cell_id = cell_ids_(row.cell_id);
        if (new_shards_.contains(id))
            all.push_back(row);
    }
}

void Merger::compare_known(const Results& part) const {
    Contents again, kept;
    for (const Shard& shard : part.shards)
        if (!new_shards_.contains(shard.shard_id))
            again[shard_ids_(shard.shard_id)];
    for (Sample sample : part.samples)
        if (!new_shards_.contains(sample.shard_id)) {
            sample.cell_id = cell_ids_(sample.cell_id);
            again[shard_ids_(sample.shard_id)].insert(content_of(sample));
        }
    for (const Sample& sample : all_.samples)
        if (again.contains(sample.shard_id))
            kept[sample.shard_id].insert(content_of(sample));
    for (const auto& [id, samples] : again)
        if (samples != kept[id])
            throw std::runtime_error(fmt::format(
                "cannot merge: {} and {} hold the same shard (round {}, process {}) with other "
                "samples; give the one that was not changed",
                names_of_shards_[id], name_, all_.shards[id].round, all_.shards[id].pid));
}

void Merger::add_samples(const Results& part) {
    shard_ids_ = Renumbering("shards");
    new_shards_.clear();
    for (Shard row : part.shards) {
        const auto id = renumber(row.shard_id, all_.shards);
        row.env_id = env_ids_(row.env_id);
        const auto [to, is_new] = shards_.add({row.env_id, row.round, row.t0_utc_ns, row.pid}, row);
        shard_ids_.set(id, to);
        if (!is_new)
            continue;
        new_shards_.insert(id);
        names_of_shards_.push_back(name_);
    }
    compare_known(part);
    add_rounds(part.samples, all_.samples);
    add_rounds(part.frames, all_.frames);
    add_rounds(part.effects, all_.effects);
}

void Merger::add_facts(const Results& part) {
    for (Counter row : part.counters) {
        row.cell_id = cell_ids_(row.cell_id);
        counters_.add({row.cell_id, row.counter}, row);
    }
    for (Check row : part.checks) {
        row.cell_id = cell_ids_(row.cell_id);
        Check& kept = all_.checks[checks_.add({row.cell_id, row.oracle}, row).first];
        if (row.status > kept.status)
            kept = row;
    }
    for (TreeRow row : part.trees) {
        row.cell_id = cell_ids_(row.cell_id);
        trees_.add(row.cell_id, row);
    }
    for (KernelRow row : part.kernels) {
        row.cell_id = cell_ids_(row.cell_id);
        KernelRow& kept = all_.kernels[kernels_.add({row.cell_id, row.family}, row).first];
        if (row.status > kept.status)
            kept = row;
    }
    for (ConditionRow row : part.conditions) {
        row.cell_id = cell_ids_(row.cell_id);
        conditions_.add({row.cell_id, row.log10_condition}, row);
    }
}

} // namespace

Results merge(std::span<const Results> parts, std::span<const std::string> names) {
    Merger merger;
    for (std::size_t i = 0; i < parts.size(); ++i)
        merger.add(parts[i], i < names.size() ? names[i] : fmt::format("part {}", i + 1));
    Results all = merger.take();
    all.is_sealed = std::ranges::all_of(parts, &Results::is_sealed);
    return all;
}

} // namespace boxwood::results

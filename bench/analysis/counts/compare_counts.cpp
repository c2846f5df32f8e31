#include "bench/analysis/counts/compare_counts.h"
#include "bench/analysis/index.h"
#include "bench/analysis/status.h"

#include <algorithm>
#include <map>
#include <utility>

namespace boxwood::bench {
namespace {

using results::Results;
using results::Status;
using Change = CountRow::Change;

struct Counted {
    const results::Cell* cell;
    std::uint64_t content;
    std::map<std::string, std::uint64_t> counts;
};
/// Equal names of a merged file in order.
using CountedByName = std::multimap<std::string, Counted>;

CountedByName counted_by_name(const Results& results, const CountOptions& options) {
    const Index index(results);
    std::map<std::uint32_t, std::map<std::string, std::uint64_t>> counts;
    for (const auto& row : results.counters)
        counts[row.cell_id][row.counter] = row.value;
    CountedByName counted;
    for (const auto& cell : results.cells)
        if (!index.is_peer(cell) && cell.status != Status::unsupported &&
            (!options.wanted || options.wanted(cell.name)))
            counted.emplace(cell.name, Counted{&cell, index.scene(cell.scene_id).content_hash,
                                               std::move(counts[cell.cell_id])});
    return counted;
}

bool is_of_instructions(const std::string& counter) { return counter.starts_with("instructions_"); }

std::string text_named(const Results& results, const std::string& name) {
    const auto found = results.texts.find(name);
    return found == results.texts.end() ? "" : found->second;
}

class Matching {
  public:
    Matching(CountComparison& out, const CountOptions& options) : out_(out), options_(options) {}

    void compare(const std::string& name, const Counted& a, const Counted& b) {
        if (a.content != b.content) {
            out_.lost.push_back({name, "another scene"});
            return;
        }
        if (is_right(a.cell->status) && b.cell->status == Status::wrong) {
            out_.newly_wrong.insert(name);
            return;
        }
        if (is_right(a.cell->status) && !is_right(b.cell->status))
            out_.lost.push_back({name, "its answer was not checked"});
        for (const auto& [counter, count] : a.counts)
            if (const auto found = b.counts.find(counter); found == b.counts.end())
                out_.lost.push_back({name, "no " + counter});
            else
                out_.rows.push_back(row_of(name, counter, count, found->second));
    }

  private:
    CountRow row_of(const std::string& cell, const std::string& counter, std::uint64_t base,
                    std::uint64_t head) const {
        const bool is_instructions = is_of_instructions(counter);
        const double limit = is_instructions || counter == "bytes" ? options_.more : 0;
        const auto of_base = static_cast<double>(base), of_head = static_cast<double>(head);
        CountRow row{cell, counter, base, head};
        row.change = of_head > of_base * (1 + limit)   ? Change::more
                     : of_head < of_base * (1 - limit) ? Change::fewer
                                                       : Change::same;
        row.is_expected = row.change != Change::same && options_.expected &&
                          options_.expected(cell + " " + counter);
        if (is_instructions && out_.base_by != out_.head_by)
            row.gate = Gate::open;
        else if (row.change == Change::more && !row.is_expected)
            row.gate = Gate::fails;
        return row;
    }

    CountComparison& out_;
    const CountOptions& options_;
};

} // namespace

double CountRow::ratio() const {
    return base == 0 ? unknown : static_cast<double>(head) / static_cast<double>(base);
}

CountComparison compare_counts(const Results& base, const Results& head,
                               const CountOptions& options) {
    CountComparison result;
    result.base_by = text_named(base, "instructions_by");
    result.head_by = text_named(head, "instructions_by");
    result.has_instructions = !result.base_by.empty();
    Matching matching(result, options);
    CountedByName in_head = counted_by_name(head, options);
    for (const auto& [name, a] : counted_by_name(base, options)) {
        const auto match = in_head.find(name);
        if (match == in_head.end()) {
            result.lost.push_back({name, "no such cell"});
            continue;
        }
        matching.compare(name, a, match->second);
        in_head.erase(match);
    }
    for (const auto& [name, counted] : in_head)
        result.only_head.push_back(name);
    result.is_sealed = base.is_sealed && head.is_sealed;
    result.gate =
        result.lost.empty() && !result.rows.empty() && result.is_sealed && result.has_instructions
            ? Gate::passes
            : Gate::open;
    for (const CountRow& row : result.rows)
        result.gate = std::max(result.gate, row.gate);
    if (!result.newly_wrong.empty())
        result.gate = Gate::fails;
    return result;
}

} // namespace boxwood::bench

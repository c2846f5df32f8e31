#include "bench/analysis/ladders.h"

#include "bench/analysis/compare.h"
#include "bench/io/text_table.h"
#include "bench/tasks/contender.h"
#include "bench/truth/judging/case_truths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace boxwood::bench {
namespace {

using results::KernelRow;

constexpr std::array panels{"generic", "touching", "degenerate"};

/// Whether false_pos and false_neg are of distances.
bool is_measured(std::string_view task) {
    return task == "triangle_distance" || task == "segment_segment" || task == "point_triangle" ||
           task == "point_segment";
}

/// A row and the time of a call.
struct Row {
    const KernelRow* kernel;
    double ns;
};

/// One rung on all families that were judged.
struct Rung {
    std::string name, promise;
    bool is_peer = false;
    std::vector<Row> rows;

    std::uint64_t sum(std::uint64_t KernelRow::*column) const {
        std::uint64_t all = 0;
        for (const Row& row : rows)
            all += row.kernel->*column;
        return all;
    }
    double worst(double KernelRow::*column) const {
        double most = results::missing;
        for (const Row& row : rows)
            most = std::fmax(most, row.kernel->*column);
        return most;
    }
    /// Mean over the families of a panel; NaN if there are none.
    double ns(std::string_view panel) const {
        double all = 0;
        int n = 0;
        for (const Row& row : rows)
            if (row.kernel->panel == panel && row.kernel->n > 0) {
                all += row.ns;
                ++n;
            }
        return n > 0 ? all / n : results::missing;
    }
    /// Whether no judged row of a panel has such errors, and there is one.
    template <class Errors> bool has_none(std::string_view panel, const Errors& errors) const {
        return !std::isnan(ns(panel)) && std::ranges::all_of(rows, [&](const Row& row) {
            return row.kernel->panel != panel || errors(*row.kernel) == 0;
        });
    }
    bool is_right(std::string_view panel) const {
        return has_none(panel, [](const KernelRow& row) {
            return row.false_pos + row.false_neg + row.bound_violations + row.maybe;
        });
    }
    bool misses_nothing(std::string_view panel) const {
        return has_none(panel, [](const KernelRow& row) {
            return row.false_neg + row.bound_violations +
                   (row.promise == to_string(Promise::never_miss) ? 0 : row.maybe);
        });
    }
    std::string escalated() const {
        const std::uint64_t n = sum(&KernelRow::n);
        const std::uint64_t tier_0 = sum(&KernelRow::tier_0);
        return is_peer || n == tier_0
                   ? "-"
                   : fmt::format("{:.3g} %",
                                 100 * (1 - static_cast<double>(tier_0) / static_cast<double>(n)));
    }
    std::string status() const {
        const auto has = [&](std::string_view status) {
            return std::ranges::any_of(
                rows, [&](const Row& row) { return row.kernel->status == status; });
        };
        if (std::ranges::any_of(rows, [](const Row& row) { return breaks_promise(*row.kernel); }))
            return "BROKEN";
        if (has("wrong"))
            return "wrong";
        for (const char* status : {"within_bound", "conservative", "exact"})
            if (has(status))
                return promise == to_string(Promise::none) ? status : "kept";
        return "unsupported";
    }
};

std::string number(double x) { return std::isnan(x) ? "-" : fmt::format("{:.3g}", x); }

/// The rows of one kernel family, by rung: ours first, in the order they came.
class Ladder {
  public:
    explicit Ladder(std::string name) : name_(std::move(name)) {}

    void add(const KernelRow& row, double ns, const std::string& label, bool is_peer) {
        const auto found = std::ranges::find(rungs_, label, &Rung::name);
        Rung& rung = found != rungs_.end()
                         ? *found
                         : rungs_.emplace_back(Rung{label, row.promise, is_peer, {}});
        rung.rows.push_back({&row, ns});
        families_.insert(row.family);
    }

    std::string text() {
        std::ranges::stable_partition(rungs_, [](const Rung& rung) { return !rung.is_peer; });
        return fmt::format("{}: {} famil{}\n{}{}{}\n", name_, families_.size(),
                           families_.size() == 1 ? "y" : "ies", table(), errors(), sentences());
    }

  private:
    std::string table() const {
        const bool measured = is_measured(name_);
        TextTable table({"  kernel", "promise", ">calls", measured ? ">too small" : ">false yes",
                         measured ? ">too large" : ">false no", ">maybe", ">violations",
                         ">worst ulp", ">worst rel", ">escalated", ">generic", ">touching",
                         ">degenerate", "verdict"});
        for (const Rung& rung : rungs_) {
            std::vector<std::string> row{"  " + rung.name,
                                         rung.is_peer ? "peer" : rung.promise,
                                         std::to_string(rung.sum(&KernelRow::n)),
                                         std::to_string(rung.sum(&KernelRow::false_pos)),
                                         std::to_string(rung.sum(&KernelRow::false_neg)),
                                         std::to_string(rung.sum(&KernelRow::maybe)),
                                         std::to_string(rung.sum(&KernelRow::bound_violations)),
                                         number(rung.worst(&KernelRow::max_ulp)),
                                         number(rung.worst(&KernelRow::max_rel_err)),
                                         rung.escalated()};
            for (const char* panel : panels)
                row.push_back(time_text(rung.ns(panel)));
            row.push_back(rung.status());
            table.add(std::move(row));
        }
        return table.text();
    }

    /// "  moller_f64 errs on coplanar_touching 120/300, needles 3/300, and 4 more"
    std::string errors() const {
        constexpr std::size_t most = 4;
        std::string text;
        for (const Rung& rung : rungs_) {
            std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> wrong_of; // of n
            for (const auto& [row, ns] : rung.rows) {
                auto& [wrong, n] = wrong_of[row->family];
                wrong += row->false_pos + row->false_neg + row->bound_violations;
                n += row->n;
            }
            std::vector<std::pair<double, std::string>> worst;
            for (const auto& [family, counts] : wrong_of)
                if (counts.first > 0)
                    worst.emplace_back(
                        -static_cast<double>(counts.first) / static_cast<double>(counts.second),
                        fmt::format("{} {}/{}", family, counts.first, counts.second));
            if (worst.empty())
                continue;
            std::ranges::sort(worst);
            std::string line;
            for (std::size_t i = 0; i < std::min(most, worst.size()); ++i)
                line += (i > 0 ? ", " : "") + worst[i].second;
            if (worst.size() > most)
                line += fmt::format(", and {} more", worst.size() - most);
            text += fmt::format("  {} errs on {}\n", rung.name, line);
        }
        return text;
    }

    /// The cheapest of ours that `suits`; nullptr if none does.
    template <class Suits> const Rung* cheapest(std::string_view panel, const Suits& suits) const {
        const Rung* best = nullptr;
        for (const Rung& rung : rungs_)
            if (!rung.is_peer && !std::isnan(rung.ns(panel)) && suits(rung) &&
                (!best || rung.ns(panel) < best->ns(panel)))
                best = &rung;
        return best;
    }

    std::string sentences() const {
        std::string text;
        for (const std::string_view panel : panels) {
            const Rung* fastest = cheapest(panel, [](const Rung&) { return true; });
            if (!fastest)
                continue;
            const auto named = [&](const Rung& rung) {
                return &rung == fastest
                           ? rung.name + ", the fastest"
                           : fmt::format("{}, at {} times the fastest ({})", rung.name,
                                         ratio_text(rung.ns(panel) / fastest->ns(panel)),
                                         fastest->name);
            };
            const Rung* right = cheapest(panel, [&](const Rung& r) { return r.is_right(panel); });
            const Rung* safe =
                cheapest(panel, [&](const Rung& r) { return r.misses_nothing(panel); });
            text += fmt::format("  {} input: ", panel);
            if (right)
                text += fmt::format("cheapest rung with no wrong answer on these cases: {}\n",
                                    named(*right));
            else
                text += fmt::format("no rung without a wrong answer{}\n",
                                    safe ? "; cheapest that misses nothing: " + named(*safe) : "");
        }
        return text;
    }

    std::string name_;
    std::vector<Rung> rungs_;
    std::set<std::string> families_;
};

} // namespace

std::string ladders_text(const results::Results& results) {
    std::map<std::uint32_t, const results::Cell*> cells;
    for (const results::Cell& cell : results.cells)
        cells[cell.cell_id] = &cell;
    std::map<std::uint32_t, const results::Variant*> variants;
    for (const results::Variant& variant : results.variants)
        variants[variant.variant_id] = &variant;
    std::map<std::uint32_t, double> median_of;
    for (const CellStats& stats : cell_stats(results))
        if (stats.phase == "query")
            median_of[stats.cell_id] = stats.median_ns;

    std::vector<std::string> order;
    std::map<std::string, Ladder> ladders;
    for (const KernelRow& row : results.kernels) {
        const results::Cell& cell = *cells.at(row.cell_id);
        const bool is_peer = variants.at(cell.variant_id)->is_peer != 0;
        const std::string label =
            is_peer && cell.precision != "f64" ? row.kernel + " " + cell.precision : row.kernel;
        const auto sweep = median_of.find(row.cell_id);
        const double ns = sweep != median_of.end() && row.n > 0
                              ? sweep->second / static_cast<double>(row.n)
                              : row.ns_per_call;
        if (!ladders.contains(row.task))
            order.push_back(row.task);
        ladders.try_emplace(row.task, row.task).first->second.add(row, ns, label, is_peer);
    }
    std::string text;
    for (const std::string& name : order)
        text += ladders.at(name).text();
    if (!text.empty())
        text += "Times are per call, means over the families of a panel. A kernel of floats is "
                "judged on the cases\nrounded to float. Worst ulp: of the answer's own type.\n";
    return text;
}

std::string promises_text(const results::Results& results) {
    constexpr std::size_t most_shown = 10;
    std::string text;
    std::size_t broken = 0;
    for (const KernelRow& row : results.kernels)
        if (breaks_promise(row) && ++broken <= most_shown)
            text += fmt::format("BROKEN PROMISE: {} promises {} on {}/{}\n  {}\n", row.kernel,
                                row.promise, row.family, row.task, row.witness);
    if (broken > most_shown)
        text += fmt::format("and {} more\n", broken - most_shown);
    return broken == 0
               ? "Every promise is kept.\n"
               : text + fmt::format("{} broken promise{}.\n", broken, broken == 1 ? "" : "s");
}

std::size_t broken_promises(const results::Results& results) {
    return static_cast<std::size_t>(std::ranges::count_if(results.kernels, breaks_promise));
}

} // namespace boxwood::bench

#include "bench/check.h"
#include "bench/judging/judge.h"
#include "bench/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace boxwood::bench {
namespace {

using results::KernelRow;

constexpr std::array panels{"generic", "touching", "degenerate"};

bool is_measured(std::string_view kernel_family) {
    return kernel_family == "triangle_distance" || kernel_family == "segment_segment" ||
           kernel_family == "point_triangle" || kernel_family == "point_segment";
}

/// One rung on all families that were judged.
struct Rung {
    std::string name, promise;
    bool is_peer = false;
    std::vector<const KernelRow*> rows;

    std::uint64_t sum(std::uint64_t KernelRow::*column) const {
        std::uint64_t all = 0;
        for (const KernelRow* row : rows)
            all += row->*column;
        return all;
    }
    double worst(double KernelRow::*column) const {
        double most = results::missing;
        for (const KernelRow* row : rows)
            most = std::fmax(most, row->*column);
        return most;
    }
    /// Mean over the families of a panel; NaN if there are none.
    double ns(std::string_view panel) const {
        double all = 0;
        int n = 0;
        for (const KernelRow* row : rows)
            if (row->panel == panel && row->n > 0) {
                all += row->ns_per_call;
                ++n;
            }
        return n > 0 ? all / n : results::missing;
    }
    bool is_right(std::string_view panel) const {
        return std::ranges::all_of(rows, [&](const KernelRow* row) {
            return row->panel != panel ||
                   (row->n > 0 && row->false_pos + row->false_neg + row->bound_violations == 0 &&
                    row->maybe == 0 && row->status != "wrong");
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
            return std::ranges::any_of(rows,
                                       [&](const KernelRow* row) { return row->status == status; });
        };
        if (std::ranges::any_of(rows, [](const KernelRow* row) { return breaks_promise(*row); }))
            return "BROKEN";
        for (const char* status : {"wrong", "within_bound", "conservative", "exact"})
            if (has(status))
                return promise != "no promise" && *status != 'w' ? fmt::format("kept") : status;
        return "unsupported";
    }
};

std::string number(double x) { return std::isnan(x) ? "-" : fmt::format("{:.3g}", x); }
std::string count(std::uint64_t n) { return n == 0 ? "0" : std::to_string(n); }

/// The rows of one kernel family, by rung: ours first, in the order they came.
class Ladder {
  public:
    explicit Ladder(std::string name) : name_(std::move(name)) {}

    void add(const KernelRow& row, const std::string& label, bool is_peer) {
        const auto found = std::ranges::find(rungs_, label, &Rung::name);
        Rung& rung = found != rungs_.end()
                         ? *found
                         : rungs_.emplace_back(Rung{label, row.promise, is_peer, {}});
        rung.rows.push_back(&row);
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
                                         count(rung.sum(&KernelRow::n)),
                                         count(rung.sum(&KernelRow::false_pos)),
                                         count(rung.sum(&KernelRow::false_neg)),
                                         count(rung.sum(&KernelRow::maybe)),
                                         count(rung.sum(&KernelRow::bound_violations)),
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
            for (const KernelRow* row : rung.rows) {
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

    std::string sentences() const {
        std::string text;
        for (const char* panel : panels) {
            const Rung *fastest = nullptr, *right = nullptr;
            for (const Rung& rung : rungs_) {
                if (rung.is_peer || std::isnan(rung.ns(panel)))
                    continue;
                if (!fastest || rung.ns(panel) < fastest->ns(panel))
                    fastest = &rung;
                if (rung.is_right(panel) && (!right || rung.ns(panel) < right->ns(panel)))
                    right = &rung;
            }
            if (fastest)
                text += right ? fmt::format("  {} input: cheapest rung with no wrong answer on "
                                            "these cases: {}, at {} times the fastest{}\n",
                                            panel, right->name,
                                            ratio_text(right->ns(panel) / fastest->ns(panel)),
                                            right == fastest ? "" : " (" + fastest->name + ")")
                              : fmt::format("  {} input: no rung without a wrong answer\n", panel);
        }
        return text;
    }

    std::string name_;
    std::vector<Rung> rungs_;
    std::set<std::string> families_;
};

} // namespace

std::string check_text(const results::Results& results) {
    std::map<std::uint32_t, const results::Cell*> cells;
    for (const results::Cell& cell : results.cells)
        cells[cell.cell_id] = &cell;
    std::map<std::uint32_t, const results::Variant*> variants;
    for (const results::Variant& variant : results.variants)
        variants[variant.variant_id] = &variant;

    std::vector<std::string> order;
    std::map<std::string, Ladder> ladders;
    for (const KernelRow& row : results.kernels) {
        const results::Cell& cell = *cells.at(row.cell_id);
        const bool is_peer = variants.at(cell.variant_id)->is_peer != 0;
        const std::string label =
            is_peer && cell.precision != "f64" ? row.rung + " " + cell.precision : row.rung;
        if (!ladders.contains(row.kernel_family))
            order.push_back(row.kernel_family);
        ladders.try_emplace(row.kernel_family, row.kernel_family)
            .first->second.add(row, label, is_peer);
    }
    std::string text;
    for (const std::string& name : order)
        text += ladders.at(name).text();
    text += "Times are means over the families of a panel, per call, of this run's own short "
            "timing (a sweep is better).\nA kernel of floats is judged on the cases rounded to "
            "float. Worst ulp: of the answer's own type.\n";

    constexpr std::size_t most_shown = 10;
    std::size_t broken = 0;
    for (const KernelRow& row : results.kernels)
        if (breaks_promise(row) && ++broken <= most_shown)
            text += fmt::format("\nBROKEN PROMISE: {} promises {} on {}/{}\n  {}\n", row.rung,
                                row.promise, row.family, row.kernel_family, row.witness);
    if (broken > most_shown)
        text += fmt::format("\nand {} broken promises more\n", broken - most_shown);
    text += broken == 0 ? "\nEvery promise is kept.\n"
                        : fmt::format("\n{} broken promise{}.\n", broken, broken == 1 ? "" : "s");
    return text;
}

} // namespace boxwood::bench

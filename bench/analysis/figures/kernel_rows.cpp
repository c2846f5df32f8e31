#include "bench/analysis/figures/kernel_rows.h"

#include "bench/analysis/index.h"
#include "bench/analysis/times.h"

#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Escalation;
using results::KernelCondition;
using results::KernelRow;
using results::Results;

using Tiers = std::array<std::uint64_t, 4>;

Tiers tiers_of(const KernelRow& row) { return {row.tier_0, row.tier_1, row.tier_2, row.tier_3}; }

Escalation shares_of(const KernelRow& row, std::uint32_t cell_id, const Tiers& calls) {
    const auto all = static_cast<double>(std::accumulate(calls.begin(), calls.end(), 0ull));
    const auto share = [&](std::size_t tier) { return static_cast<double>(calls[tier]) / all; };
    return {cell_id, row.task, row.label, share(0), share(1), share(2), share(3)};
}

} // namespace

bool is_judged(const KernelRow& row) {
    return row.family != whole_queries && row.n > 0 && row.status != results::Status::unsupported;
}

void set_kernel_rows(Results& results) {
    const Index index(results);
    const MedianIndex medians(results);
    for (KernelRow& row : results.kernels) {
        const std::string& precision = index.cell(row.cell_id).precision;
        row.label = row.kernel;
        if (index.is_peer(index.cell(row.cell_id)) && precision != "f64" &&
            row.kernel.find(precision) == std::string::npos)
            row.label += " " + precision;
        const auto n = static_cast<double>(row.n);
        const double swept = medians.ns(row.cell_id, results::Phase::query);
        row.ns = std::isnan(swept) || row.n == 0 ? row.ns_per_call : swept / n;
        row.wrong = row.false_pos + row.false_neg + row.bound_violations;
        row.wrong_per_million = 1e6 * static_cast<double>(row.wrong) / n;
        row.maybe_per_million = 1e6 * static_cast<double>(row.maybe) / n;
    }
}

std::vector<KernelCondition> kernel_conditions_of(const Results& results) {
    const Index index(results);
    std::map<std::uint32_t, std::vector<const results::ConditionRow*>> of_cell;
    for (const results::ConditionRow& row : results.conditions)
        of_cell[row.cell_id].push_back(&row);
    using Key = std::tuple<std::string, bool, std::string, std::string, std::string, double>;
    std::map<Key, KernelCondition> found;
    for (const KernelRow& kernel : results.kernels) {
        if (!is_judged(kernel))
            continue;
        const bool is_peer = index.is_peer(index.cell(kernel.cell_id));
        const std::string& library = index.variant(index.cell(kernel.cell_id)).library;
        for (const results::ConditionRow* row : of_cell[kernel.cell_id]) {
            KernelCondition& worst =
                found
                    .try_emplace({kernel.task, is_peer, library, kernel.label, kernel.promise,
                                  row->log10_condition},
                                 KernelCondition{kernel.task, kernel.label, library, kernel.promise,
                                                 is_peer, row->log10_condition})
                    .first->second;
            worst.n += row->n;
            worst.max_rel_err = std::fmax(worst.max_rel_err, row->max_rel_err);
            worst.bound = std::fmax(worst.bound, row->bound);
        }
    }
    std::vector<KernelCondition> all;
    for (auto& [key, row] : found)
        all.push_back(std::move(row));
    return all;
}

std::vector<Escalation> escalations_of(const Results& results) {
    const Index index(results);
    std::map<std::pair<std::string, std::string>, std::vector<const KernelRow*>> kernels;
    std::set<std::pair<std::string, std::string>> adaptive;
    for (const KernelRow& row : results.kernels) {
        if (!is_judged(row) || index.is_peer(index.cell(row.cell_id)))
            continue;
        kernels[{row.task, row.label}].push_back(&row);
        if (row.tier_0 > 0 && row.tier_1 + row.tier_2 + row.tier_3 > 0)
            adaptive.insert({row.task, row.label});
    }
    std::vector<Escalation> all;
    for (const auto& kernel : adaptive) {
        Tiers together{};
        for (const KernelRow* row : kernels[kernel]) {
            const Tiers calls = tiers_of(*row);
            for (std::size_t tier = 0; tier < calls.size(); ++tier)
                together[tier] += calls[tier];
            if (calls != Tiers{})
                all.push_back(shares_of(*row, row->cell_id, calls));
        }
        all.push_back(shares_of(*kernels[kernel].front(), results::no_id, together));
    }
    return all;
}

} // namespace boxwood::bench

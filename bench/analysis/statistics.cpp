#include "bench/analysis/statistics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace boxwood::bench {
namespace {

/// The probability of k heads in n throws; through logarithms, as n may be thousands.
double binomial(std::size_t k, std::size_t n) {
    const auto log_factorial = [](std::size_t i) {
        return std::lgamma(static_cast<double>(i) + 1);
    };
    return std::exp(log_factorial(n) - log_factorial(k) - log_factorial(n - k) -
                    static_cast<double>(n) * std::log(2.0));
}

} // namespace

double median_of_sorted(std::span<const double> sorted) {
    const std::size_t n = sorted.size();
    return n % 2 == 1 ? sorted[n / 2] : std::midpoint(sorted[n / 2 - 1], sorted[n / 2]);
}

double percentile_of_sorted(std::span<const double> sorted, double q) {
    const double place = q * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], place - std::floor(place));
}

std::optional<Ranks> median_ranks(std::size_t n, double error) {
    // The interval from rank k misses the median if fewer than k values lie below it, or above it.
    std::size_t k = 0;
    for (double misses = 0; k < n / 2; ++k) {
        misses += 2 * binomial(k, n);
        if (misses > error)
            break;
    }
    if (k == 0)
        return std::nullopt;
    return Ranks{k, n + 1 - k};
}

double sign_test(std::span<const double> log_ratios) {
    const auto below = std::ranges::count_if(log_ratios, [](double x) { return x < 0; });
    const auto above = std::ranges::count_if(log_ratios, [](double x) { return x > 0; });
    double p = 0;
    for (std::ptrdiff_t k = 0; k <= std::min(below, above); ++k)
        p += 2 * binomial(static_cast<std::size_t>(k), static_cast<std::size_t>(below + above));
    return std::min(1.0, p);
}

Corrected corrected(std::span<const double> p) {
    const std::size_t n = p.size();
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p[i]; });
    Corrected result{std::vector<double>(n)};
    double running = 1;
    std::size_t claimed = 0;
    for (std::size_t place = n; place > 0; --place) {
        const double ahead = static_cast<double>(place) / static_cast<double>(n);
        running = std::min(running, p[order[place - 1]] / ahead);
        result.p_adj[order[place - 1]] = running;
        if (running <= family_error)
            claimed = std::max(claimed, place);
    }
    result.level = family_error * static_cast<double>(std::max<std::size_t>(claimed, 1)) /
                   static_cast<double>(std::max<std::size_t>(n, 1));
    return result;
}

std::size_t rounds_needed(std::size_t family_size) {
    std::size_t n = min_pairs_verdict;
    while (static_cast<double>(family_size) * std::ldexp(1.0, 1 - static_cast<int>(n)) >
           family_error)
        ++n;
    return n;
}

MedianInterval median_interval(std::vector<double> values, double error) {
    if (values.empty())
        return {};
    std::ranges::sort(values);
    MedianInterval result{values.size(), median_of_sorted(values)};
    if (const auto ranks = median_ranks(values.size(), error)) {
        result.lo = values[ranks->lo - 1];
        result.hi = values[ranks->hi - 1];
    }
    return result;
}

Line fitted_line(std::span<const double> x, std::span<const double> y) {
    const auto n = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
    const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return {xy / xx, mean_y - xy / xx * mean_x};
}

PairedRatio paired_ratio(std::span<const double> log_ratios, double error) {
    const MedianInterval logs = median_interval({log_ratios.begin(), log_ratios.end()}, error);
    return {logs.n, std::exp(logs.mid), std::exp(logs.lo), std::exp(logs.hi)};
}

InputMedians input_medians(std::span<const double> log_ratios,
                           std::span<const std::uint32_t> inputs) {
    std::map<std::uint32_t, std::vector<double>> of_input;
    for (std::size_t i = 0; i < log_ratios.size(); ++i)
        of_input[inputs[i]].push_back(log_ratios[i]);
    std::erase_if(of_input, [](const auto& input) { return input.second.size() < 3; });
    InputMedians medians;
    if (of_input.size() < 2)
        return medians;
    for (auto& [input, logs] : of_input) {
        const double mid = median_interval(std::move(logs)).mid;
        medians.lo = std::fmin(medians.lo, mid); // the known one of the two
        medians.hi = std::fmax(medians.hi, mid);
    }
    return medians;
}

namespace {

/// With every input's median inside.
PairedRatio ratio_of(const Claim& claim, double error) {
    PairedRatio ratio = paired_ratio(claim.log_ratios, error);
    if (!std::isnan(ratio.ci_lo)) {
        ratio.ci_lo = std::fmin(ratio.ci_lo, std::exp(claim.by_input.lo));
        ratio.ci_hi = std::fmax(ratio.ci_hi, std::exp(claim.by_input.hi));
    }
    return ratio;
}

bool is_within(double value, double band) { return 1 / (1 + band) <= value && value <= 1 + band; }

Ruling decide_one(const Claim& asked, double p_adj, double level, double delta) {
    using results::Reason, results::Verdict;
    const std::size_t n = asked.log_ratios.size();
    const double floor = asked.floor;
    Ruling claim{ratio_of(asked, family_error), p_adj};
    const auto open = [&](Reason reason) {
        claim.reason = reason;
        return claim;
    };
    const Reason within_the_floor =
        floor > noisy_floor ? Reason::too_noisy : Reason::below_the_floor;
    if (n < min_pairs_verdict)
        return open(Reason::too_few_rounds);
    if (is_within(claim.ratio.ci_lo, delta) && is_within(claim.ratio.ci_hi, delta)) {
        if (floor > delta)
            return open(within_the_floor);
        claim.verdict = Verdict::same;
        return claim;
    }
    claim.ratio = ratio_of(asked, level);
    if (!median_ranks(n, level))
        return open(Reason::too_few_rounds);
    if (claim.ratio.ci_lo <= 1 && claim.ratio.ci_hi >= 1)
        return open(Reason::crosses_1);
    const double near_end = claim.ratio.ratio < 1 ? claim.ratio.ci_hi : claim.ratio.ci_lo;
    if (is_within(floor > delta ? near_end : claim.ratio.ratio, floor))
        return open(within_the_floor);
    claim.verdict = claim.ratio.ci_hi < 1 ? Verdict::faster : Verdict::slower;
    return claim;
}

} // namespace

std::vector<Ruling> decide(std::span<const Claim> family, double delta) {
    std::vector<double> p;
    for (const Claim& claim : family)
        p.push_back(sign_test(claim.log_ratios));
    const Corrected together = corrected(p);
    std::vector<Ruling> rulings;
    for (std::size_t i = 0; i < family.size(); ++i)
        rulings.push_back(decide_one(family[i], together.p_adj[i], together.level, delta));
    return rulings;
}

} // namespace boxwood::bench

#include "bench/truth/judging/tally.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

Status status_of(Worth worst) {
    switch (worst) {
    case Worth::exact:
        return Status::exact;
    case Worth::conservative:
        return Status::conservative;
    case Worth::within_bound:
        return Status::within_bound;
    case Worth::wrong:
    case Worth::broken_promise:
        break;
    }
    return Status::wrong;
}

/// The greater one; a missing one is less than any.
double larger(double a, double b) { return std::isnan(a) ? b : std::isnan(b) ? a : std::max(a, b); }

} // namespace

Worth worth_of(Promise promise, Answer said, bool truth) {
    if (said == Answer::maybe)
        return promise == Promise::exact ? Worth::broken_promise : Worth::conservative;
    if ((said == Answer::yes) == truth)
        return Worth::exact;
    switch (promise) {
    case Promise::none:
    case Promise::never_leaks: // of closed meshes: Tally::leaked
        return Worth::wrong;
    case Promise::never_miss:
        return truth ? Worth::broken_promise : Worth::conservative;
    case Promise::never_false:
        return truth ? Worth::conservative : Worth::broken_promise;
    case Promise::certified:
    case Promise::exact:
        break;
    }
    return Worth::broken_promise;
}

Tally::Tally(const CaseScene& scene, const ContenderEntry& contender)
    : promise_(contender.promise), yes_is_proven_(contender.yes_is_proven),
      panel_(panel_of(scene.scene)), n_cases_(n_cases(scene.scene.cases)),
      is_by_construction_(std::holds_alternative<std::vector<ShapePairCase>>(scene.scene.cases)) {
    const HardCaseFamily* family = find_hard_case_family(scene.scene.spec.generator);
    row_.family = family ? std::string(family->name) : "typical";
    row_.panel = to_string(panel_);
    row_.task = scene.task;
    row_.kernel = contender.name;
    row_.promise = to_string(promise_);
}

void Tally::called(std::uint8_t tier) {
    ++row_.n;
    ++(tier == 0 ? row_.tier_0 : tier == 1 ? row_.tier_1 : tier == 2 ? row_.tier_2 : row_.tier_3);
}

void Tally::answered(std::size_t i, Answer said, bool truth) {
    row_.maybe += said == Answer::maybe;
    const bool yes =
        said == Answer::yes || (said == Answer::maybe && promise_ == Promise::never_miss);
    const bool no =
        said == Answer::no || (said == Answer::maybe && promise_ == Promise::never_false);
    row_.false_pos += yes && !truth;
    row_.false_neg += no && truth;
    is_yes_no_ = true;
    true_yes_ += truth;
    said_yes_ += yes;
    const bool is_false_proof = yes_is_proven_ && said == Answer::yes && !truth;
    const Worth worth = is_false_proof ? Worth::broken_promise : worth_of(promise_, said, truth);
    note(i, worth);
    if (worth == Worth::conservative)
        vague(i);
}

void Tally::vague(std::size_t i) {
    if (n_vague_++ == 0)
        first_vague_ = i;
}

bool Tally::is_useless() const {
    return promise_ != Promise::none && panel_ == Panel::generic && n_vague_ > 1 + row_.n / 100;
}

void Tally::leaked(std::size_t i) {
    violated();
    is_yes_no_ = true;
    ++true_yes_;
    note(i, Worth::broken_promise);
}

void Tally::error(double ulp, double relative) {
    row_.max_ulp = larger(row_.max_ulp, ulp);
    row_.max_rel_err = larger(row_.max_rel_err, relative);
}

void Tally::note(std::size_t i, Worth worth) {
    if (worth <= worst_)
        return;
    worst_ = worth;
    worst_case_ = i;
}

Judgement Tally::rows(std::string witness) const {
    constexpr std::size_t column_width = 1024; // of the schema
    witness.resize(std::min(witness.size(), column_width));

    if (row_.n == 0)
        witness = "no case has only finite numbers in this precision";
    Judgement all;
    all.status = row_.n > 0 ? status_of(worst_) : Status::unsupported;
    all.calls = n_cases_;
    results::KernelRow& kernel = all.kernel.emplace(row_);
    kernel.witness = witness;
    kernel.escalation_rate =
        row_.n > 0 ? 1 - static_cast<double>(row_.tier_0) / static_cast<double>(row_.n)
                   : results::missing;
    results::Check& check = all.check;
    check.oracle = is_by_construction_ ? "construction" : "rational";
    check.n_checked = row_.n;
    check.n_expected = is_yes_no_ ? true_yes_ : row_.n;
    check.n_got = is_yes_no_ ? said_yes_ : row_.n;
    check.missing = row_.false_neg;
    check.extra = row_.false_pos;
    check.max_ulp = row_.max_ulp;
    check.max_rel_err = row_.max_rel_err;
    check.bound_violations = row_.bound_violations;
    check.witness = std::move(witness);
    return all;
}

} // namespace boxwood::bench

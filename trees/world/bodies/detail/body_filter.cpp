#include "trees/world/bodies/detail/body_filter.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood::detail {

void BodyFilter::add(std::uint32_t body, const Groups& groups) {
    if (body >= groups_.size()) {
        groups_.resize(std::size_t{body} + 1, Groups{0, 0});
        item_of_.resize(std::size_t{body} + 1, none);
    }
    groups_[body] = groups;
    grouped_ += !(groups == Groups{});
}

void BodyFilter::remove(std::uint32_t body) {
    grouped_ -= !(groups_[body] == Groups{});
    groups_[body] = {0, 0};
    const std::uint32_t item = std::exchange(item_of_[body], none);
    if (item == none)
        return;
    for (std::uint32_t other = 0; other < allowed_.items(); ++other)
        if (other != item && allowed_.allows(item, other))
            allowed_.disallow(item, other);
    body_of_[item] = none;
    free_.push_back(item);
}

void BodyFilter::set_groups(std::uint32_t body, const Groups& groups) {
    grouped_ -= !(groups_[body] == Groups{});
    grouped_ += !(groups == Groups{});
    groups_[body] = groups;
}

std::uint32_t BodyFilter::item(std::uint32_t body) {
    std::uint32_t& item = item_of_[body];
    if (item != none)
        return item;
    if (free_.empty()) {
        item = allowed_.add_item();
        body_of_.push_back(body);
    } else {
        item = free_.back();
        free_.pop_back();
        body_of_[item] = body;
    }
    return item;
}

void BodyFilter::allow(std::uint32_t a, std::uint32_t b, AllowedReason reason, std::string note) {
    if (a == b)
        throw std::invalid_argument("allowed pairs: body " + std::to_string(a) +
                                    " never meets itself; give two different bodies");
    const std::uint32_t item_a = item(a), item_b = item(b);
    allowed_.allow(item_a, item_b, reason, std::move(note));
}

void BodyFilter::disallow(std::uint32_t a, std::uint32_t b) {
    if (a != b && item_of_[a] != none && item_of_[b] != none)
        allowed_.disallow(item_of_[a], item_of_[b]);
}

std::optional<AllowedReason> BodyFilter::reason(std::uint32_t a, std::uint32_t b) const {
    if (a == b || item_of_[a] == none || item_of_[b] == none)
        return std::nullopt;
    return allowed_.reason(item_of_[a], item_of_[b]);
}

std::vector<AllowedPair> BodyFilter::pairs() const {
    std::vector<AllowedPair> all = allowed_.pairs();
    for (AllowedPair& pair : all) {
        pair.a = body_of_[pair.a];
        pair.b = body_of_[pair.b];
        if (pair.b < pair.a)
            std::swap(pair.a, pair.b);
    }
    std::ranges::sort(all, {}, [](const AllowedPair& p) { return std::pair(p.a, p.b); });
    return all;
}

} // namespace boxwood::detail

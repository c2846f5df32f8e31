#include "trees/dynamic/detail/expiring_pairs.h"

namespace boxwood::detail {
namespace {

/// With room for n, what it held lost.
template <class T> void make_room(Buffer<T>& buffer, std::size_t n) {
    if (buffer.size() < n)
        buffer = Buffer<T>(n + n / 8);
}

} // namespace

void ExpiringPairs::start(std::span<const std::vector<Pair>> parts, const Box* boxes, Reach reach) {
    reach_ = reach;
    bucket_now_ = 0;
    std::size_t n = 0;
    for (const auto& part : parts)
        n += part.size();
    make_room(sure_, n);
    make_room(place_, n);
    make_room(on_, n);
    make_room(on_id_, n);
    Buffer<Unsure> unsures(n);
    Buffer<std::uint8_t> bucket(n);
    static_assert(n_buckets < 256);
    std::array<std::uint32_t, n_buckets + 1> counts{};

    // Without branches: a pair is written wherever it might belong.
    std::size_t n_sure = 0, n_unsure = 0, n_on = 0;
    for (const auto& part : parts) {
        codes_.resize(part.size());
        gap_codes(part.data(), 2, part.size(), boxes, GapScale::from(0, reach.per_used),
                  codes_.data());
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Pair pair = part[i];
            const std::uint32_t overlap = codes_[i] >> 31, at = codes_[i] & 255u,
                                unsure = at < n_buckets;
            const auto id = static_cast<std::uint32_t>(n_unsure);
            sure_[n_sure] = pair;
            n_sure += overlap & (unsure ^ 1);
            unsures[id] = {pair, id | overlap << 31};
            place_[id] = static_cast<std::uint32_t>(n_on) | (overlap - 1); // or off
            bucket[id] = static_cast<std::uint8_t>(at);
            on_[n_on] = pair;
            on_id_[n_on] = id;
            n_on += overlap & unsure;
            n_unsure += unsure;
            ++counts[at];
        }
    }
    n_sure_ = n_sure;
    n_unsure_ = n_unsure;
    n_on_ = n_on;

    std::array<Unsure*, n_buckets> to;
    for (std::size_t k = 0; k < n_buckets; ++k) {
        std::vector<Unsure>& list = k == 0 ? hot_ : waiting_[k];
        list.resize(counts[k]);
        to[k] = list.data();
    }
    for (std::size_t id = 0; id < n_unsure; ++id)
        *to[bucket[id]]++ = unsures[id];
}

void ExpiringPairs::turn_on(Unsure& unsure) {
    const std::uint32_t id = unsure.id_and_state;
    unsure.id_and_state |= on_bit;
    place_[id] = static_cast<std::uint32_t>(n_on_);
    on_[n_on_] = unsure.pair;
    on_id_[n_on_++] = id;
}

/// The last one takes its place, unless it was left out before.
void ExpiringPairs::turn_off(Unsure& unsure) {
    unsure.id_and_state ^= on_bit;
    const std::uint32_t id = unsure.id_and_state, place = place_[id];
    if (place == off)
        return;
    --n_on_;
    on_[place] = on_[n_on_];
    on_id_[place] = on_id_[n_on_];
    place_[on_id_[place]] = place;
    place_[id] = off;
}

std::size_t ExpiringPairs::examine(const Box* boxes, double used) {
    const std::size_t bucket_now = reach_.bucket(used);
    todo_.clear();
    todo_.swap(hot_);
    for (std::size_t k = bucket_now_ + 1; k <= bucket_now; ++k) {
        todo_.insert(todo_.end(), waiting_[k].begin(), waiting_[k].end());
        waiting_[k].clear();
    }
    bucket_now_ = bucket_now;
    const std::size_t n = todo_.size();
    codes_.resize(n);
    static_assert(sizeof(Unsure) == 12);
    if (n > 0)
        gap_codes(&todo_[0].pair, 3, n, boxes,
                  GapScale::from(used * reach_.per_used, reach_.per_used), codes_.data());
    for (std::size_t i = 0; i < n; ++i) {
        Unsure& unsure = todo_[i];
        if ((codes_[i] ^ unsure.id_and_state) & on_bit)
            codes_[i] & on_bit ? turn_on(unsure) : turn_off(unsure);
        const std::size_t bucket = codes_[i] & ~on_bit;
        if (bucket == n_buckets)
            continue;
        (bucket <= bucket_now ? hot_ : waiting_[bucket]).push_back(unsure);
    }
    return n;
}

void ExpiringPairs::leave_out(const std::uint8_t* marks) {
    const auto stays = [&](Pair pair) { return (marks[pair.a] | marks[pair.b]) ^ 1; };
    std::size_t to = 0;
    for (std::size_t i = 0; i < n_sure_; ++i) {
        const Pair pair = sure_[i];
        sure_[to] = pair;
        to += static_cast<std::size_t>(stays(pair));
    }
    n_sure_ = to;
    to = 0;
    for (std::size_t i = 0; i < n_on_; ++i) {
        const Pair pair = on_[i];
        const std::uint32_t id = on_id_[i];
        const auto stay = static_cast<std::uint32_t>(stays(pair));
        on_[to] = pair;
        on_id_[to] = id;
        place_[id] = static_cast<std::uint32_t>(to) | (stay - 1); // or off
        to += stay;
    }
    n_on_ = to;
}

std::size_t ExpiringPairs::bytes() const {
    std::size_t sum = sure_.bytes() + place_.bytes() + on_.bytes() + on_id_.bytes() +
                      (hot_.capacity() + todo_.capacity()) * sizeof(Unsure) +
                      codes_.capacity() * sizeof(std::uint32_t);
    for (const auto& list : waiting_)
        sum += list.capacity() * sizeof(Unsure);
    return sum;
}

std::string ExpiringPairs::fault(const Box* boxes) const {
    const auto name = [](Pair p) {
        return "cached pair (" + std::to_string(p.a) + ", " + std::to_string(p.b) + ") ";
    };
    for (const auto list : {sure(), now()})
        for (const Pair pair : list)
            if (!overlaps(boxes[pair.a], boxes[pair.b]))
                return name(pair) + "is listed, but does not overlap";
    const auto fault_of = [&](const Unsure& unsure) -> std::string {
        const Pair pair = unsure.pair;
        const std::uint32_t place = place_[unsure.id_and_state & ~on_bit];
        if ((place != off) != overlaps(boxes[pair.a], boxes[pair.b]))
            return name(pair) + "is on the wrong list";
        if (place != off &&
            (place >= n_on_ || on_[place] != pair || !(unsure.id_and_state & on_bit)))
            return name(pair) + "is not where it is noted";
        return "";
    };
    for (std::size_t k = 0; k < n_buckets; ++k) {
        if (k <= bucket_now_ && !waiting_[k].empty())
            return "a pair waits for motion that is over";
        for (const Unsure& unsure : k == 0 ? hot_ : waiting_[k])
            if (std::string found = fault_of(unsure); !found.empty())
                return found;
    }
    for (std::size_t place = 0; place < n_on_; ++place)
        if (on_id_[place] >= n_unsure_ || place_[on_id_[place]] != place)
            return name(on_[place]) + "is listed twice";
    return "";
}

} // namespace boxwood::detail

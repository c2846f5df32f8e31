#pragma once

#include "trees/cuda/device/machine.h"
#include "trees/cuda/primitives.h"
#include "trees/cuda/queries/pairs_to.cuh"

#include <stdexcept>
#include <string>

namespace boxwood::cuda {

/// Where queries work, and with what.
struct Workplace {
    DevicePlace place;
    Stream stream;
    Spare spare;

    explicit Workplace(const DevicePlace& place_) : place(place_), stream(stream_of(place_)) {}
};

template <class T> T number_at(const T* at, Stream stream) {
    T number{};
    download(at, std::span(&number, 1), stream);
    wait(stream);
    return number;
}

/// Numbers of answers, and before them where those of each place begin.
struct Counted {
    DeviceArray<std::uint64_t> at; ///< one more than there are places
    std::uint64_t n = 0;           ///< answers in all
};

/// count(at): how many answers each place has.
template <class Count> Counted counted(std::size_t places, Workplace& in, const Count& count) {
    // What is summed, and more than CUB asks for beside it.
    require_memory("counting answers", (places + 1) * sizeof(std::uint64_t) + places + (1 << 16));
    Counted found{DeviceArray<std::uint64_t>(places + 1, in.place)};
    std::uint64_t* const at = found.at.span().data;
    count(at);
    fill_bytes(at + places, 0, sizeof(std::uint64_t), in.stream); // what a scan reads, and drops
    scan(at, places, in.spare, in.stream);
    found.n = number_at(static_cast<const std::uint64_t*>(at) + places, in.stream);
    return found;
}

/// By two passes, find.operator()<pass>(AnswersTo<Answer>), with a place for each query or more.
template <class Answer, class Find>
DeviceAnswersOf<Answer> count_and_fill(std::size_t places, Workplace& in, const Find& find) {
    Counted count = counted(places, in, [&](std::uint64_t* at) {
        find.template operator()<Pass::count>(AnswersTo<Answer>{at, nullptr, 0});
    });
    DeviceAnswersOf<Answer> found{std::move(count.at), DeviceArray<Answer>(count.n, in.place)};
    if (count.n > 0)
        find.template operator()<Pass::fill>(
            AnswersTo<Answer>{found.offsets.span().data, found.of.span().data, 0});
    return found;
}

/// As kernels number them.
inline std::uint32_t number_of_queries(std::size_t n) {
    if (n >= 0xffffffff)
        throw std::length_error(std::to_string(n) + " queries in one call, at most 2^32 - 2");
    return static_cast<std::uint32_t>(n);
}

} // namespace boxwood::cuda

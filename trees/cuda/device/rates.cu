#include "trees/cuda/device/machine.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boxwood {
namespace cuda {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;
constexpr int n_tries = 5, n_kernels = 100;

__global__ void touch(std::uint32_t* word) { *word = 0; }

/// The least time of several tries.
template <class Work> double least_ns(Stream stream, const Work& work) {
    Event start, stop;
    work(); // warms up
    double least = 0;
    for (int i = 0; i < n_tries; ++i) {
        start.record(stream);
        work();
        stop.record(stream);
        const double ns = stop.ns_since(start);
        least = i == 0 ? ns : std::min(least, ns);
    }
    return least;
}

} // namespace
} // namespace cuda

DeviceRates measure_rates(int index) {
    const cuda::Chosen chosen(index);
    const cuda::Stream stream;
    const std::size_t bytes =
        std::min<std::size_t>(cuda::most_bytes, cuda::free_memory() / 8 + 4096);
    cuda::require_memory("to measure rates", 2 * bytes);
    cuda::Array<std::byte> from(bytes, stream), to(bytes, stream);
    std::vector<std::byte> pageable(bytes);
    const std::unique_ptr<void, void (*)(void*)> memory(cuda::allocate_pinned(bytes),
                                                        cuda::release_pinned);
    const std::span<std::byte> pinned(static_cast<std::byte*>(memory.get()), bytes);
    const auto gbs = [&](const auto& work) {
        return static_cast<double>(bytes) / cuda::least_ns(stream, work);
    };
    const auto upload = [&](std::span<const std::byte> part) {
        return gbs([&, part] { cuda::upload(part, from.data(), stream); });
    };
    const auto download = [&](std::span<std::byte> part) {
        return gbs([&, part] {
            cuda::download(static_cast<const std::byte*>(from.data()), part, stream);
        });
    };
    DeviceRates rates;
    rates.upload_pageable = upload(pageable);
    rates.upload = upload(pinned);
    rates.download_pageable = download(pageable);
    rates.download = download(pinned);
    rates.copy = 2 * gbs([&] { cuda::copy(from.data(), to.data(), bytes, stream); });
    auto* const word = reinterpret_cast<std::uint32_t*>(to.data());
    rates.launch_ns = cuda::least_ns(stream,
                                     [&] {
                                         for (int i = 0; i < cuda::n_kernels; ++i)
                                             cuda::launch(stream, 1, 1, cuda::touch, word);
                                     }) /
                      cuda::n_kernels;
    return rates;
}

} // namespace boxwood
